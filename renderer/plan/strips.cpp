// A cylinder as strips of one perspective each [Lorenz & Döllner, sec. 3.1].
//
// A strip is given by the rays at its left and right border, seen from the eye: L and R, horizontal, of
// length 1 before the off-axis vector. A point v = a L + b R + y Y (Y the axis) has w = a + b, and lands at x
// w = a s_L + b s_R, y w = (k y + O.y w) / top with `top` the tangent at the image's top: a linear map, exact
// across at both borders. With O = 0 this is the paper's M_tx M_sx M_p M_ry (eq. 1), whose vertical scale is
// free. With k = 1 heights would be exact at the borders and too small in the middle, where w > 1; with
// the eye on the axis, one k slightly above 1 for all strips halves that error and keeps heights and w
// continuous over all borders.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <utility>

#include "renderer/plan/plan.h"

namespace cupola::plan {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double widest = 2.0 * pi / 3.0; ///< angle of a strip as the eye sees it; at π it would degenerate

/// A matrix from its rows.
glm::dmat3 rows(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& w) {
  return glm::transpose(glm::dmat3(x, y, w));
}

/// A column border: where it stands in the image and the ray that it shows, in the cylinder's axes.
struct Border {
  double s;
  glm::dvec2 ray; ///< x, z
};

struct Error {
  double largest = 0.0, square_sum = 0.0; ///< pixels; over all pixels, the sum by columns
};

/// A strip in the cylinder's axes: rows of its map, but for the vertical one, which all strips share.
struct Strip {
  glm::dvec3 x, w;
  double highest_w = 1.0; ///< on the wall, at a pixel column of the strip
};

class Wall {
public:
  Wall(const projection::CylinderMap& shape, const projection::Map& map, const PixelRect& rect)
      : eye_(map.off_axis)
      , angle_(shape.half_h / map.zoom)
      , top_(shape.tan_half_v / map.zoom)
      , width_(rect.width)
      , height_(rect.height) {
    const double reach = pi / angle_; // image coordinate of half a turn
    clipped_ = reach < 1.0 - 1e-12;
    if (clipped_) first_ = static_cast<int>(std::ceil((1.0 - reach) * 0.5 * width_ - 0.5));
  }

  /// Columns whose centres show something: first() to width − first() − 1.
  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int end() const { return width_ - first_; }

  /// Border at a column's left edge. The outermost ones stand at half a turn when the picture reaches so far.
  [[nodiscard]] Border border(int column) const {
    if (clipped_ && column <= first_) return at(-pi / angle_);
    if (clipped_ && column >= end()) return at(pi / angle_);
    return at(image_s(column));
  }

  /// nullopt when the borders are too far apart for one perspective.
  [[nodiscard]] std::optional<Strip> strip(int from, int to) const {
    const Border left = border(from), right = border(to);
    const glm::dvec2 l = left.ray, r = right.ray;
    const double det = l.x * r.y - l.y * r.x;
    const double angle = std::atan2(det, glm::dot(l, r));
    if (!(angle > 0.0) || angle > widest) return std::nullopt;
    const glm::dvec3 a = glm::dvec3(r.y, 0.0, -r.x) / det, b = glm::dvec3(-l.y, 0.0, l.x) / det;
    Strip out;
    out.w = a + b;
    out.x = left.s * a + right.s * b;
    for (int column = from; column < to; ++column) {
      const glm::dvec2 foot = at(image_s(column + 0.5)).ray;
      out.highest_w = std::max(out.highest_w, out.w.x * foot.x + out.w.z * foot.y);
    }
    return out;
  }

