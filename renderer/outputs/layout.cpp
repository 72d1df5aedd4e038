#include "renderer/outputs/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cupola::outputs {

Rect letterbox(Size picture, Size window) {
  if (picture.width <= 0 || picture.height <= 0 || window.width <= 0 || window.height <= 0) return {};
  const auto across = static_cast<std::int64_t>(window.width) * picture.height;
  const auto down = static_cast<std::int64_t>(window.height) * picture.width;
  Size fit = window;
  if (across > down)
    fit.width = static_cast<int>((down + picture.height / 2) / picture.height);
  else if (down > across)
    fit.height = static_cast<int>((across + picture.width / 2) / picture.width);
  fit.width = std::max(fit.width, 1);
  fit.height = std::max(fit.height, 1);
  return {(window.width - fit.width) / 2, (window.height - fit.height) / 2, fit.width, fit.height};
}

namespace {

/// Rows from the top left; `fits` tells whether all ended inside the area.
std::vector<Rect> rows(const std::vector<Size>& pictures, Size area, int gap, double scale, bool& fits) {
  std::vector<Rect> placed;
  int x = 0, y = 0, row_height = 0;
  fits = true;
  for (const Size& picture : pictures) {
    const int width = std::max(1, static_cast<int>(std::lround(picture.width * scale)));
    const int height = std::max(1, static_cast<int>(std::lround(picture.height * scale)));
    if (x > 0 && x + width > area.width) {
      x = 0;
      y += row_height + gap;
      row_height = 0;
    }
    fits = fits && x + width <= area.width && y + height <= area.height;
    placed.push_back({x, y, width, height});
    x += width + gap;
    row_height = std::max(row_height, height);
  }
  return placed;
}

} // namespace

std::vector<Rect> tile(const std::vector<Size>& pictures, Size area, int gap) {
  constexpr std::array scales{1.0,       3.0 / 4.0, 1.0 / 2.0,  1.0 / 3.0, 1.0 / 4.0,
                              1.0 / 6.0, 1.0 / 8.0, 1.0 / 12.0, 1.0 / 16.0};
  bool fits = false;
  std::vector<Rect> placed;
  for (const double scale : scales) {
    placed = rows(pictures, area, gap, scale, fits);
    if (fits) break;
  }
  return placed;
}

} // namespace cupola::outputs
