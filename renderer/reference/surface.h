// What a ray sees where it meets a triangle: material, textures, light, style. Private to this room; any
// thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "configs/model/show.h"
#include "renderer/content/mipmap.h"
#include "renderer/content/scene.h"
#include "renderer/content/shading.h"

namespace cupola::reference {

/// A scene at one time, with what the rays need besides.
struct World {
  std::shared_ptr<const content::Scene> scene;
  std::vector<content::Vertex> moved; ///< all vertices of a pose; empty at time 0
  std::vector<content::Light> moved_lights;
  bool posed = false;
  std::vector<content::MipChain> images;
  std::vector<std::uint32_t> material_of_triangle;

  [[nodiscard]] const std::vector<content::Vertex>& vertices() const {
    return posed ? moved : scene->geometry.vertices;
  }
  [[nodiscard]] const std::vector<content::Light>& lights() const {
    return posed ? moved_lights : scene->lights;
  }
  [[nodiscard]] const content::Material& material(std::uint32_t triangle) const {
    return scene->materials[material_of_triangle[triangle]];
  }
};

/// A ray from the eye through a sample, world axes, and how it changes per output pixel to the right and
/// upwards.
struct Ray {
  glm::dvec3 direction, per_x, per_y;
};

/// A triangle as seen from the eye. A ray d meets it at barycentric coordinates dot(planes[i], d) /
/// dot(plane, d).
struct SeenTriangle {
  std::uint32_t triangle = ~0u;
  std::array<glm::dvec3, 3> corners; ///< from the eye
  std::array<glm::dvec3, 3> planes;
  glm::dvec3 plane;
};
[[nodiscard]] SeenTriangle see_triangle(const World& world, std::uint32_t triangle, const glm::dvec3& eye);

/// Where a ray meets a triangle: barycentric coordinates, and their change per output pixel.
struct Crossing {
  glm::dvec3 weights, per_x, per_y;
  bool front = true; ///< the ray meets the side from which the corners run counter-clockwise
};
[[nodiscard]] Crossing cross_triangle(const SeenTriangle& triangle, const Ray& ray);

/// What is the same for all rays of a viewport.
struct Shading {
  content::shading::Lighting lighting;
  model::Style style;
  glm::dvec3 eye{0.0};
  float sample_width = 1.0f; ///< of the footprint over which textures are filtered, in output pixels
};

/// Coverage by the base colour, 0 to 1, before the alpha mode is applied.
[[nodiscard]] float base_alpha(const World& world, const Shading& shading, const SeenTriangle& triangle,
                               const Crossing& crossing);

/// Colour in linear light, and opacity: 1 unless the material blends. `pixel`: place in the picture in
/// pixels, y upwards from its lower edge.
[[nodiscard]] glm::vec4 surface_color(const World& world, const Shading& shading,
                                      const SeenTriangle& triangle, const Crossing& crossing,
                                      glm::vec2 pixel);

} // namespace cupola::reference
