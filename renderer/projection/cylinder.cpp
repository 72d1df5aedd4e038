#include "renderer/projection/cylinder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cupola::projection {

std::optional<glm::dvec3> cylinder_ray(const CylinderMap& map, glm::dvec2 st, double zoom) {
  if (!(std::abs(st.x / zoom * map.half_h) <= std::numbers::pi)) return std::nullopt;
  return cylinder_beyond(map, st, zoom);
}

// [Trapp & Döllner, sec. 3], turned so that s = 0 is -z and s rises to the right.
std::optional<glm::dvec3> cylinder_beyond(const CylinderMap& map, glm::dvec2 st, double zoom) {
  const double azimuth = st.x / zoom * map.half_h;
  return glm::dvec3(std::sin(azimuth), st.y / zoom * map.tan_half_v, -std::cos(azimuth));
}

std::optional<glm::dvec2> cylinder_point(const CylinderMap& map, const glm::dvec3& eye,
                                         const glm::dvec3& direction, double zoom) {
  // |eye + reach · direction| = 1 in the horizontal plane; the eye is inside, so one root is ahead of it.
  const double a = direction.x * direction.x + direction.z * direction.z;
  const double b = eye.x * direction.x + eye.z * direction.z;
  const double inside = 1.0 - eye.x * eye.x - eye.z * eye.z;
  if (!(a > 0.0) || !(inside > 0.0)) return std::nullopt;
  const double root = std::sqrt(b * b + a * inside);
  const double reach = b > 0.0 ? inside / (root + b) : (root - b) / a;
  const double azimuth = std::atan2(eye.x + reach * direction.x, -(eye.z + reach * direction.z));
  return glm::dvec2(azimuth * zoom / map.half_h, (eye.y + reach * direction.y) * zoom / map.tan_half_v);
}

double cylinder_density(const CylinderMap& map, glm::dvec2 size_px) {
  return std::max(0.5 * size_px.x / map.half_h, 0.5 * size_px.y / map.tan_half_v);
}

} // namespace cupola::projection
