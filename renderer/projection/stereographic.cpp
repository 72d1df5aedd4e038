#include "renderer/projection/stereographic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/projection/sphere.h"

namespace cupola::projection {

namespace {
constexpr double rim = 1.0 + 1e-12; // a point that was computed to lie on the rim belongs to the circle
} // namespace

std::optional<glm::dvec3> stereographic_ray(const StereographicMap& map, glm::dvec2 st, double zoom) {
  if (!(std::hypot(st.x * map.scale_s, st.y * map.scale_t) <= rim)) return std::nullopt;
  return stereographic_beyond(map, st, zoom);
}

std::optional<glm::dvec3> stereographic_beyond(const StereographicMap& map, glm::dvec2 st, double zoom) {
  const double scale = map.tan_quarter / zoom;
  const glm::dvec2 tangent(st.x * map.scale_s * scale, st.y * map.scale_t * scale);
  const double square = glm::dot(tangent, tangent);
  return glm::dvec3(2.0 * tangent.x, 2.0 * tangent.y, square - 1.0) / (1.0 + square);
}

std::optional<glm::dvec2> stereographic_point(const StereographicMap& map, const glm::dvec3& eye,
                                              const glm::dvec3& direction, double zoom) {
  const auto hit = sphere_hit(eye, direction);
  if (!hit) return std::nullopt;
  const glm::dvec2 across(hit->x, hit->y);
  // 1 / (1 - z), without cancellation behind.
  const double scale = hit->z > 0.0 ? (1.0 + hit->z) / glm::dot(across, across) : 1.0 / (1.0 - hit->z);
  const glm::dvec2 point = across * (scale * zoom / map.tan_quarter);
  if (!(glm::length(point) <= rim)) return std::nullopt;
  return glm::dvec2(point.x / map.scale_s, point.y / map.scale_t);
}

double stereographic_density(const StereographicMap& map, glm::dvec2 size_px) {
  const double grown = 1.0 + 0.25 * map.tan_quarter * map.tan_quarter; // over the centre
  return grown * std::max(0.25 * size_px.x / map.scale_s, 0.25 * size_px.y / map.scale_t) / map.tan_quarter;
}

} // namespace cupola::projection
