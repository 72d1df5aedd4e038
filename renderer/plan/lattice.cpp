#include "renderer/plan/lattice.h"

#include <algorithm>
#include <cstdlib>

namespace cupola::plan {

Lattice::Lattice(glm::ivec2 origin, glm::ivec2 size, glm::ivec2 root) {
  const int columns = (size.x + root.x - 1) / root.x, rows = (size.y + root.y - 1) / root.y;
  const auto number = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) points_.emplace_back(origin.x + x * root.x, origin.y + y * root.y);
  // Each rectangle: the triangle beside its left side, then the one beside its right side. Diagonals
  // alternate, so that those of neighbouring rectangles meet.
  const auto rising = [](int x, int y) { return (x + y) % 2 == 0; };
  const auto left = [&](int x, int y) { return static_cast<std::uint32_t>(2 * (y * columns + x)); };
  const auto right = [&](int x, int y) { return left(x, y) + 1; };
  const auto at_top = [&](int x, int y) { return rising(x, y) ? left(x, y) : right(x, y); };
  const auto at_bottom = [&](int x, int y) { return rising(x, y) ? right(x, y) : left(x, y); };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::uint32_t a = number(x, y), b = number(x + 1, y), c = number(x, y + 1),
                          d = number(x + 1, y + 1);
      const std::uint32_t west = x > 0 ? right(x - 1, y) : none,
                          east = x + 1 < columns ? left(x + 1, y) : none;
      const std::uint32_t north = y > 0 ? at_bottom(x, y - 1) : none;
      const std::uint32_t south = y + 1 < rows ? at_top(x, y + 1) : none;
      if (rising(x, y)) {
        triangles_.push_back({{a, c, b}, {right(x, y), north, west}});
        triangles_.push_back({{d, b, c}, {left(x, y), south, east}});
      } else {
        triangles_.push_back({{c, d, a}, {right(x, y), west, south}});
        triangles_.push_back({{b, a, d}, {left(x, y), east, north}});
      }
    }
}

bool Lattice::divisible(std::uint32_t triangle, int shortest) const {
  const auto& [apex, from, to] = triangles_[triangle].corners;
  const glm::ivec2 side = points_[to] - points_[from];
  if (side.x % 2 != 0 || side.y % 2 != 0) return false;
  return std::max(std::abs(side.x), std::abs(side.y)) / 2 >= shortest;
}

void Lattice::replace_neighbour(std::uint32_t of, std::uint32_t was, std::uint32_t is) {
  if (of == none) return;
  for (std::uint32_t& neighbour : triangles_[of].beyond)
    if (neighbour == was) neighbour = is;
}

/// The number stays with the half at the second corner; returns that of the half at the third. Neighbours
/// across the halved side are left to the caller.
std::uint32_t Lattice::halve(std::uint32_t triangle, std::uint32_t middle) {
  const Triangle whole = triangles_[triangle];
  const auto& [apex, from, to] = whole.corners;
  const auto added = static_cast<std::uint32_t>(triangles_.size());
  triangles_[triangle] = {{middle, apex, from}, {whole.beyond[2], none, added}};
  triangles_.push_back({{middle, to, apex}, {whole.beyond[1], triangle, none}});
  replace_neighbour(whole.beyond[1], triangle, added);
  return added;
}

void Lattice::bisect(std::uint32_t triangle, std::vector<std::uint32_t>& changed) {
  std::uint32_t other = triangles_[triangle].beyond[0];
  if (other != none && triangles_[other].beyond[0] != triangle) {
    bisect(other, changed); // it was twice as large; its half shares the longest side
    other = triangles_[triangle].beyond[0];
  }
  const auto& [apex, from, to] = triangles_[triangle].corners;
  const auto middle = static_cast<std::uint32_t>(points_.size());
  points_.push_back((points_[from] + points_[to]) / 2);
  const std::uint32_t added = halve(triangle, middle);
  changed.insert(changed.end(), {triangle, added});
  if (other == none) return;
  const std::uint32_t other_added = halve(other, middle);
  changed.insert(changed.end(), {other, other_added});
  // Across the halved side: `from` of the one is `to` of the other.
  triangles_[triangle].beyond[1] = other_added;
  triangles_[other_added].beyond[2] = triangle;
  triangles_[added].beyond[2] = other;
  triangles_[other].beyond[1] = added;
}

} // namespace cupola::plan
