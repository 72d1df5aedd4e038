// Triangular pieces of a projection.
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "renderer/plan/plan.h"

namespace cupola::plan {

namespace {

constexpr int cell_width = 48, cell_height = 32;

} // namespace

std::optional<PieceSet> make_cells(const projection::Map& map, const PixelRect& rect, double max_error) {
  if (rect.width <= 0 || rect.height <= 0 || !projection::inside(map)) return std::nullopt;
  PieceSet set;
  set.max_error = max_error;
  std::map<std::pair<int, int>, std::optional<std::uint32_t>> numbers;
  const auto corner = [&](int x, int y) {
    const auto [at, added] = numbers.try_emplace({x, y});
    if (!added) return at->second;
    const glm::dvec2 st(-1.0 + 2.0 * x / rect.width, 1.0 - 2.0 * y / rect.height);
    if (const auto ray = projection::ray(map, st)) {
      at->second = static_cast<std::uint32_t>(set.corners.size());
      set.corners.push_back({glm::normalize(*ray), 1.0, st});
    }
    return at->second;
  };
  set.fills = true;
  for (int y = 0; y < rect.height; y += cell_height)
    for (int x = 0; x < rect.width; x += cell_width) {
      const auto a = corner(x, y), b = corner(x + cell_width, y), c = corner(x, y + cell_height),
                 d = corner(x + cell_width, y + cell_height);
      if (!a || !b || !c || !d) {
        set.fills = false;
        continue;
      }
      set.triangles.push_back({*a, *c, *d});
      set.triangles.push_back({*a, *d, *b});
      set.shown.insert(set.shown.end(), 2, Shown::all);
    }
  if (set.triangles.empty()) return std::nullopt;
  finish_triangles(set, rect);
  return set;
}

} // namespace cupola::plan
