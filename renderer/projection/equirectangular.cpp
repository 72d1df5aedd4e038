#include "renderer/projection/equirectangular.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/projection/sphere.h"

namespace cupola::projection {

std::optional<glm::dvec3> equirectangular_ray(const EquirectangularMap& map, glm::dvec2 st, double zoom) {
  if (!(std::abs(st.x / zoom * map.half_h) <= std::numbers::pi)) return std::nullopt;
  return equirectangular_beyond(map, st, zoom);
}

std::optional<glm::dvec3> equirectangular_beyond(const EquirectangularMap& map, glm::dvec2 st, double zoom) {
  const double longitude = st.x / zoom * map.half_h, latitude = st.y / zoom * map.half_v;
  if (!(std::abs(latitude) <= std::numbers::pi / 2)) return std::nullopt;
  const double level = std::cos(latitude);
  return glm::dvec3(level * std::sin(longitude), std::sin(latitude), -level * std::cos(longitude));
}

std::optional<glm::dvec2> equirectangular_point(const EquirectangularMap& map, const glm::dvec3& eye,
                                                const glm::dvec3& direction, double zoom) {
  const auto hit = sphere_hit(eye, direction);
  if (!hit) return std::nullopt;
  const double level = std::hypot(hit->x, hit->z);
  const double longitude = level > 0.0 ? std::atan2(hit->x, -hit->z) : 0.0;
  return glm::dvec2(longitude * zoom / map.half_h, std::atan2(hit->y, level) * zoom / map.half_v);
}

double equirectangular_density(const EquirectangularMap& map, glm::dvec2 size_px) {
  return std::max(0.5 * size_px.x / map.half_h, 0.5 * size_px.y / map.half_v);
}

} // namespace cupola::projection
