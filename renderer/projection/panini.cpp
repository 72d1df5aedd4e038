#include "renderer/projection/panini.h"

#include <algorithm>
#include <cmath>

namespace cupola::projection {

double panini_limit(double distance) { return std::acos(-(distance <= 1.0 ? distance : 1.0 / distance)); }

double panini_x(double azimuth, double distance) {
  return (distance + 1.0) * std::sin(azimuth) / (distance + std::cos(azimuth));
}

std::optional<glm::dvec3> panini_ray(const PaniniMap& map, glm::dvec2 st, double zoom) {
  const double d = map.distance, x = st.x / zoom * map.half_x;
  const double k = x * x / ((d + 1.0) * (d + 1.0));
  const double square = 1.0 + k * (1.0 - d) * (1.0 + d);
  if (!(square >= 0.0)) return std::nullopt;
  const double root = std::sqrt(square);
  return glm::dvec3(x, st.y / zoom * map.half_y, -(d + 1.0) * (root - k * d) / (d + root));
}

// The conic: d r + z' = d + 1 with r the distance from the focus and z' the way ahead.
bool panini_inside(const PaniniMap& map, const glm::dvec3& eye) {
  return map.distance * std::hypot(eye.x, eye.z) - eye.z < map.distance + 1.0;
}

std::optional<glm::dvec2> panini_point(const PaniniMap& map, const glm::dvec3& eye,
                                       const glm::dvec3& direction, double zoom) {
  if (!panini_inside(map, eye)) return std::nullopt;
  const double d = map.distance, rest = d + 1.0 + eye.z;
  // (rest + direction.z t)² = d² |eye + direction t|² in the plan: a t² - 2 b t + c = 0 with c > 0.
  const double a = (1.0 - d) * (1.0 + d) * direction.z * direction.z - d * d * direction.x * direction.x;
  const double b = -rest * direction.z + d * d * (eye.x * direction.x + eye.z * direction.z);
  const double c = rest * rest - d * d * (eye.x * eye.x + eye.z * eye.z);
  const double square = b * b - a * c;
  if (!(square >= 0.0) || (b <= 0.0 && a >= 0.0)) return std::nullopt;
  const double root = std::sqrt(square);
  const double reach = b > 0.0 ? c / (b + root) : (b - root) / a; // the nearer root ahead of the eye
  const double x = eye.x + reach * direction.x, z = eye.z + reach * direction.z;
  if (!(std::hypot(x, z) >= d * z)) return std::nullopt; // beyond the limit the picture runs backwards
  return glm::dvec2(x * zoom / map.half_x, (eye.y + reach * direction.y) * zoom / map.half_y);
}

double panini_density(const PaniniMap& map, glm::dvec2 size_px) {
  const glm::dvec3 half_way = *panini_ray(map, {0.5, 0.0}, 1.0);
  const double d = map.distance, cosine = -half_way.z / std::hypot(half_way.x, half_way.z);
  const double grown = (d + 1.0) * (d * cosine + 1.0) / ((d + cosine) * (d + cosine)); // over the centre
  return std::max(0.5 * size_px.x / map.half_x * grown, 0.5 * size_px.y / map.half_y);
}

} // namespace cupola::projection
