#include "renderer/content/city.h"

#include <array>
#include <future>
#include <utility>
#include <vector>

#include "renderer/content/city_mesh.h"
#include "renderer/content/city_pictures.h"
#include "renderer/content/city_plan.h"
#include "renderer/content/clusters.h"

namespace cupola::content {
namespace {

struct Look {
  Image (*paint)();
  float metallic = 0.0f, roughness = 1.0f;
};

/// In the order of city::Group.
const std::array<Look, city::group_count>& looks() {
  static constexpr std::array<Look, city::group_count> all{{{city::paint_glass, 0.3f, 0.22f},
                                                            {city::paint_office, 0.0f, 0.7f},
                                                            {city::paint_stone, 0.0f, 0.9f},
                                                            {city::paint_brick, 0.0f, 0.95f},
                                                            {city::paint_plaster, 0.0f, 0.95f},
                                                            {city::paint_shop, 0.0f, 0.5f},
                                                            {city::paint_flat_roof, 0.0f, 1.0f},
                                                            {city::paint_tiled_roof, 0.0f, 0.8f},
                                                            {city::paint_street, 0.0f, 0.95f},
                                                            {city::paint_crossing, 0.0f, 0.95f},
                                                            {city::paint_pavement, 0.0f, 0.95f},
                                                            {city::paint_grass, 0.0f, 1.0f},
                                                            {city::paint_tree, 0.0f, 1.0f},
                                                            {city::paint_sky, 0.0f, 1.0f}}};
  return all;
}

void add_material(Scene& scene, const Look& look, Image picture, bool sky) {
  const auto index = static_cast<int>(scene.materials.size());
  scene.images.push_back(std::move(picture));
  Texture texture;
  texture.image = index;
  if (sky) texture.wrap_t = Wrap::clamp; // the zenith must not mix with the nadir
  scene.textures.push_back(texture);
  Material material;
  material.name = scene.images.back().name;
  material.metallic = look.metallic;
  material.roughness = look.roughness;
  material.unlit = material.fogless = sky;
  material.base_color_map.texture = index;
  scene.materials.push_back(std::move(material));
}

} // namespace

Scene make_city(const model::City& wish) {
  Scene scene;
  std::vector<std::future<Image>> pictures; // painted on other cores meanwhile
  for (const Look& look : looks()) pictures.push_back(std::async(std::launch::async, look.paint));
  city::Mesh mesh = city::build(city::make_plan(wish));
  for (std::size_t group = 0; group < looks().size(); ++group)
    add_material(scene, looks()[group], pictures[group].get(),
                 group == static_cast<std::size_t>(city::Group::sky));
  scene.geometry.vertices = std::move(mesh.vertices);
  make_clusters(scene.geometry, mesh.triangles, scene.materials);
  scene.static_vertices = static_cast<std::uint32_t>(scene.geometry.vertices.size());
  set_scene_bounds(scene);
  return scene;
}

} // namespace cupola::content
