// Triangular pieces of a projection: one adaptive mesh, or, where a map has breaks, each part between them
// for itself.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "renderer/plan/cell_mesh.h"
#include "renderer/plan/corner.h"
#include "renderer/plan/plan.h"
#include "renderer/plan/shown_rows.h"
#include "renderer/plan/tiles.h"

namespace cupola::plan {

namespace {

/// Whole pixels at which parts begin: centres beyond a break belong to the next part.
std::vector<int> borders(const std::vector<double>& breaks, int size, bool downwards) {
  std::vector<int> out{0};
  for (const double at : breaks) {
    const double pixel = (downwards ? 1.0 - at : 1.0 + at) * 0.5 * size;
    out.push_back(std::clamp(static_cast<int>(std::ceil(pixel - 0.5)), 0, size));
  }
  out.push_back(size);
  std::sort(out.begin(), out.end());
  return out;
}

/// The rectangle around what is shown.
PixelRect shown_box(const ShownRows& rows) {
  const PixelRect& part = rows.part();
  int left = part.x + part.width, right = part.x, top = part.y + part.height, bottom = part.y;
  for (int y = part.y; y < part.y + part.height; ++y) {
    const PixelRun run = rows.row(y);
    if (run.first >= run.end) continue;
    left = std::min(left, run.first);
    right = std::max(right, run.end);
    top = std::min(top, y);
    bottom = y + 1;
  }
  return {left, top, right - left, bottom - top};
}

/// A part with borders on all sides: what is a perspective there becomes a few pieces, all else is looked up.
class BorderedPart {
public:
  BorderedPart(const projection::Map& map, glm::ivec2 size, const PixelRect& box, double max_error)
      : picture_{map, size, {}}
      , limit_(max_error)
      , box_(box) {
    picture_.inside = picture_.image({box.x + 0.5 * box.width, box.y + 0.5 * box.height});
  }

  void append_to(PieceSet& set) {
    for (const auto& at : tile_triangles(box_)) {
      const auto error = error_of(at);
      if (!error || *error > std::max(limit_, worst_drawn)) {
        set.looked_up.push_back({picture_.image(at[0]), picture_.image(at[1]), picture_.image(at[2])});
        continue;
      }
      set.max_error = std::max(set.max_error, *error);
      set.triangles.push_back({number(at[0], set), number(at[1], set), number(at[2], set)});
      set.shown.push_back(Shown::all);
    }
  }

private:
  std::optional<Corner> corner(glm::dvec2 at) const {
    const auto ray = picture_.ray(at);
    const auto weight = picture_.weight(at);
    if (!ray || !weight) return std::nullopt;
    return Corner{glm::normalize(*ray), *weight, picture_.image(at)};
  }

  std::optional<double> error_of(const std::array<glm::dvec2, 3>& at) const {
    constexpr int steps = 4;
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto made = corner(at[i]);
      if (!made) return std::nullopt;
      corners[i] = *made;
    }
    const Drawing draw(corners, at);
    if (!draw.fit()) return std::nullopt;
    double largest = 0.0;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const double a = double(i) / steps, b = double(j) / steps;
        const glm::dvec2 place = a * at[0] + b * at[1] + (1.0 - a - b) * at[2];
        const auto ray = picture_.ray(place);
        if (!ray) return std::nullopt;
        largest = std::max(largest, glm::distance(draw(*ray), place));
      }
    return largest;
  }

  std::uint32_t number(glm::dvec2 at, PieceSet& set) {
    const auto [place, added] = numbers_.try_emplace({at.x, at.y}, 0);
    if (added) {
      place->second = static_cast<std::uint32_t>(set.corners.size());
      set.corners.push_back(*corner(at));
    }
    return place->second;
  }

  PictureMap picture_;
  double limit_;
  PixelRect box_;
  std::map<std::pair<double, double>, std::uint32_t> numbers_;
};

} // namespace

std::optional<PieceSet> make_cells(const projection::Map& map, const PixelRect& rect, double max_error) {
  if (rect.width <= 0 || rect.height <= 0 || !projection::inside(map)) return std::nullopt;
  PieceSet set;
  const glm::ivec2 size(rect.width, rect.height);
  const projection::Breaks breaks = projection::breaks(map);
  const std::vector<int> columns = borders(breaks.s, size.x, false), rows = borders(breaks.t, size.y, true);
  const bool whole = columns.size() == 2 && rows.size() == 2;
  long count = 0;
  for (std::size_t j = 0; j + 1 < rows.size(); ++j)
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      const PixelRect part{columns[i], rows[j], columns[i + 1] - columns[i], rows[j + 1] - rows[j]};
      const ShownRows shown(map, size, part);
      if (shown.count() == 0) continue;
      count += shown.count();
      if (whole) {
        CellMesh(map, size, shown, max_error, max_cells).append_to(set);
      } else {
        BorderedPart(map, size, shown_box(shown), max_error).append_to(set);
      }
    }
  if (count == 0) return std::nullopt;
  set.fills = count == long(size.x) * size.y;
  finish_triangles(set, rect);
  return set;
}

} // namespace cupola::plan
