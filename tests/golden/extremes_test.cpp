// Scenes at the edge of what there is: one triangle before everything, millions that are nowhere to be seen.
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <vector>

#include "tests/renderer/content/gltf_file.h"
#include "tests/support/drawing.h"

using namespace cupola;
using namespace cupola::tests;
using content::GltfFile;
using content::Json;

namespace {

Json white() {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}}}},
          {"doubleSided", true},
          {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
}

model::Gltf write(GltfFile& file, const std::string& name) {
  file.json["extensionsUsed"] = {"KHR_materials_unlit"};
  file.add("materials", white());
  model::Gltf gltf;
  gltf.file = file.write(name).string();
  return gltf;
}

/// One triangle of 20 km, a hand's breadth before the eye.
model::Gltf wall_before_everything() {
  GltfFile file;
  constexpr float far = 1e4f;
  const std::vector<float> corners{-far, -far, -0.1f, far, -far, -0.1f, 0.0f, far, -0.1f};
  file.show({{"attributes", {{"POSITION", file.floats(corners, "VEC3")}}}, {"material", 0}});
  return write(file, "wall.gltf");
}

/// `copies` nodes of a sheet of a million triangles of a millimetre, each a kilometre behind the eye.
model::Gltf dust(int copies) {
  GltfFile file;
  constexpr std::uint32_t edge = 708;
  std::vector<float> places;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t y = 0; y < edge; ++y)
    for (std::uint32_t x = 0; x < edge; ++x) {
      places.insert(places.end(), {0.001f * static_cast<float>(x), 0.001f * static_cast<float>(y), 1000.0f});
      if (x + 1 == edge || y + 1 == edge) continue;
      const std::uint32_t i = y * edge + x;
      corners.insert(corners.end(), {i, i + 1, i + edge, i + 1, i + edge + 1, i + edge});
    }
  const int node = file.show({{"attributes", {{"POSITION", file.floats(places, "VEC3")}}},
                              {"indices", file.words(corners, "SCALAR")},
                              {"material", 0}});
  const Json mesh = file.json["nodes"][static_cast<std::size_t>(node)]["mesh"];
  for (int i = 1; i < copies; ++i) {
    const int copy = file.add("nodes", {{"mesh", mesh}, {"translation", {2.0 * i, 0.0, 0.0}}});
    file.json["scenes"][0]["nodes"].push_back(copy);
  }
  return write(file, "dust.gltf");
}

model::Show show_of(const model::Content& content, const model::Shape& shape, model::Engine engine) {
  model::Projection projection;
  projection.shape = shape;
  model::Show show = make_show(content, projection, model::Method::piecewise, 360, 240);
  show.pieces.engine = engine;
  show.scene.fog.density = 0.0;
  show.background = {0.0, 0.0, 0.0};
  return show;
}

const std::vector<model::Shape>& shapes() {
  static const std::vector<model::Shape> all{model::Fisheye{{180.0}}, model::Fisheye{{300.0}},
                                             model::Cylinder{{360.0}, {100.0}},
                                             model::Equirectangular{{360.0}, {180.0}}};
  return all;
}

} // namespace

TEST_CASE("one triangle before everything fills what rays say it fills, by both engines") {
  const model::Gltf wall = wall_before_everything();
  for (std::size_t i = 0; i < shapes().size(); ++i)
    for (const model::Engine engine : {model::Engine::cpu, model::Engine::gpu}) {
      CAPTURE(i);
      CAPTURE(engine);
      model::Show show = show_of(wall, shapes()[i], engine);
      const Shot pieces = draw(show);
      show.outputs["main"].viewports["all"].method = model::Method::reference;
      const Shot rays = draw(show);
      const long filled = count_pixels(rays, 255, 255, 255);
      CHECK(filled > 360 * 240 / 6);
      // The horizon of the wall is a line of pixels that either may count.
      CHECK(std::abs(count_pixels(pieces, 255, 255, 255) - filled) <= 3 * (360 + 240));
      CHECK(psnr(pieces, rays) > 20.0);
    }
}

TEST_CASE("ten million triangles behind the eye draw nothing, and are not sent") {
  const model::Gltf scene = dust(10);
  for (const model::Engine engine : {model::Engine::cpu, model::Engine::gpu}) {
    CAPTURE(engine);
    const model::Show show = show_of(scene, model::Fisheye{{180.0}}, engine);
    Shot shot = draw(show);
    shot = draw(show); // counts of the GPU engine come a frame late
    CHECK(last_statistics().triangles == 10L * 707 * 707 * 2);
    CHECK(last_statistics().replicated == 0);
    CHECK(count_pixels(shot, 255, 255, 255) == 0);
  }
}
