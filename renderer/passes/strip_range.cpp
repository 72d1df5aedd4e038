#include "renderer/passes/strip_range.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace cupola::passes {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float turn = 2.0f * pi;
constexpr float margin = 1e-4f; // radians; float azimuths are good to 1e-6

float short_turn(float a) { return a > pi ? a - turn : (a < -pi ? a + turn : a); }

} // namespace

float StripAzimuths::azimuth(const glm::vec3& p) { return std::atan2(p.x, -p.z); }

StripAzimuths::StripAzimuths(const plan::PieceSet& set, const glm::dmat3& axes)
    : axes_from_view_(glm::transpose(axes)) {
  assert(set.strips && !set.pieces.empty() && set.pieces.front().plane_count == 2);
  const glm::dmat3 turned = glm::transpose(axes);
  // The left plane's normal points right: at azimuth a it is (cos a, 0, sin a).
  double last = 0.0;
  const auto push = [&](const glm::dvec3& rightwards) {
    const glm::dvec3 n = turned * rightwards;
    double a = std::atan2(n.z, n.x);
    if (!borders_.empty())
      while (a <= last) a += 2.0 * std::numbers::pi;
    last = a;
    borders_.push_back(static_cast<float>(a));
  };
  for (const plan::Piece& piece : set.pieces) push(piece.planes[0]);
  push(-set.pieces.back().planes[1]);
  // atan2 may give the left border of a full turn as +π: the field is then turned to lie around azimuth 0.
  const float middle = (borders_.front() + borders_.back()) / 2.0f;
  const float turns = std::round(middle / turn) * turn;
  for (float& border : borders_) border -= turns;
  full_turn_ = borders_.back() - borders_.front() > turn - 1e-4f;
}

int StripAzimuths::strip_at(float a) const {
  const auto above = std::upper_bound(borders_.begin() + 1, borders_.end() - 1, a);
  return static_cast<int>(above - borders_.begin()) - 1;
}

StripRange StripAzimuths::between(float from, float to) const {
  const float left = borders_.front(), right = borders_.back();
  const float turns = std::floor((from - left) / turn) * turn;
  from -= turns;
  to -= turns;
  if (full_turn_) {
    const int first = strip_at(from);
    const int last = to < right ? strip_at(to) : strip_at(to - turn) + count();
    return {first, std::min(last - first + 1, count())};
  }
  const bool starts_inside = from <= right;
  const bool wraps_inside = to - turn >= left;
  if (starts_inside && wraps_inside) return {0, count()};
  if (starts_inside) {
    const int first = strip_at(from);
    return {first, strip_at(std::min(to, right)) - first + 1};
  }
  if (wraps_inside) return {0, strip_at(std::min(to - turn, right)) + 1};
  return {};
}

StripRange StripAzimuths::triangle(float a, float b, float c) const {
  const float ab = short_turn(b - a), bc = short_turn(c - b), ca = short_turn(a - c);
  const float longest = std::max({std::abs(ab), std::abs(bc), std::abs(ca)});
  if (std::abs(ab + bc + ca) > pi || longest > pi - 1e-3f)
    return {0, count()}; // pierced by the axis, or nearly
  const float low = std::min({0.0f, ab, ab + bc}), high = std::max({0.0f, ab, ab + bc});
  return between(a + low - margin, a + high + margin);
}

StripRange StripAzimuths::sphere(const glm::vec3& center, float radius) const {
  const float distance = std::hypot(center.x, center.z);
  if (distance <= radius) return {0, count()};
  const float half = std::asin(radius / distance) + margin;
  const float middle = azimuth(center);
  return between(middle - half, middle + half);
}

} // namespace cupola::passes