  /// Distance between the true image and the strip's, at pixel centres. In a column the vertical error is
  /// linear in t, so the largest is at the top or bottom pixel.
  [[nodiscard]] Error error(const Strip& strip, int from, int to, double k) const {
    Error out;
    const double edge = 1.0 - 1.0 / height_; // t of the top pixel's centre
    for (int column = from; column < to; ++column) {
      const double s = image_s(column + 0.5);
      const glm::dvec2 foot = at(s).ray;
      const glm::dvec3 level(foot.x, -eye_.y, foot.y); // the ray at t = 0
      const double w = glm::dot(strip.w, level);
      const double across = (glm::dot(strip.x, level) / w - s) * 0.5 * width_;
      const double slope = (k / w - 1.0) * 0.5 * height_, center = eye_.y / top_;
      const double upwards = std::abs(slope) * (edge + std::abs(center));
      out.largest = std::max(out.largest, std::hypot(across, upwards));
      // The mean of (t − center)² over the pixel centres of a column is known.
      const double mean = (1.0 - 1.0 / (double(height_) * height_)) / 3.0 + center * center;
      out.square_sum += across * across + slope * slope * mean;
    }
    return out;
  }

  [[nodiscard]] std::optional<double> largest_error(int from, int to) const {
    const auto made = strip(from, to);
    if (!made) return std::nullopt;
    return error(*made, from, to, balance(*made)).largest;
  }

  /// The eye is on the axis: all strips are alike, and of equal width.
  [[nodiscard]] bool centred() const { return eye_.x == 0.0 && eye_.z == 0.0; }

  /// The k with which heights are as much too large at the strip's borders as too small in its middle. Where
  /// strips differ it would help one and hurt another: there it is 1.
  [[nodiscard]] double balance(const Strip& strip) const {
    return centred() ? 2.0 / (1.0 + 1.0 / strip.highest_w) : 1.0;
  }

  /// Row of the map for heights.
  [[nodiscard]] glm::dvec3 heights(const Strip& strip, double k) const {
    return (glm::dvec3(0.0, k, 0.0) + eye_.y * strip.w) / top_;
  }

private:
  [[nodiscard]] double image_s(double column) const { return -1.0 + 2.0 * column / width_; }
  [[nodiscard]] Border at(double s) const {
    const double azimuth = s * angle_;
    glm::dvec2 foot(std::sin(azimuth), -std::cos(azimuth));
    if (std::abs(azimuth) > pi - 1e-12) foot = {0.0, 1.0}; // both ends of a full turn are the same ray
    return {s, foot - glm::dvec2(eye_.x, eye_.z)};
  }

  glm::dvec3 eye_;
  double angle_; ///< azimuth at s = 1
  double top_;   ///< tangent at t = 1
  int width_, height_;
  int first_ = 0;
  bool clipped_ = false; ///< the picture reaches half a turn inside its borders
};

/// The column up to which one strip that starts at `from` keeps within `max_error`; one column at least.
int farthest(const Wall& wall, int from, double max_error) {
  const auto good = [&](int to) {
    const auto error = wall.largest_error(from, to);
    return error && *error <= max_error;
  };
  int low = from + 1, step = 1;
  while (low + step <= wall.end() && good(low + step)) {
    low += step;
    step *= 2;
  }
  int high = std::min(low + step, wall.end() + 1); // not good, or beyond the end
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (good(middle) ? low : high) = middle;
  }
  return low;
}

/// Fewest strips: each as wide as the error allows.
std::vector<int> greedy_borders(const Wall& wall, double max_error) {
  std::vector<int> borders{wall.first()};
  while (borders.back() < wall.end()) borders.push_back(farthest(wall, borders.back(), max_error));
  return borders;
}

/// Rasterisers work in square blocks; llvmpipe's are 64, 16 and 4 pixels wide. A strip that cuts through
/// blocks pays for them once more: strips of 16 pixels took 0.86 of the time of 14 (table 1, 1600 pixels).
constexpr int block = 16;

