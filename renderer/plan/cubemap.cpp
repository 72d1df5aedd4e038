// Which parts of a cubemap a projection sees, and how fine it must be.
//
// The picture is divided like a quadtree. Each cell's directions lie in a cap about its middle, and the cap's
// outline on each face is known exactly; cells are divided until their caps are smaller than a texel, or lie
// in what is seen already. Caps are widened by two texels, so that bilinear reading stays inside, also across
// edges.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "renderer/plan/plan.h"

namespace cupola::plan {

namespace {

/// Part of a face in its own coordinates, [-1,1] from edge to edge. Empty as made.
struct Extent {
  glm::dvec2 low{2.0}, high{-2.0};
  [[nodiscard]] bool empty() const { return high.x < low.x; }
  [[nodiscard]] bool holds(const Extent& other, double slack) const {
    return other.low.x >= low.x - slack && other.low.y >= low.y - slack && other.high.x <= high.x + slack &&
           other.high.y <= high.y + slack;
  }
  void add(const Extent& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
};

struct Cap {
  glm::dvec3 center; ///< unit length
  double radius;     ///< radians
};

/// Tangents, clipped to a face, of the angles under which a cap appears along one axis of it. `sine`: of its
/// radius. Empty (low > high) when it does not reach the face.
glm::dvec2 tangents(double along, double ahead, double sine) {
  constexpr double eighth = std::numbers::pi / 4;
  const double distance = std::hypot(along, ahead);
  if (distance <= sine) return {-1.0, 1.0};
  const double middle = std::atan2(along, ahead), half = std::asin(sine / distance);
  if (middle - half > eighth || middle + half < -eighth) return {2.0, -2.0};
  return {middle - half <= -eighth ? -1.0 : std::tan(middle - half),
          middle + half >= eighth ? 1.0 : std::tan(middle + half)};
}

Extent cap_on_face(const Cap& cap, const glm::dmat3& axes) {
  if (cap.radius >= std::numbers::pi / 2) return {{-1.0, -1.0}, {1.0, 1.0}};
  const double ahead = glm::dot(axes[2], cap.center), sine = std::sin(cap.radius);
  const double corner = std::sqrt(1.0 / 3.0); // cosine of the angle to a face's corner
  if (ahead < corner * std::cos(cap.radius) - std::sqrt(2.0 / 3.0) * sine) return {};
  const glm::dvec2 s = tangents(glm::dot(axes[0], cap.center), ahead, sine);
  const glm::dvec2 t = tangents(glm::dot(axes[1], cap.center), ahead, sine);
  if (s.x > s.y || t.x > t.y) return {};
  return {{s.x, t.x}, {s.y, t.y}};
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

class Seen {
public:
  Seen(const projection::Map& map, const PixelRect& rect, int size)
      : map_(map)
      , texel_(2.0 / size)
      , margin_(2.0 * texel_) {
    const double pixels = 4.0 * std::max(rect.width, rect.height);
    deepest_ = std::max(least_ + 1, static_cast<int>(std::ceil(std::log2(pixels))));
  }

  void add_all() {
    add_samples();
    divide({0.0, 0.0}, 1.0, 0);
  }

  /// A part of the picture. False where its samples are too far apart to say what is seen between them.
  bool add_triangle(const std::array<glm::dvec2, 3>& corners) {
    constexpr int steps = 6;
    constexpr double farthest = 0.2; // radians
    std::optional<Cap> cap;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const double a = double(i) / steps, b = double(j) / steps;
        const auto direction =
            projection::ray(map_, a * corners[0] + b * corners[1] + (1.0 - a - b) * corners[2]);
        if (!direction) continue;
        const glm::dvec3 unit = glm::normalize(*direction);
        if (!cap) cap = Cap{unit, 0.0};
        cap->radius = std::max(cap->radius, angle(cap->center, unit));
      }
    if (!cap || cap->radius > farthest) return false;
    cap->radius = 1.25 * cap->radius + margin_;
    add(*cap);
    return true;
  }

  [[nodiscard]] CubeFace face(std::size_t index, int size) const {
    const Extent& e = extents_[index];
    if (e.empty()) return {};
    const auto low = [&](double v) {
      return std::clamp(static_cast<int>(std::floor((v - texel_ + 1.0) * 0.5 * size)), 0, size - 1);
    };
    const auto high = [&](double v) {
      return std::clamp(static_cast<int>(std::ceil((v + texel_ + 1.0) * 0.5 * size)), 1, size);
    };
    const int x = low(e.low.x), y = low(e.low.y);
    return {true, {x, y, high(e.high.x) - x, high(e.high.y) - y}};
  }

private:
  /// What is certainly seen, so that only its outskirts need dividing.
  void add_samples() {
    for (int y = -48; y <= 48; ++y)
      for (int x = -48; x <= 48; ++x)
        if (const auto direction = projection::ray(map_, glm::dvec2(x, y) / 48.0))
          add({glm::normalize(*direction), margin_});
  }

  /// Nine samples of a square of the picture.
  struct Cell {
    std::optional<Cap> cap; ///< about the middle, or another sample that shows something; holds all samples
    double step = 0.0;      ///< largest angle between neighbours; 0 where no two show something
    bool whole = true;
  };

  [[nodiscard]] Cell look(glm::dvec2 middle, double half) const {
    Cell cell;
    std::array<std::array<std::optional<glm::dvec3>, 3>, 3> samples;
    for (const std::size_t y : {1u, 0u, 2u}) // the middle first
      for (const std::size_t x : {1u, 0u, 2u}) {
        const auto direction =
            projection::ray(map_, middle + half * (glm::dvec2(double(x), double(y)) - glm::dvec2(1.0)));
        if (!direction) {
          cell.whole = false;
          continue;
        }
        samples[y][x] = glm::normalize(*direction);
        if (!cell.cap) cell.cap = Cap{*samples[y][x], 0.0};
        cell.cap->radius = std::max(cell.cap->radius, angle(cell.cap->center, *samples[y][x]));
      }
    if (cell.whole) return cell;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        if (samples[i][j] && samples[i][j + 1])
          cell.step = std::max(cell.step, angle(*samples[i][j], *samples[i][j + 1]));
        if (samples[j][i] && samples[j + 1][i])
          cell.step = std::max(cell.step, angle(*samples[j][i], *samples[j + 1][i]));
      }
    return cell;
  }

