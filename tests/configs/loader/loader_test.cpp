#include "configs/loader/loader.h"

#include <doctest/doctest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "configs/model/parameters.h"

using namespace cupola;
using Json = nlohmann::ordered_json;

namespace {

const std::string small = R"({
  "version": 1,
  "frame_rate": 25,
  "projections": { "wall": { "kind": "cylinder", "horizontal_fov": 270 } }, // comment
  "outputs": {
    "main": { "width": 800, "viewports": { "a": { "projection": "wall", "method": "piecewise" } } }
  }
}
)";

Json document() { return Json::parse(small, nullptr, true, true); }

model::Problems refused(const Json& changed) {
  auto loaded = loader::decode_show(changed);
  REQUIRE_FALSE(loaded);
  return loaded.error();
}

} // namespace

TEST_CASE("a text becomes a show, with defaults where it is silent") {
  const auto loaded = loader::parse_show(small, "small.json");
  REQUIRE(loaded);
  const model::Show& show = loaded->show;
  CHECK(show.frame_rate == 25);
  CHECK(std::get<model::Cylinder>(show.projections.at("wall").shape).horizontal_fov.degrees == 270);
  CHECK(std::get<model::Cylinder>(show.projections.at("wall").shape).vertical_fov.degrees == 60);
  CHECK(show.outputs.at("main").width == 800);
  CHECK(show.outputs.at("main").height == 720);
  CHECK(std::holds_alternative<model::AutoOutput>(show.outputs.at("main").sink));
  CHECK(show.outputs.at("main").viewports.at("a").method == model::Method::piecewise);
  CHECK(show.scene == model::Scene{});
  CHECK(loaded->warnings.empty());
}

TEST_CASE("positions are those of values") {
  const auto loaded = loader::parse_show(small, "small.json");
  REQUIRE(loaded);
  const auto at = [&](const char* pointer) { return loaded->positions.at(pointer); };
  CHECK(at("") == model::Position{"small.json", 1, 1});
  CHECK(at("/version") == model::Position{"small.json", 2, 14});
  CHECK(at("/projections/wall") == model::Position{"small.json", 4, 28});
  CHECK(at("/projections/wall/horizontal_fov") == model::Position{"small.json", 4, 68});
  CHECK(at("/outputs/main/viewports/a/method") == model::Position{"small.json", 6, 83});
  CHECK(loaded->positions.size() == 14);
}

TEST_CASE("problems found later get the place of their value, or of the nearest that stands in the text") {
  const auto loaded = loader::parse_show(small, "small.json");
  REQUIRE(loaded);
  model::Problems problems{{model::Code::degenerate_projection, "/outputs/main/viewports/a/method"},
                           {model::Code::over_budget, "/outputs/main/viewports/a/order"},
                           {model::Code::over_budget, "/quality/cubemap_size"},
                           {model::Code::over_budget, "no pointer"}};
  problems.push_back({model::Code::scene_invalid, "/outputs/main", "", "", "", {"x.gltf", 3, 4}});
  problems.push_back({model::Code::scene_invalid, "/outputs/main", "", "", "", {"y.gltf", 0, 0}});
  loader::locate(problems, loaded->positions);
  CHECK(problems[0].at == model::Position{"small.json", 6, 83});
  CHECK(problems[1].at == model::Position{"small.json", 6, 49});
  CHECK(problems[2].at == model::Position{"small.json", 1, 1});
  CHECK(problems[3].at == model::Position{"small.json", 1, 1});
  CHECK(problems[4].at == model::Position{"x.gltf", 3, 4}); // a place already known stays
  CHECK(problems[5].at == model::Position{"y.gltf", 0, 0}); // and so does another file
}

TEST_CASE("without positions, problems keep their pointers") {
  Json changed = document();
  changed["outputs"]["main"]["width"] = 0;
  changed["outputs"]["main"]["bogus"] = 1;
  const auto problems = refused(changed);
  REQUIRE(problems.size() == 2);
  CHECK(problems[0].code == model::Code::out_of_range);
  CHECK(problems[0].pointer == "/outputs/main/width");
  CHECK(problems[0].at == model::Position{});
  CHECK(problems[1].code == model::Code::unknown_key);
}

