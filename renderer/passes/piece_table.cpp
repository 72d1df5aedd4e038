#include "renderer/passes/piece_table.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace cupola::passes {

namespace {

constexpr double margin = 1e-6; ///< radians by which cones are wider than their rays: rounding to floats

PieceTable::Cone cone(const glm::dvec3& axis, double cosine) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) + margin;
  return {glm::vec3(axis), static_cast<float>(std::sin(angle)),
          cosine <= -1.0 ? -1.0f : static_cast<float>(std::cos(angle))};
}

/// About the three rays of a piece.
PieceTable::Cone cone(const plan::PieceSet& set, const std::array<std::uint32_t, 3>& triangle) {
  glm::dvec3 axis(0.0);
  for (const std::uint32_t corner : triangle) axis += set.corners[corner].ray;
  axis = glm::normalize(axis);
  double cosine = 1.0;
  for (const std::uint32_t corner : triangle)
    cosine = std::min(cosine, glm::dot(axis, set.corners[corner].ray));
  return cone(axis, cosine);
}

/// By the corners of the border, whichever piece asks.
std::array<glm::vec3, 3> borders_of(const plan::PieceSet& set, const std::array<std::uint32_t, 3>& triangle) {
  std::array<glm::vec3, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [a, b] = std::minmax(triangle[(i + 1) % 3], triangle[(i + 2) % 3]);
    out[i] = glm::vec3(glm::normalize(glm::cross(set.corners[a].ray, set.corners[b].ray)));
  }
  return out;
}

} // namespace

PieceTable::PieceTable(const plan::PieceSet& set) {
  groups_.reserve(set.groups.size());
  for (const plan::PieceGroup& group : set.groups)
    groups_.push_back({cone(group.axis, group.cosine), group.first, group.count, group.next, no_group});
  for (std::uint32_t i = 0; i < groups_.size(); ++i) {
    if (groups_[i].is_leaf(i)) continue;
    groups_[i + 1].parent = groups_[groups_[i + 1].next].parent = i;
  }
  corners_.reserve(set.corners.size());
  for (const plan::Corner& corner : set.corners)
    corners_.push_back({glm::vec3(corner.ray), glm::vec3(corner.weight * glm::dvec3(corner.screen, 1.0))});
  pieces_.reserve(set.pieces.size());
  cones_.reserve(set.pieces.size());
  for (std::size_t i = 0; i < set.pieces.size(); ++i) {
    const plan::Piece& piece = set.pieces[i];
    cones_.push_back(cone(set, set.triangles[i]));
    pieces_.push_back({{glm::vec3(piece.planes[0]), glm::vec3(piece.planes[1]), glm::vec3(piece.planes[2])},
                       set.triangles[i],
                       borders_of(set, set.triangles[i]),
                       glm::determinant(piece.to_screen) > 0.0,
                       no_group});
  }
  for (std::uint32_t i = 0; i < groups_.size(); ++i) {
    const Group& group = groups_[i];
    if (!group.is_leaf(i)) continue;
    for (std::uint32_t piece = group.first; piece < group.first + group.count; ++piece)
      pieces_[piece].leaf = i;
  }
}

bool PieceTable::meets(const Group& group, const glm::vec3& center, float radius) {
  if (group.cosine <= -1.0f) return true;
  const float along = glm::dot(group.axis, center);
  const float square = glm::dot(center, center);
  if (square <= radius * radius) return true;
  // The sphere fills a cone of half angle β with sin β = radius / distance. They meet where the angle between
  // the axes is at most α + β.
  const float distance = std::sqrt(square);
  const float sine = radius / distance, cosine = std::sqrt(std::max(0.0f, 1.0f - sine * sine));
  if (sine * group.cosine + cosine * group.sine < 0.0f) return true; // α + β beyond half a turn
  return along >= distance * (group.cosine * cosine - group.sine * sine) - 1e-6f * distance;
}

} // namespace cupola::passes