  /// Adds the square about `middle` of half the width `half`, in image coordinates, to what is seen.
  void divide(glm::dvec2 middle, double half, int depth) {
    Cell cell = look(middle, half);
    // Small parts between nine samples that all show nothing are looked for down to 1/64 of the picture.
    if (!cell.cap && depth >= least_ + 2) return;
    bool last = depth >= deepest_;
    if (cell.cap && depth >= least_) {
      // Between samples the map bends a little. A part that shows something may lie a diagonal from the
      // samples.
      const bool known = cell.whole || cell.step > 0.0;
      const double radius = 1.25 * std::max(cell.cap->radius, 3.0 * cell.step);
      last = last || (known && radius < texel_);
      cell.cap->radius = radius + margin_;
      if (last) add(*cell.cap);
      if (last || (known && !adds(*cell.cap))) return;
    }
    if (last) return;
    const double quarter = 0.5 * half;
    for (const double v : {-quarter, quarter})
      for (const double u : {-quarter, quarter}) divide(middle + glm::dvec2(u, v), quarter, depth + 1);
  }

  [[nodiscard]] bool adds(const Cap& cap) const {
    for (std::size_t i = 0; i < extents_.size(); ++i) {
      const Extent e = cap_on_face(cap, cube_face_axes()[i]);
      if (!e.empty() && !extents_[i].holds(e, texel_)) return true;
    }
    return false;
  }
  void add(const Cap& cap) {
    for (std::size_t i = 0; i < extents_.size(); ++i) extents_[i].add(cap_on_face(cap, cube_face_axes()[i]));
  }

  static constexpr int least_ = 4; ///< cells of 1/16 of the picture are small enough to trust a cap
  const projection::Map& map_;
  double texel_;  ///< in face coordinates, and radians in a face's middle, where texels are widest
  double margin_; ///< radians
  int deepest_;
  std::array<Extent, 6> extents_;
};

} // namespace

const std::array<glm::dmat3, 6>& cube_face_axes() {
  using glm::dmat3, glm::dvec3;
  static const std::array<dmat3, 6> axes{dmat3(dvec3(0, 0, -1), dvec3(0, -1, 0), dvec3(1, 0, 0)),
                                         dmat3(dvec3(0, 0, 1), dvec3(0, -1, 0), dvec3(-1, 0, 0)),
                                         dmat3(dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, 1, 0)),
                                         dmat3(dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(0, -1, 0)),
                                         dmat3(dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, 1)),
                                         dmat3(dvec3(-1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, -1))};
  return axes;
}

int matched_cubemap_size(const projection::Map& map, const PixelRect& rect) {
  // In a face's middle a face of N texels has N / 2 of them a radian.
  const double size = 2.0 * projection::matched_density(map, {rect.width, rect.height});
  return 8 * static_cast<int>(std::ceil(std::min(size, 1e8) / 8.0 - 1e-9));
}

CubemapPlan make_cubemap(const projection::Map& map, const PixelRect& rect, std::optional<int> size) {
  CubemapPlan plan;
  plan.size = size ? *size : std::clamp(matched_cubemap_size(map, rect), min_cubemap_size, max_cubemap_size);
  // A camera texture sees no more than the flat picture that it bends.
  const projection::Map flat = projection::before_bending(map);
  Seen seen(flat, rect, plan.size);
  seen.add_all();
  for (std::size_t i = 0; i < plan.faces.size(); ++i) plan.faces[i] = seen.face(i, plan.size);
  return plan;
}

CubemapPlan make_cubemap(const projection::Map& map, const PixelRect& rect, std::optional<int> size,
                         const std::vector<std::array<glm::dvec2, 3>>& parts) {
  CubemapPlan plan;
  plan.size = size ? *size : std::clamp(matched_cubemap_size(map, rect), min_cubemap_size, max_cubemap_size);
  Seen seen(map, rect, plan.size);
  for (const auto& part : parts)
    if (!seen.add_triangle(part)) return make_cubemap(map, rect, size);
  for (std::size_t i = 0; i < plan.faces.size(); ++i) plan.faces[i] = seen.face(i, plan.size);
  return plan;
}

} // namespace cupola::plan