/// Strips of equal width, up to a block where they are at least as wide as one, else up to a pixel.
/// `allowed`: what the error allows, the same everywhere.
std::vector<int> equal_borders(const Wall& wall, const PixelRect& rect, int allowed) {
  const int unit = allowed >= block && rect.x % block == 0 && wall.first() == 0 ? block : 1;
  const int columns = wall.end() - wall.first();
  const int width = allowed / unit * unit;
  const int count = (columns + width - 1) / width;
  const int units = (columns + unit - 1) / unit; // the last may be cut
  std::vector<int> borders;
  for (int i = 0; i < count; ++i)
    borders.push_back(wall.first() + unit * static_cast<int>(std::int64_t{units} * i / count));
  borders.push_back(wall.end());
  return borders;
}

/// Normal of the plane through the eye, the axis and a border ray; it points to the right.
glm::dvec3 rightwards(const Border& border) {
  return glm::dvec3(-border.ray.y, 0.0, border.ray.x) / glm::length(border.ray);
}

std::optional<PieceSet> build(const Wall& wall, const std::vector<int>& borders,
                              const glm::dmat3& orientation, const PixelRect& rect) {
  std::vector<Strip> strips;
  double k = 1.0;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const auto strip = wall.strip(borders[i], borders[i + 1]);
    if (!strip) return std::nullopt;
    k = std::max(k, wall.balance(*strip));
    strips.push_back(*strip);
  }
  PieceSet set;
  set.strips = true;
  double square_sum = 0.0;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const int from = borders[i], to = borders[i + 1];
    const Error error = wall.error(strips[i], from, to, k);
    set.max_error = std::max(set.max_error, error.largest);
    square_sum += error.square_sum;
    Piece piece;
    piece.to_screen =
        rows(strips[i].x, wall.heights(strips[i], k), strips[i].w) * glm::transpose(orientation);
    piece.planes[0] = orientation * rightwards(wall.border(from));
    piece.planes[1] = -(orientation * rightwards(wall.border(to)));
    piece.planes[2] = glm::dvec3(0.0);
    piece.plane_count = 2;
    piece.bounds = {rect.x + from, rect.y, to - from, rect.height};
    set.pieces.push_back(piece);
  }
  set.rms_error = std::sqrt(square_sum / (borders.back() - borders.front()));
  return set;
}

std::optional<PieceSet> cylinder_strips(const projection::CylinderMap& shape, const projection::Map& map,
                                        const PixelRect& rect, double max_error) {
  const Wall wall(shape, map, rect);
  if (wall.first() >= wall.end()) return std::nullopt;
  const int widest_columns = farthest(wall, wall.first(), max_error) - wall.first();
  return build(wall,
               wall.centred() ? equal_borders(wall, rect, widest_columns) : greedy_borders(wall, max_error),
               map.orientation, rect);
}

PieceSet perspective_piece(const projection::PerspectiveMap& shape, const projection::Map& map,
                           const PixelRect& rect) {
  const glm::dvec3& eye = map.off_axis;
  const glm::dvec3 w(0.0, 0.0, -1.0 / (1.0 + eye.z)); // 1 where a ray of the map ends
  const glm::dvec3 x = (glm::dvec3(1.0, 0.0, 0.0) + eye.x * w) * (map.zoom / shape.tan_half_h);
  const glm::dvec3 y = (glm::dvec3(0.0, 1.0, 0.0) + eye.y * w) * (map.zoom / shape.tan_half_v);
  Piece piece;
  piece.to_screen = rows(x, y, w) * glm::transpose(map.orientation);
  piece.planes.fill(glm::dvec3(0.0));
  piece.bounds = rect;
  PieceSet set;
  set.pieces.push_back(piece);
  set.strips = true;
  return set;
}

} // namespace

std::optional<PieceSet> make_strips(const projection::Map& map, const PixelRect& rect, double max_error) {
  if (rect.width <= 0 || rect.height <= 0 || !projection::inside(map)) return std::nullopt;
  if (const auto* flat = std::get_if<projection::PerspectiveMap>(&map.shape))
    return perspective_piece(*flat, map, rect);
  if (const auto* wall = std::get_if<projection::CylinderMap>(&map.shape))
    return cylinder_strips(*wall, map, rect, max_error);
  return std::nullopt;
}

} // namespace cupola::plan
