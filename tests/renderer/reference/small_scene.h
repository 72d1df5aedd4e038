// Scenes of a few triangles, made by hand, and one-line renders of them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/reference/tracer.h"

namespace cupola::reference {

struct SmallScene {
  content::Scene scene;

  int material(const content::Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
  }

  /// Colour as it is: no light, so that a picture's values can be worked out by hand.
  int plain(const glm::vec4& color, content::AlphaMode mode = content::AlphaMode::opaque,
            bool double_sided = false) {
    content::Material unlit;
    unlit.base_color = color;
    unlit.unlit = true;
    unlit.alpha_mode = mode;
    unlit.double_sided = double_sided;
    return material(unlit);
  }

  /// A texture of its own image; linear data where `srgb` is false.
  int texture(int width, int height, std::vector<std::uint8_t> rgba, bool srgb) {
    scene.images.push_back({"picture", width, height, srgb, std::move(rgba)});
    content::Texture texture;
    texture.image = static_cast<int>(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    return static_cast<int>(scene.textures.size()) - 1;
  }

  /// Corners counter-clockwise as seen from the front, from the lower left one; uv as the picture lies in the
  /// file.
  void quad(int material, const std::array<glm::vec3, 4>& corners, float u = 1.0f, float v = 1.0f) {
    const auto first = static_cast<std::uint32_t>(scene.geometry.vertices.size());
    const glm::vec3 across = corners[1] - corners[0], up = corners[3] - corners[0];
    const glm::vec3 normal = glm::normalize(glm::cross(across, up));
    const std::array<glm::vec2, 4> uvs{glm::vec2{0, v}, {u, v}, {u, 0}, {0, 0}};
    for (std::size_t i = 0; i < 4; ++i) scene.geometry.vertices.push_back({corners[i], normal, uvs[i]});
    content::Cluster cluster;
    cluster.first_index = static_cast<std::uint32_t>(scene.geometry.indices.size());
    cluster.index_count = 6;
    cluster.material = static_cast<std::uint32_t>(material);
    scene.geometry.clusters.push_back(cluster);
    for (std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) scene.geometry.indices.push_back(first + corner);
    scene.static_vertices = static_cast<std::uint32_t>(scene.geometry.vertices.size());
  }

  /// Facing +z, at depth z, 2 · half across.
  void wall(int material, float z, float half = 100.0f, float u = 1.0f, float v = 1.0f) {
    quad(material, {glm::vec3{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, u, v);
  }

  [[nodiscard]] std::shared_ptr<const content::Scene> share() const {
    return std::make_shared<const content::Scene>(scene);
  }
};

/// Eye in the origin, looking along -z, no fog.
inline Request request(const model::Projection& projection, int width, int height, int samples = 1) {
  Request out;
  out.map = projection::make_map(projection, static_cast<double>(width) / height);
  out.rect = {0, 0, width, height};
  out.samples = samples;
  return out;
}

inline model::Projection of(const model::Shape& shape) {
  model::Projection projection;
  projection.shape = shape;
  return projection;
}

inline model::Projection perspective(double horizontal_fov) {
  return of(model::Perspective{{horizontal_fov}, std::nullopt});
}

inline Picture render(const SmallScene& scene, const Request& request) {
  Picture picture(request.rect.x + request.rect.width, request.rect.y + request.rect.height,
                  request.background);
  Tracer(scene.share()).render(request, picture);
  return picture;
}

} // namespace cupola::reference
