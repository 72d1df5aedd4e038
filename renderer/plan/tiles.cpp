#include "renderer/plan/tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace cupola::plan {

namespace {

using Triangles = std::vector<std::array<glm::dvec2, 3>>;

constexpr int longest = 16;       ///< times a tile's shorter side
constexpr double thinnest = 32.0; ///< of a diagonal p:q, √(p² + q²): it keeps half a pixel over that clear

/// The number's four highest bits.
int round_part(int n) {
  const int bits = std::bit_width(static_cast<std::uint32_t>(n));
  return bits <= 4 ? n : n >> (bits - 4) << (bits - 4);
}

int twos(int n) { return std::countr_zero(static_cast<std::uint32_t>(n)); }

void halves(const PixelRect& r, Triangles& out) {
  const double left = r.x, top = r.y, right = r.x + r.width, bottom = r.y + r.height;
  out.push_back({{{left, top}, {left, bottom}, {right, bottom}}});
  out.push_back({{{left, top}, {right, bottom}, {right, top}}});
}

/// Its diagonal would run through the centre: three triangles around it.
void single_pixel(const PixelRect& r, Triangles& out) {
  const double left = r.x, top = r.y, right = r.x + 1, bottom = r.y + 1, split = r.y + 0.25;
  out.push_back({{{left, top}, {right, split}, {right, top}}});
  out.push_back({{{left, top}, {left, bottom}, {right, split}}});
  out.push_back({{{left, bottom}, {right, bottom}, {right, split}}});
}

void tile(const PixelRect& r, Triangles& out);

void cut_across(const PixelRect& r, int width, Triangles& out) {
  tile({r.x, r.y, width, r.height}, out);
  tile({r.x + width, r.y, r.width - width, r.height}, out);
}

void cut_down(const PixelRect& r, int height, Triangles& out) {
  tile({r.x, r.y, r.width, height}, out);
  tile({r.x, r.y + height, r.width, r.height - height}, out);
}

void tile(const PixelRect& r, Triangles& out) {
  const int w = r.width, h = r.height;
  if (round_part(w) != w) return cut_across(r, round_part(w), out);
  if (round_part(h) != h) return cut_down(r, round_part(h), out);
  if (w > longest * h) return cut_across(r, round_part(w / 2), out);
  if (h > longest * w) return cut_down(r, round_part(h / 2), out);
  const int unit = std::gcd(w, h);
  if (std::hypot(w / unit, h / unit) > thinnest) {
    const int side = std::max(w, h),
              high = static_cast<int>(std::bit_floor(static_cast<std::uint32_t>(side)));
    const int at = high == side ? side / 2 : high;
    return w >= h ? cut_across(r, at, out) : cut_down(r, at, out);
  }
  if (twos(w) != twos(h)) return halves(r, out);
  if (w == 1 && h == 1) return single_pixel(r, out);
  // Half of an even side, all but a pixel of an odd one.
  if (w >= h) return cut_across(r, w % 2 == 0 ? w / 2 : w - 1, out);
  cut_down(r, h % 2 == 0 ? h / 2 : h - 1, out);
}

} // namespace

std::vector<std::array<glm::dvec2, 3>> tile_triangles(const PixelRect& rect) {
  Triangles out;
  if (rect.width > 0 && rect.height > 0) tile(rect, out);
  return out;
}

} // namespace cupola::plan
