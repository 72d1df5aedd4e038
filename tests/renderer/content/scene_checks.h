// What every scene has to keep, and looking around in one without a renderer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::content {

/// FNV-1a over bytes.
class Hash {
public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3ULL;
  }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.data(), list.size() * sizeof(T));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Clusters are sorted, cover all triangles once, hold their vertices and at most 256 triangles; indices and
/// normals are sound.
inline void check_geometry(const Scene& scene) {
  const Geometry& geometry = scene.geometry;
  std::uint32_t next = 0;
  std::size_t outside = 0;
  for (std::size_t i = 0; i < geometry.clusters.size(); ++i) {
    const Cluster& cluster = geometry.clusters[i];
    REQUIRE(cluster.first_index == next);
    REQUIRE(cluster.index_count > 0);
    REQUIRE(cluster.index_count % 3 == 0);
    REQUIRE(cluster.index_count <= 3 * 256);
    REQUIRE(cluster.material < scene.materials.size());
    next += cluster.index_count;
    if (i > 0) {
      const Cluster& before = geometry.clusters[i - 1];
      const auto key = [&](const Cluster& c) {
        return std::pair(scene.materials[c.material].alpha_mode, c.material);
      };
      REQUIRE(key(before) <= key(cluster));
    }
    for (std::uint32_t k = cluster.first_index; k < next; ++k) {
      if (geometry.indices[k] >= geometry.vertices.size()) FAIL("an index beyond the vertices");
      if (glm::distance(geometry.vertices[geometry.indices[k]].position, cluster.center) >
          cluster.radius * 1.000001f)
        ++outside;
    }
  }
  CHECK(outside == 0);
  CHECK(next == geometry.indices.size());
  std::size_t bent = 0;
  for (const Vertex& vertex : geometry.vertices)
    if (std::abs(glm::length(vertex.normal) - 1.0f) > 1e-3f) ++bent;
  CHECK(bent == 0);
}

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  bool front = false;
  std::uint32_t material = 0;
};

/// The nearest triangle along a ray, whichever way it faces; clusters' spheres keep it quick.
inline Hit look(const Scene& scene, const glm::dvec3& eye, const glm::dvec3& ray) {
  Hit hit;
  for (const Cluster& cluster : scene.geometry.clusters) {
    const glm::dvec3 to = glm::dvec3(cluster.center) - eye;
    const double along = glm::dot(to, ray);
    const double square = glm::dot(to, to);
    const double radius = cluster.radius;
    if (square - along * along > radius * radius || (along < 0.0 && square > radius * radius)) continue;
    for (std::uint32_t k = 0; k < cluster.index_count; k += 3) {
      const auto corner = [&](std::uint32_t c) {
        return glm::dvec3(
            scene.geometry.vertices[scene.geometry.indices[cluster.first_index + k + c]].position);
      };
      const glm::dvec3 a = corner(0);
      const glm::dvec3 ab = corner(1) - a;
      const glm::dvec3 ac = corner(2) - a;
      const glm::dvec3 p = glm::cross(ray, ac);
      const double det = glm::dot(ab, p);
      if (det == 0.0) continue;
      const glm::dvec3 s = eye - a;
      const double u = glm::dot(s, p) / det;
      const glm::dvec3 q = glm::cross(s, ab);
      const double v = glm::dot(ray, q) / det;
      const double t = glm::dot(ac, q) / det;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= 0.0 || t >= hit.distance) continue;
      hit = {t, det > 0.0, cluster.material};
    }
  }
  return hit;
}

} // namespace cupola::content