TEST_CASE("numbers that no text can hold are refused in documents") {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Json changed = document();
    changed["frame_rate"] = value;
    changed["camera"]["position"] = {0, value, 0};
    changed["outputs"]["main"]["width"] = value;
    const auto problems = refused(changed);
    REQUIRE(problems.size() == 3);
    for (const auto& problem : problems) {
      CHECK(problem.code == model::Code::out_of_range);
      CHECK(problem.found == "a number that is not finite");
    }
    CHECK(problems[1].pointer == "/outputs/main/width");
    CHECK(problems[2].pointer == "/camera/position/1");
  }
}

TEST_CASE("a document needs no object at its root to be refused in order") {
  for (const Json& odd : {Json(), Json(3), Json("text"), Json::array(), Json(true), Json::object()})
    CHECK(refused(odd).size() >= 1);
}

TEST_CASE("a check whose subject is refused already stays silent") {
  Json changed = document();
  changed["camera"]["look_to"] = {0, 0, 0};
  changed["camera"]["up"] = "high";
  CHECK(refused(changed).size() == 2); // the zero vector is one, whatever "up" is
  changed = document();
  changed["camera"]["look_to"] = {0, 1, 0};
  changed["camera"]["up"] = "high"; // the default up would be parallel
  CHECK(refused(changed).size() == 1);
}

TEST_CASE("listeners: what counts as one address") {
  const auto conflict = [](const char* http, const char* osc, int http_port, int osc_port,
                           bool enabled = true) {
    Json changed = document();
    changed["control"]["http"] = {{"address", http}, {"port", http_port}};
    changed["control"]["osc"] = {{"address", osc}, {"port", osc_port}, {"enabled", enabled}};
    return !loader::decode_show(changed);
  };
  CHECK(conflict("127.0.0.1", "127.0.0.1", 1000, 1000));
  CHECK(conflict("localhost", "127.0.0.1", 1000, 1000));
  CHECK(conflict("0.0.0.0", "10.0.0.1", 1000, 1000));
  CHECK(conflict("10.0.0.1", "::", 1000, 1000));
  CHECK_FALSE(conflict("127.0.0.1", "127.0.0.1", 1000, 1001));
  CHECK_FALSE(conflict("127.0.0.1", "10.0.0.1", 1000, 1000));
  CHECK_FALSE(conflict("127.0.0.1", "127.0.0.1", 0, 0));
  CHECK_FALSE(conflict("127.0.0.1", "127.0.0.1", 1000, 1000, false));
}

TEST_CASE("aspect: stretched by more than two percent is a warning") {
  const auto warned = [](const Json& projection, int width, int height) {
    Json changed = document();
    changed["projections"]["wall"] = projection;
    changed["outputs"]["main"]["width"] = width;
    changed["outputs"]["main"]["height"] = height;
    changed["outputs"]["main"]["viewports"]["a"]["method"] = "cubemap";
    const auto loaded = loader::decode_show(changed);
    REQUIRE(loaded);
    return !loaded->warnings.empty();
  };
  const Json square{{"kind", "perspective"}, {"horizontal_fov", 90}, {"vertical_fov", 90}};
  CHECK_FALSE(warned(square, 1000, 1000));
  CHECK_FALSE(warned(square, 1019, 1000));
  CHECK(warned(square, 1030, 1000));
  CHECK_FALSE(warned({{"kind", "perspective"}, {"horizontal_fov", 90}}, 100, 1000));
  CHECK_FALSE(warned({{"kind", "equirectangular"}}, 2000, 1000));
  CHECK(warned({{"kind", "equirectangular"}}, 2000, 1100));
  CHECK_FALSE(warned({{"kind", "mercator"}, {"vertical_fov", 90}}, 1000, 281)); // π : asinh(1)
  CHECK(warned({{"kind", "mercator"}, {"vertical_fov", 90}}, 1000, 500));
  CHECK_FALSE(warned({{"kind", "cube_cross"}}, 800, 600));
  CHECK(warned({{"kind", "cube_cross"}}, 800, 500));
  CHECK_FALSE(warned({{"kind", "fisheye"}}, 2000, 1100)); // its circle is inscribed
}
