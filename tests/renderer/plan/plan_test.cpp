#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <random>

#include "configs/loader/loader.h"
#include "renderer/plan/plan.h"

using namespace cupola;
using namespace cupola::plan;
using model::Code;
using model::Method;

namespace {

model::Show one_viewport(const model::Shape& shape, Method method, int width = 1600, int height = 1200) {
  model::Show show;
  show.projections["p"].shape = shape;
  model::Output& output = show.outputs["main"];
  output.width = width;
  output.height = height;
  output.viewports["v"].projection = "p";
  output.viewports["v"].method = method;
  return show;
}

bool reported(const model::Problems& problems, Code code, std::string_view pointer) {
  return std::any_of(problems.begin(), problems.end(),
                     [&](const model::Problem& p) { return p.code == code && p.pointer == pointer; });
}

} // namespace

TEST_CASE("a cylinder in pieces and a dome by cubemap") {
  model::Show show = one_viewport(model::Cylinder{{360}, {134}}, Method::piecewise);
  show.projections["dome"].shape = model::Fisheye{{180}};
  show.outputs["main"].viewports["w"].projection = "dome";
  show.outputs["main"].viewports["w"].method = Method::cubemap;
  const auto planned = make_plan(show);
  REQUIRE(planned);
  CHECK(planned->warnings.empty());
  REQUIRE(planned->plan.outputs.size() == 1);
  const OutputPlan& output = planned->plan.outputs[0];
  CHECK(output.name == "main");
  CHECK(output.width == 1600);
  CHECK(output.height == 1200);
  REQUIRE(output.viewports.size() == 2);
  CHECK(output.viewports[0].rect == PixelRect{0, 0, 1600, 1200});
  REQUIRE(output.viewports[0].pieces);
  CHECK(output.viewports[0].pieces->max_error <= 0.25);
  CHECK_FALSE(output.viewports[1].pieces);
  REQUIRE(planned->plan.cubemap);
  CHECK(planned->plan.cubemap->size == 768); // 1200 / (π / 2), rounded up to 8
}

TEST_CASE("without a cubemap viewport there is no cubemap") {
  const auto planned = make_plan(one_viewport(model::Fisheye{}, Method::reference));
  REQUIRE(planned);
  CHECK_FALSE(planned->plan.cubemap);
  CHECK_FALSE(planned->plan.outputs[0].viewports[0].pieces);
}

TEST_CASE("fractions that meet give pixels that meet, for every size") {
  for (int size = 1; size < 2000; size += 7)
    for (const int parts : {2, 3, 7, 10}) {
      model::Show show = one_viewport(model::Perspective{}, Method::cubemap, size, size);
      auto& viewports = show.outputs["main"].viewports;
      viewports.clear();
      double x = 0.0;
      for (int i = 0; i < parts; ++i) {
        model::Viewport v;
        v.projection = "p";
        v.method = Method::reference;
        v.x = i % 2 ? x : double(i) / parts; // summed and divided: they differ in the last bits
        v.width = 1.0 / parts;
        x = v.x + v.width;
        v.order = i;
        viewports[std::to_string(i)] = v;
      }
      const auto planned = make_plan(show);
      if (!planned) {
        CHECK(size < parts); // some viewport has no pixel
        continue;
      }
      int column = 0;
      for (const ViewportPlan& v : planned->plan.outputs[0].viewports) {
        REQUIRE(v.rect.x == column);
        column += v.rect.width;
      }
      REQUIRE(column == size);
    }
}

TEST_CASE("drawing order: by order, then by name") {
  model::Show show = one_viewport(model::Perspective{}, Method::cubemap);
  auto& viewports = show.outputs["main"].viewports;
  viewports["a"] = viewports["v"];
  viewports["b"] = viewports["v"];
  viewports["a"].order = 5;
  viewports["b"].order = -3;
  const auto planned = make_plan(show);
  REQUIRE(planned);
  const auto& drawn = planned->plan.outputs[0].viewports;
  CHECK(drawn[0].name == "b");
  CHECK(drawn[1].name == "v");
  CHECK(drawn[2].name == "a");
}

