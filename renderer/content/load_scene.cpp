#include "renderer/content/city.h"
#include "renderer/content/gltf.h"
#include "renderer/content/room.h"
#include "renderer/content/scene.h"

namespace cupola::content {

model::Result<LoadedScene> load_scene(const model::Content& content, const std::filesystem::path& folder) {
  if (const auto* city = std::get_if<model::City>(&content))
    return LoadedScene{std::make_shared<Scene>(make_city(*city)), {}};
  if (const auto* room = std::get_if<model::Room>(&content))
    return LoadedScene{std::make_shared<Scene>(make_room(*room)), {}};
  return load_gltf(std::get<model::Gltf>(content), folder);
}

} // namespace cupola::content
