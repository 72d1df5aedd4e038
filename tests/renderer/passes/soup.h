// Triangles of all sizes around the eye, for tests of the engines.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/passes/emitted.h"

namespace cupola::tests {

struct Soup {
  std::vector<content::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<content::Material> materials{content::Material{}};

  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    for (const glm::vec3& corner : {a, b, c}) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back({corner, {0, 1, 0}, {0, 0}});
    }
  }
  [[nodiscard]] std::size_t triangles() const { return indices.size() / 3; }
  [[nodiscard]] glm::dvec3 corner(std::size_t triangle, std::size_t which) const {
    return vertices[indices[triangle * 3 + which]].position;
  }
  [[nodiscard]] passes::FrameGeometry geometry() const {
    passes::FrameGeometry out;
    out.still = vertices;
    out.indices = indices;
    out.materials = materials;
    return out;
  }
};

/// Double-sided triangles about `size` metres large at distances of some metres, one after the other.
inline Soup random_soup(unsigned seed, int triangles, float size) {
  Soup soup;
  soup.materials[0].double_sided = true;
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  const auto draw = [&](float scale) {
    const float x = normal(random), y = normal(random), z = normal(random);
    return scale * glm::vec3(x, y, z);
  };
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 center = draw(4.0f);
    const glm::vec3 a = center + draw(size), b = center + draw(size), c = center + draw(size);
    soup.add(a, b, c);
  }
  return soup;
}

} // namespace cupola::tests