TEST_CASE("all geometric problems are told at once") {
  model::Show show = one_viewport(model::Fisheye{}, Method::piecewise);
  show.projections["ball"].shape = model::Equirectangular{};
  show.projections["out"].shape = model::Cylinder{};
  show.projections["out"].off_axis = {0.9, 0, 0.9};
  auto& viewports = show.outputs["main"].viewports;
  viewports["w"].projection = "ball";
  viewports["w"].method = Method::piecewise;
  viewports["thin"].projection = "p";
  viewports["thin"].width = 1e-4;
  viewports["flat"].projection = "p";
  viewports["flat"].height = 1e-5;
  show.outputs["huge"] = show.outputs["main"];
  show.outputs["huge"].width = 10'000;
  show.outputs["huge"].viewports.clear();
  show.outputs["huge"].viewports["x"].projection = "p";
  show.outputs["coarse"].width = 2;
  show.projections["turn"].shape = model::Cylinder{{360}, {90}};
  show.projections["turn"].zoom = 0.1; // both columns are more than half a turn from the middle
  show.outputs["coarse"].viewports["y"].projection = "turn";
  show.outputs["coarse"].viewports["y"].method = Method::piecewise;
  show.quality.supersampling = 2;
  const auto planned = make_plan(show);
  REQUIRE_FALSE(planned);
  const model::Problems& found = planned.error();
  CHECK(reported(found, Code::empty_viewport, "/outputs/main/viewports/thin/width"));
  CHECK(reported(found, Code::empty_viewport, "/outputs/main/viewports/flat/height"));
  CHECK(reported(found, Code::degenerate_projection, "/projections/out/off_axis"));
  CHECK(reported(found, Code::over_budget, "/outputs/huge/viewports/x/width"));
  CHECK(reported(found, Code::degenerate_projection, "/outputs/coarse/viewports/y/method"));
  CHECK(reported(found, Code::looked_up, "/outputs/main/viewports/w/method"));
  CHECK(found.size() == 6);
  for (const model::Problem& problem : found) {
    CHECK_FALSE(problem.expected.empty());
    CHECK_FALSE(problem.found.empty());
    CHECK_FALSE(problem.advice.empty());
    CHECK(problem.at == model::Position{});
  }
}

TEST_CASE("what no piece can draw is looked up: its faces alone, and said so") {
  model::Show show = one_viewport(model::Equirectangular{}, Method::piecewise);
  show.outputs["main"].width = 1024;
  show.outputs["main"].height = 512;
  const auto planned = make_plan(show);
  REQUIRE(planned);
  CHECK(reported(planned->warnings, Code::looked_up, "/outputs/main/viewports/v/method"));
  REQUIRE(planned->plan.cubemap);
  const CubemapPlan& cubemap = *planned->plan.cubemap;
  for (const std::size_t face : {0, 1, 4, 5}) CHECK_FALSE(cubemap.faces[face].seen);
  for (const std::size_t face : {2, 3}) { // a small part about each pole
    CHECK(cubemap.faces[face].seen);
    CHECK(cubemap.faces[face].crop.width < cubemap.size / 4);
    CHECK(cubemap.faces[face].crop.x + cubemap.faces[face].crop.width / 2 ==
          doctest::Approx(cubemap.size / 2).epsilon(0.02));
  }

  show.projections["p"].shape = model::Fisheye{};
  const auto without = make_plan(show);
  REQUIRE(without);
  CHECK_FALSE(without->plan.cubemap);
  CHECK(without->warnings.empty());

  show.outputs["main"].width = show.outputs["main"].height = 1;
  const auto pixel = make_plan(show);
  REQUIRE(pixel);
  CHECK(pixel->plan.outputs[0].viewports[0].method == Method::cubemap);
  CHECK(reported(pixel->warnings, Code::looked_up, "/outputs/main/viewports/v/method"));
}

TEST_CASE("more pieces than may be: a problem that says what to do") {
  model::Show show = one_viewport(model::Fisheye{{340}}, Method::piecewise);
  show.outputs["main"].width = show.outputs["main"].height = 8192;
  show.pieces.max_error = 0.01;
  const auto planned = make_plan(show);
  REQUIRE_FALSE(planned);
  CHECK(reported(planned.error(), Code::over_budget, "/outputs/main/viewports/v/method"));
}

