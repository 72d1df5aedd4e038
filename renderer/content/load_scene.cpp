#include "renderer/content/city.h"
#include "renderer/content/room.h"
#include "renderer/content/scene.h"

namespace cupola::content {

model::Result<LoadedScene> load_scene(const model::Content& content, const std::filesystem::path& folder) {
  static_cast<void>(folder);
  if (const auto* city = std::get_if<model::City>(&content))
    return LoadedScene{std::make_shared<Scene>(make_city(*city)), {}};
  if (const auto* room = std::get_if<model::Room>(&content))
    return LoadedScene{std::make_shared<Scene>(make_room(*room)), {}};
  return model::failure({model::Code::scene_unsupported, "", "a city or a room", "a glTF file", ""});
}

void pose(const Scene& scene, double time, Pose& out) {
  static_cast<void>(time);
  out.vertices.clear();
  out.clusters = scene.geometry.clusters;
  out.lights = scene.lights;
}

} // namespace cupola::content
