// What is written is read back as the same: for ready-made shows and for every alternative.
#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "configs/loader/loader.h"
#include "configs/model/parameters.h"

using namespace cupola;
namespace fs = std::filesystem;

namespace {

void check_round_trip(const model::Show& show) {
  const auto document = model::to_json(show);
  const auto decoded = loader::decode_show(document);
  if (!decoded) FAIL_CHECK(model::to_text(decoded.error().front()));
  REQUIRE(decoded);
  CHECK(decoded->show == show);
  const auto parsed = loader::parse_show(document.dump(2), "dumped.json");
  REQUIRE(parsed);
  CHECK(parsed->show == show);
  CHECK(model::to_json(parsed->show) == document);
}

} // namespace

TEST_CASE("every show of the tree: parse, write, parse") {
  int count = 0;
  for (const char* folder : {"tests/configs/good", "configs/shows"})
    for (const auto& entry : fs::directory_iterator(fs::path(CUPOLA_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".json") continue;
      CAPTURE(entry.path().string());
      const auto loaded = loader::load_show(entry.path());
      REQUIRE(loaded);
      check_round_trip(loaded->show);
      ++count;
    }
  CHECK(count >= 12);
}

TEST_CASE("every alternative") {
  const std::vector<model::Content> contents{model::City{7, 1000}, model::Room{3.5},
                                             model::Gltf{"b.glb", "x", 2}};
  const std::vector<model::Shape> shapes{
      model::Perspective{{80}, {}},
      model::Perspective{{80}, model::Angle{50}},
      model::Cylinder{{359.9}, {0.1}},
      model::Fisheye{{400.0 / 3}},
      model::Equirectangular{{12}, {34}},
      model::Stereographic{{300}},
      model::Orthographic{{99}},
      model::Mercator{{300}, {120.5}},
      model::Panini{{200}, {}, 0.75},
      model::Panini{{160}, model::Angle{80}, 1.5},
      model::CubeCross{},
      model::CameraTexture{{60}, {}, 1, 1, {{{0.1, -0.2}, {0, 0}}, {{0.3, 0}, {1e-9, 4}}}, {}},
      model::CameraTexture{{60},
                           model::Angle{40},
                           512,
                           1,
                           {},
                           {{"a", {model::RadialZoom{0.25}, 0.5, -0.5, 2, 3}},
                            {"b", {model::Swirl{{-720}}, 0, 0, 1, 0}},
                            {"c", {model::Lens{-0.5}, 0, 0, 1, 0}},
                            {"d", {model::Ripple{0.1, 0.2}, 0, 0, 1, 0}}}}};
  const std::vector<model::Sink> sinks{model::AutoOutput{}, model::HeadlessOutput{},
                                       model::WindowOutput{"DP-1", true, false, false, -5, 7},
                                       model::FilesOutput{"d", "tif", 3}};
  for (const auto& content : contents)
    for (const auto& shape : shapes)
      for (const auto& sink : sinks) {
        model::Show show;
        show.scene.content = content;
        show.projections["p"] = {shape, 1.25, {0.1, -0.2, 0.3}, {{1}, {2}, {3}}};
        show.outputs["o"].sink = sink;
        show.outputs["o"].viewports["v"].projection = std::string("p");
        show.camera.path = {{0, {1, 2, 3}, {{4}, {5}, {6}}, {}}, {1.1, {}, {}, glm::dvec3(0.1, 0.2, 0.3)}};
        show.quality.cubemap_size = 777;
        check_round_trip(show);
      }
}
