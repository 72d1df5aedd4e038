#include <algorithm>
#include <doctest/doctest.h>

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
  show.outputs["coarse"].viewports["y"].projection = "turn";
  show.outputs["coarse"].viewports["y"].method = Method::piecewise;
  show.quality.supersampling = 2;
  const auto planned = make_plan(show);
  REQUIRE_FALSE(planned);
  const model::Problems& found = planned.error();
  CHECK(reported(found, Code::pieces_unsupported, "/outputs/main/viewports/v/method"));
  CHECK(reported(found, Code::pieces_unsupported, "/outputs/main/viewports/w/method"));
  CHECK(reported(found, Code::empty_viewport, "/outputs/main/viewports/thin/width"));
  CHECK(reported(found, Code::empty_viewport, "/outputs/main/viewports/flat/height"));
  CHECK(reported(found, Code::degenerate_projection, "/projections/out/off_axis"));
  CHECK(reported(found, Code::over_budget, "/outputs/huge/viewports/x/width"));
  CHECK(reported(found, Code::degenerate_projection, "/outputs/coarse/viewports/y/method"));
  CHECK(found.size() == 7);
  for (const model::Problem& problem : found) {
    CHECK_FALSE(problem.expected.empty());
    CHECK_FALSE(problem.found.empty());
    CHECK_FALSE(problem.advice.empty());
    CHECK(problem.at == model::Position{});
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

TEST_CASE("a reference to no projection is a problem, not a crash") {
  model::Show show = one_viewport(model::Perspective{}, Method::cubemap);
  show.outputs["main"].viewports["v"].projection = "none";
  const auto planned = make_plan(show);
  REQUIRE_FALSE(planned);
  CHECK(reported(planned.error(), Code::unknown_reference, "/outputs/main/viewports/v/projection"));
}