TEST_CASE("a Panini's field of view must suit its distance") {
  for (const auto& row : {std::pair{0.0, 179.0}, {0.5, 239.0}, {1.0, 359.0}, {2.0, 239.0}}) {
    const double distance = row.first, most = row.second;
    CAPTURE(distance);
    CHECK(make_plan(one_viewport(model::Panini{{most - 0.01}, {}, distance}, Method::cubemap)));
    const auto planned = make_plan(one_viewport(model::Panini{{most + 0.01}, {}, distance}, Method::cubemap));
    REQUIRE_FALSE(planned);
    CHECK(reported(planned.error(), Code::degenerate_projection, "/projections/p/horizontal_fov"));
  }
}

TEST_CASE("too many strips are refused; strips that cannot be fine enough are warned of") {
  model::Show fine = one_viewport(model::Cylinder{{360}, {170}}, Method::piecewise, 16384, 16384);
  fine.pieces.max_error = 0.0005;
  const auto refused = make_plan(fine);
  REQUIRE_FALSE(refused);
  CHECK(reported(refused.error(), Code::over_budget, "/outputs/main/viewports/v/method"));
  const auto warned = make_plan(one_viewport(model::Cylinder{{360}, {90}}, Method::piecewise, 12, 4000));
  REQUIRE(warned);
  REQUIRE(warned->warnings.size() == 1);
  CHECK(reported(warned->warnings, Code::over_budget, "/outputs/main/viewports/v/method"));
  CHECK(warned->warnings[0].severity == model::Severity::warning);
}

TEST_CASE("the cubemap serves all its viewports: the finest size, all faces that any sees") {
  model::Show show = one_viewport(model::Perspective{{60}, {}}, Method::cubemap, 800, 800);
  show.projections["left"] = show.projections["p"];
  show.projections["left"].orientation.yaw.degrees = 90;
  show.outputs["second"] = show.outputs["main"];
  show.outputs["second"].width = show.outputs["second"].height = 400;
  show.outputs["second"].viewports["v"].projection = "left";
  const auto planned = make_plan(show);
  REQUIRE(planned);
  REQUIRE(planned->plan.cubemap);
  const CubemapPlan& cube = *planned->plan.cubemap;
  CHECK(cube.size == 1392); // 800 / tan 30°, rounded up to 8
  CHECK(cube.faces[5].seen);
  CHECK(cube.faces[1].seen);
  CHECK_FALSE(cube.faces[0].seen);
  CHECK(cube.faces[5].crop.width < 830);
  CHECK(cube.faces[1].crop.width < 830);
  show.quality.cubemap_size = 300;
  CHECK(make_plan(show)->plan.cubemap->size == 300);
  show.quality.cubemap_size.reset();
  show.quality.supersampling = 2; // the pixels that are drawn are half as large
  CHECK(make_plan(show)->plan.cubemap->size == 2776);
  show.quality.supersampling = 1;
  show.projections["p"].zoom = 20;
  const auto clamped = make_plan(show);
  REQUIRE(clamped);
  CHECK(clamped->plan.cubemap->size == 8192);
  CHECK(reported(clamped->warnings, Code::over_budget, "/quality/cubemap_size"));
}

TEST_CASE("mipmaps: crops leave room for texels 16 times as large") {
  model::Show show = one_viewport(model::Perspective{{60}, {}}, Method::cubemap, 800, 800);
  show.quality.cubemap_size = 1000;
  const CubeFace sharp = make_plan(show)->plan.cubemap->faces[5];
  show.quality.cubemap_mipmaps = true;
  const CubemapPlan plan = *make_plan(show)->plan.cubemap;
  CHECK(plan.size == 1000);
  const CubeFace& soft = plan.faces[5];
  CHECK(sharp.crop.x - soft.crop.x >= 32);
  CHECK(soft.crop.x + soft.crop.width - sharp.crop.x - sharp.crop.width >= 32);
  CHECK(soft.crop.x >= 0);
  CHECK(soft.crop.x + soft.crop.width <= 1000);
}

