// From corners to pieces: matrices, planes, pixel bounds, and a tree over the directions.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "renderer/plan/plan.h"

namespace cupola::plan {

namespace {

constexpr std::uint32_t leaf_pieces = 4;

/// Sorts the pieces into a tree: each group is halved across the longest side of its directions.
class Grouping {
public:
  explicit Grouping(const PieceSet& set)
      : set_(set)
      , order(set.triangles.size()) {
    std::iota(order.begin(), order.end(), 0u);
    middles_.reserve(order.size());
    for (const auto& triangle : set.triangles) {
      glm::dvec3 sum(0.0);
      for (const std::uint32_t corner : triangle) sum += set.corners[corner].ray;
      middles_.push_back(sum / 3.0);
    }
    groups.reserve(order.size());
    if (!order.empty()) add(0, static_cast<std::uint32_t>(order.size()));
  }

private:
  void add(std::uint32_t first, std::uint32_t count) {
    const std::size_t own = groups.size();
    groups.push_back(cone(first, count));
    if (count > leaf_pieces) {
      glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
      for (std::uint32_t i = first; i < first + count; ++i) {
        low = glm::min(low, middles_[order[i]]);
        high = glm::max(high, middles_[order[i]]);
      }
      const glm::dvec3 extent = high - low;
      const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
      const auto begin = order.begin() + first;
      const std::uint32_t half = count / 2;
      std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return middles_[a][axis] < middles_[b][axis];
      });
      add(first, half);
      add(first + half, count - half);
    }
    groups[own].next = static_cast<std::uint32_t>(groups.size());
  }

  [[nodiscard]] PieceGroup cone(std::uint32_t first, std::uint32_t count) const {
    PieceGroup group;
    group.first = first;
    group.count = count;
    glm::dvec3 sum(0.0);
    for (std::uint32_t i = first; i < first + count; ++i) sum += middles_[order[i]];
    group.axis = glm::dvec3(0.0, 0.0, -1.0);
    const double length = glm::length(sum);
    if (length < 1e-9 * count) return group;
    group.axis = sum / length;
    group.cosine = 1.0;
    for (std::uint32_t i = first; i < first + count; ++i)
      for (const std::uint32_t corner : set_.triangles[order[i]])
        group.cosine = std::min(group.cosine, glm::dot(group.axis, set_.corners[corner].ray));
    // A cone of more than half a turn is not convex: the middle of a piece could leave it.
    if (group.cosine <= 0.0) group.cosine = -1.0;
    return group;
  }

  const PieceSet& set_;
  std::vector<glm::dvec3> middles_;

public:
  std::vector<std::uint32_t> order;
  std::vector<PieceGroup> groups;
};

Piece piece_of(const PieceSet& set, const std::array<std::uint32_t, 3>& triangle, const PixelRect& rect) {
  std::array<Corner, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = set.corners[triangle[i]];
  const glm::dmat3 inverse = glm::inverse(glm::dmat3(c[0].ray, c[1].ray, c[2].ray));
  const glm::dmat3 landing(c[0].weight * glm::dvec3(c[0].screen, 1.0),
                           c[1].weight * glm::dvec3(c[1].screen, 1.0),
                           c[2].weight * glm::dvec3(c[2].screen, 1.0));
  Piece piece;
  piece.to_screen = landing * inverse;
  const glm::dmat3 rows = glm::transpose(inverse);
  piece.planes = {rows[0], rows[1], rows[2]};
  piece.plane_count = 3;
  const auto column = [&](double x) { return (x + 1.0) * 0.5 * rect.width; };
  const auto row = [&](double y) { return (1.0 - y) * 0.5 * rect.height; };
  const auto [x0, x1] = std::minmax({c[0].screen.x, c[1].screen.x, c[2].screen.x});
  const auto [y0, y1] = std::minmax({c[0].screen.y, c[1].screen.y, c[2].screen.y});
  const int left = std::clamp(static_cast<int>(std::floor(column(x0) + 1e-6)), 0, rect.width);
  const int right = std::clamp(static_cast<int>(std::ceil(column(x1) - 1e-6)), 0, rect.width);
  const int top = std::clamp(static_cast<int>(std::floor(row(y1) + 1e-6)), 0, rect.height);
  const int bottom = std::clamp(static_cast<int>(std::ceil(row(y0) - 1e-6)), 0, rect.height);
  piece.bounds = {rect.x + left, rect.y + top, right - left, bottom - top};
  return piece;
}

} // namespace

void finish_triangles(PieceSet& set, const PixelRect& rect) {
  Grouping grouping(set);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Shown> shown;
  set.pieces.clear();
  triangles.reserve(grouping.order.size());
  shown.reserve(grouping.order.size());
  set.pieces.reserve(grouping.order.size());
  for (const std::uint32_t i : grouping.order) {
    std::array<std::uint32_t, 3> triangle = set.triangles[i];
    const glm::dvec2 a = set.corners[triangle[0]].screen, b = set.corners[triangle[1]].screen - a,
                     c = set.corners[triangle[2]].screen - a;
    if (b.x * c.y < b.y * c.x) std::swap(triangle[1], triangle[2]);
    triangles.push_back(triangle);
    shown.push_back(set.shown[i]);
    set.pieces.push_back(piece_of(set, triangle, rect));
  }
  set.triangles = std::move(triangles);
  set.shown = std::move(shown);
  set.groups = std::move(grouping.groups);
  set.strips = false;
}

} // namespace cupola::plan
