// Which pieces a triangle touches, found slowly and in double: the parts that pieces cut out of it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/plan/camera.h"
#include "renderer/plan/plan.h"

namespace cupola::tests {

/// Planes through the eye around what a piece shows, not negative inside: a strip ends above and below as
/// well.
inline std::vector<glm::dvec3> planes_of(const plan::Piece& piece) {
  std::vector<glm::dvec3> planes(piece.planes.begin(), piece.planes.begin() + piece.plane_count);
  if (piece.plane_count == 3) return planes;
  const glm::dmat3 rows = glm::transpose(piece.to_screen);
  planes.insert(planes.end(), {rows[2], rows[2] - rows[1], rows[2] + rows[1]});
  return planes;
}

/// Whether a part of the triangle, which is in view axes, lies within the piece's pyramid. Slivers of less
/// than a billionth of the triangle do not count: Sutherland–Hodgman in double.
inline bool meets(const plan::Piece& piece, const std::array<glm::dvec3, 3>& triangle) {
  std::vector<glm::dvec3> polygon(triangle.begin(), triangle.end()), cut;
  for (const glm::dvec3& plane : planes_of(piece)) {
    cut.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double dp = glm::dot(plane, p), dq = glm::dot(plane, q);
      if (dp >= 0.0) cut.push_back(p);
      if ((dp >= 0.0) != (dq >= 0.0)) cut.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    std::swap(polygon, cut);
    if (polygon.size() < 3) return false;
  }
  const auto twice = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a);
  };
  glm::dvec3 area(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) area += twice(polygon[0], polygon[i], polygon[i + 1]);
  return glm::length(area) > 1e-9 * glm::length(twice(triangle[0], triangle[1], triangle[2]));
}

/// All (triangle, piece) of a scene; triangles are counted along its indices, and those seen from behind, or
/// edge on, are left out unless their material is double-sided.
inline std::vector<std::array<std::uint32_t, 2>>
exact_pairs(const content::Scene& scene, const plan::CameraPose& camera, const plan::PieceSet& set) {
  const content::Geometry& geometry = scene.geometry;
  const glm::dmat3 view = glm::transpose(camera.orientation);
  std::vector<std::array<std::uint32_t, 2>> out;
  for (const content::Cluster& cluster : geometry.clusters)
    for (std::uint32_t i = 0; i < cluster.index_count; i += 3) {
      std::array<glm::dvec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t index = geometry.indices[cluster.first_index + i + k];
        corners[k] = view * (glm::dvec3(geometry.vertices[index].position) - camera.position);
      }
      const double volume = glm::determinant(glm::dmat3(corners[0], corners[1], corners[2]));
      const bool both = scene.materials[cluster.material].double_sided;
      if (both ? volume == 0.0 : volume >= 0.0) continue;
      for (std::uint32_t piece = 0; piece < set.pieces.size(); ++piece)
        if (meets(set.pieces[piece], corners)) out.push_back({(cluster.first_index + i) / 3, piece});
    }
  return out;
}

} // namespace cupola::tests