TEST_CASE("the ready-made shows have a plan without a problem") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CUPOLA_SOURCE_DIR "/configs/shows")) {
    if (entry.path().extension() != ".json") continue;
    CAPTURE(entry.path().string());
    const auto loaded = loader::load_show(entry.path());
    REQUIRE(loaded);
    const auto planned = make_plan(loaded->show);
    REQUIRE(planned);
    CHECK(planned->warnings.empty());
    ++count;
    if (entry.path().filename() == "dome-city.json") CHECK(planned->plan.cubemap->size == 768);
  }
  CHECK(count >= 2);
}

TEST_CASE("any show within the ranges has a plan or problems that say where") {
  std::mt19937 random(11);
  const auto pick = [&](std::initializer_list<double> values) {
    return *(values.begin() + random() % values.size());
  };
  int planned_shows = 0;
  for (int i = 0; i < 1500; ++i) {
    model::Show show;
    for (const char* name : {"a", "b"}) {
      model::Projection& p = show.projections[name];
      switch (random() % 9) {
      case 0:
        p.shape = model::Perspective{{pick({0.1, 60, 175})}, model::Angle{pick({0.1, 175})}};
        break;
      case 1:
        p.shape = model::Cylinder{{pick({1, 200, 360})}, {pick({0.1, 60, 170})}};
        break;
      case 2:
        p.shape = model::Fisheye{{pick({1, 180, 360})}};
        break;
      case 3:
        p.shape = model::Equirectangular{{pick({1, 360})}, {pick({1, 180})}};
        break;
      case 4:
        p.shape = model::Stereographic{{pick({1, 350})}};
        break;
      case 5:
        p.shape = model::Orthographic{{pick({1, 180})}};
        break;
      case 6:
        p.shape = model::Mercator{{pick({1, 360})}, {pick({1, 178})}};
        break;
      case 7:
        p.shape = model::Panini{{pick({0.1, 170, 350})}, {}, pick({0, 1, 100})};
        break;
      default:
        p.shape = model::CubeCross{};
        break;
      }
      p.zoom = pick({0.05, 0.7, 1, 1, 1, 100});
      p.off_axis = {pick({-0.95, 0, 0.3}), pick({0, 0.95}), pick({0, 0, 0.5})};
      p.orientation = {{pick({0, 45, -360})}, {pick({0, 90})}, {pick({0, 33})}};
    }
    model::Output& output = show.outputs["o"];
    output.width = static_cast<int>(pick({1, 3, 40, 101}));
    output.height = static_cast<int>(pick({1, 2, 33, 77}));
    for (const char* name : {"v", "w"}) {
      model::Viewport& v = output.viewports[name];
      v.projection = std::string(1, random() % 2 ? 'a' : 'b');
      v.method = random() % 3 ? Method::cubemap : Method::piecewise;
      v.x = pick({0, 0.5, 0.99});
      v.width = 1.0 - v.x;
    }
    show.quality.supersampling = static_cast<int>(pick({1, 2, 8}));
    show.quality.cubemap_mipmaps = random() % 4 == 0;
    if (random() % 2) show.quality.cubemap_size = static_cast<int>(pick({16, 100, 16384}));
    show.pieces.max_error = pick({0.01, 0.25, 64});
    const auto planned = make_plan(show);
    if (!planned) {
      REQUIRE_FALSE(planned.error().empty());
      for (const auto& problem : planned.error()) REQUIRE(problem.pointer.rfind('/', 0) == 0);
      continue;
    }
    ++planned_shows;
    for (const ViewportPlan& v : planned->plan.outputs.at(0).viewports) {
      REQUIRE(v.rect.width > 0);
      REQUIRE(v.pieces.has_value() == (v.method == Method::piecewise));
      if (!v.pieces) continue;
      for (const Piece& piece : v.pieces->pieces)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) REQUIRE(std::isfinite(piece.to_screen[c][r]));
    }
  }
  CHECK(planned_shows > 250);
}

TEST_CASE("a reference to no projection is a problem, not a crash") {
  model::Show show = one_viewport(model::Perspective{}, Method::cubemap);
  show.outputs["main"].viewports["v"].projection = "none";
  const auto planned = make_plan(show);
  REQUIRE_FALSE(planned);
  CHECK(reported(planned.error(), Code::unknown_reference, "/outputs/main/viewports/v/projection"));
}
