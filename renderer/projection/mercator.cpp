#include "renderer/projection/mercator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/projection/sphere.h"

namespace cupola::projection {

std::optional<glm::dvec3> mercator_ray(const MercatorMap& map, glm::dvec2 st, double zoom) {
  if (!(std::abs(st.x / zoom * map.half_h) <= std::numbers::pi)) return std::nullopt;
  return mercator_beyond(map, st, zoom);
}

std::optional<glm::dvec3> mercator_beyond(const MercatorMap& map, glm::dvec2 st, double zoom) {
  const double longitude = st.x / zoom * map.half_h, up = st.y / zoom * map.half_up;
  // Cosine and sine of the latitude: 1 / cosh and tanh of the stretched one, without overflow.
  const double small = std::exp(-std::abs(up));
  const double level = 2.0 * small / (1.0 + small * small);
  const double height = (1.0 - small * small) / (1.0 + small * small);
  return glm::dvec3(level * std::sin(longitude), std::copysign(height, up), -level * std::cos(longitude));
}

std::optional<glm::dvec2> mercator_point(const MercatorMap& map, const glm::dvec3& eye,
                                         const glm::dvec3& direction, double zoom) {
  const auto hit = sphere_hit(eye, direction);
  if (!hit) return std::nullopt;
  const double level = std::hypot(hit->x, hit->z);
  if (!(level > 0.0)) return std::nullopt;
  return glm::dvec2(std::atan2(hit->x, -hit->z) * zoom / map.half_h,
                    std::asinh(hit->y / level) * zoom / map.half_up);
}

double mercator_density(const MercatorMap& map, glm::dvec2 size_px) {
  return std::max(0.5 * size_px.x / map.half_h, 0.5 * size_px.y / map.half_up);
}

} // namespace cupola::projection
