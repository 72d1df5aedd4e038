#include "renderer/plan/measure.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cupola::plan {

namespace {

class Extender {
public:
  void add(double value) {
    extent_.smallest = count_ == 0 ? value : std::min(extent_.smallest, value);
    extent_.largest = count_ == 0 ? value : std::max(extent_.largest, value);
    extent_.mean += (value - extent_.mean) / ++count_;
  }
  [[nodiscard]] const Extent& extent() const { return extent_; }

private:
  Extent extent_;
  int count_ = 0;
};

/// Rays and counters of the grid.
class Grid {
public:
  Grid(const projection::Map& map, const PixelRect& rect, int step)
      : map_(map)
      , rect_(rect)
      , step_(step)
      , across_((rect.width + step - 1) / step)
      , times_(static_cast<std::size_t>(across_) *
               static_cast<std::size_t>((rect.height + step - 1) / step)) {}

  [[nodiscard]] bool holds(int x, int y) const { return x % step_ == 0 && y % step_ == 0; }
  [[nodiscard]] unsigned char& times(int x, int y) {
    return times_[static_cast<std::size_t>(y / step_) * static_cast<std::size_t>(across_) +
                  static_cast<std::size_t>(x / step_)];
  }
  [[nodiscard]] std::optional<glm::dvec3> ray(int x, int y) const {
    return projection::ray(map_,
                           {-1.0 + (2.0 * x + 1.0) / rect_.width, 1.0 - (2.0 * y + 1.0) / rect_.height});
  }

private:
  const projection::Map& map_;
  const PixelRect& rect_;
  int step_, across_;
  std::vector<unsigned char> times_; ///< how often a pixel is covered
};

bool within(const PixelRect& bounds, int x, int y) {
  return x >= bounds.x && y >= bounds.y && x < bounds.x + bounds.width && y < bounds.y + bounds.height;
}

/// One pixel of a piece; returns the square of its error.
double take(Measured& out, const Piece& piece, const glm::dvec3& ray, const PixelRect& rect, int x, int y) {
  const glm::dvec3 h = piece.to_screen * ray;
  const double error = std::hypot((h.x / h.z + 1.0) * 0.5 * rect.width - x - 0.5,
                                  (1.0 - h.y / h.z) * 0.5 * rect.height - y - 0.5);
  out.largest = std::max(out.largest, error);
  out.least_w = out.drawn == 0 ? h.z : std::min(out.least_w, h.z);
  ++out.drawn;
  if (!within(piece.bounds, x + rect.x, y + rect.y)) ++out.outside_bounds;
  return error * error;
}

} // namespace

std::array<glm::dvec2, 3> in_pixels(const std::array<glm::dvec2, 3>& screen, const PixelRect& rect) {
  std::array<glm::dvec2, 3> out;
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = {(screen[i].x + 1.0) * 0.5 * rect.width, (1.0 - screen[i].y) * 0.5 * rect.height};
  return out;
}

std::vector<glm::dvec2> outline(const PieceSet& set, std::size_t piece, const PixelRect& rect) {
  if (!set.triangles.empty()) {
    const auto& t = set.triangles[piece];
    const auto p =
        in_pixels({set.corners[t[0]].screen, set.corners[t[1]].screen, set.corners[t[2]].screen}, rect);
    return {p.begin(), p.end()};
  }
  const PixelRect& b = set.pieces[piece].bounds;
  const double left = b.x - rect.x, top = b.y - rect.y;
  return {{left, top}, {left, top + b.height}, {left + b.width, top + b.height}, {left + b.width, top}};
}

void each_pixel(const std::vector<glm::dvec2>& polygon, const PixelRect& rect,
                const std::function<void(int x, int y)>& take) {
  glm::dvec2 low = polygon[0], high = low;
  for (const glm::dvec2& p : polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  for (int y = std::max(0, static_cast<int>(low.y)); y < std::min<double>(high.y, rect.height); ++y)
    for (int x = std::max(0, static_cast<int>(low.x)); x < std::min<double>(high.x, rect.width); ++x) {
      bool left = true, right = true; // of all sides: folded pieces run the other way
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 side = polygon[(i + 1) % polygon.size()] - polygon[i];
        const glm::dvec2 to = glm::dvec2(x + 0.5, y + 0.5) - polygon[i];
        const double turn = side.x * to.y - side.y * to.x;
        left = left && turn < 0.0;
        right = right && turn > 0.0;
      }
      if (left || right) take(x, y);
    }
}

Extents extents(const PieceSet& set, const PixelRect& rect) {
  Extender width, height;
  for (std::size_t i = 0; i < set.pieces.size(); ++i) {
    const auto polygon = outline(set, i, rect);
    const auto [left, right] =
        std::minmax_element(polygon.begin(), polygon.end(), [](auto& a, auto& b) { return a.x < b.x; });
    const auto [top, bottom] =
        std::minmax_element(polygon.begin(), polygon.end(), [](auto& a, auto& b) { return a.y < b.y; });
    width.add(right->x - left->x);
    height.add(bottom->y - top->y);
  }
  return {width.extent(), height.extent()};
}

Measured measure(const PieceSet& set, const projection::Map& map, const PixelRect& rect, int step) {
  Measured out;
  Grid grid(map, rect, step);
  double square_sum = 0.0;
  for (std::size_t i = 0; i < set.pieces.size(); ++i) {
    const bool all_shown = i < set.shown.size() && set.shown[i] == Shown::all;
    each_pixel(outline(set, i, rect), rect, [&](int x, int y) {
      if (!grid.holds(x, y)) return;
      const auto ray = grid.ray(x, y);
      if (!ray) {
        if (all_shown) ++out.not_shown;
        return;
      }
      ++grid.times(x, y);
      square_sum += take(out, set.pieces[i], *ray, rect, x, y);
    });
  }
  for (const auto& screen : set.looked_up) {
    const auto p = in_pixels(screen, rect);
    each_pixel({p.begin(), p.end()}, rect, [&](int x, int y) {
      if (!grid.holds(x, y) || !grid.ray(x, y)) return;
      ++grid.times(x, y);
      ++out.looked_up;
    });
  }
  for (int y = 0; y < rect.height; y += step)
    for (int x = 0; x < rect.width; x += step) {
      const int n = grid.times(x, y);
      const bool shown = n > 0 || grid.ray(x, y);
      out.shown += shown ? 1 : 0;
      if (shown && n == 0) ++out.uncovered;
      if (n > 1) ++out.covered_twice;
    }
  out.rms = out.drawn > 0 ? std::sqrt(square_sum / static_cast<double>(out.drawn)) : 0.0;
  return out;
}

} // namespace cupola::plan
