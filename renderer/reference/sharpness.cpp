#include "renderer/reference/sharpness.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cupola::reference {

namespace {

struct Gradient {
  double x, y;
};

double luma(const Pixels& picture, std::size_t pixel) {
  const std::uint8_t* rgb = picture.rgba.data() + 4 * pixel;
  return 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
}

/// Sobel's, in steps of luma per pixel.
Gradient gradient(const Pixels& picture, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(picture.width);
  const auto at = [&](std::size_t i) { return luma(picture, i); };
  const std::size_t above = pixel - width, below = pixel + width;
  return {(at(above + 1) - at(above - 1) + 2.0 * (at(pixel + 1) - at(pixel - 1)) + at(below + 1) -
           at(below - 1)) /
              8.0,
          (at(below - 1) - at(above - 1) + 2.0 * (at(below) - at(above)) + at(below + 1) - at(above + 1)) /
              8.0};
}

bool shown(const Pixels& wanted, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(wanted.width);
  for (const std::size_t row : {pixel - width, pixel, pixel + width})
    for (const std::size_t i : {row - 1, row, row + 1})
      if (wanted.rgba[4 * i + 3] != 255) return false;
  return true;
}

struct Edge {
  std::size_t pixel;
  Gradient gradient;
  double length;
};

} // namespace

std::optional<double> edge_sharpness(const Pixels& got, const Pixels& wanted, bool mask) {
  assert(got.width == wanted.width && got.height == wanted.height);
  std::vector<Edge> edges;
  for (int y = 1; y + 1 < wanted.height; ++y)
    for (int x = 1; x + 1 < wanted.width; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(wanted.width) + static_cast<std::size_t>(x);
      if (mask && !shown(wanted, pixel)) continue;
      const Gradient g = gradient(wanted, pixel);
      if (const double length = std::hypot(g.x, g.y); length > 0.0) edges.push_back({pixel, g, length});
    }
  if (edges.empty()) return std::nullopt;
  const std::size_t count = std::max<std::size_t>(edges.size() / 10, 1);
  std::nth_element(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(count - 1), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.length > b.length; });
  edges.resize(count);
  double along = 0.0, whole = 0.0;
  for (const Edge& edge : edges) {
    const Gradient g = gradient(got, edge.pixel);
    along += (g.x * edge.gradient.x + g.y * edge.gradient.y) / edge.length;
    whole += edge.length;
  }
  return along / whole;
}

} // namespace cupola::reference
