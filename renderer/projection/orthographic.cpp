#include "renderer/projection/orthographic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/projection/sphere.h"

namespace cupola::projection {

namespace {
constexpr double rim = 1.0 + 1e-12; // a point that was computed to lie on the rim belongs to the circle
} // namespace

std::optional<glm::dvec3> orthographic_ray(const OrthographicMap& map, glm::dvec2 st, double zoom) {
  if (!(std::hypot(st.x * map.scale_s, st.y * map.scale_t) <= rim)) return std::nullopt;
  return orthographic_beyond(map, st, zoom);
}

std::optional<glm::dvec3> orthographic_beyond(const OrthographicMap& map, glm::dvec2 st, double zoom) {
  const double scale = map.sin_half / zoom;
  const glm::dvec2 across(st.x * map.scale_s * scale, st.y * map.scale_t * scale);
  const double sine = glm::length(across);
  if (!(sine <= rim)) return std::nullopt;
  return glm::dvec3(across.x, across.y, -std::sqrt(std::max(0.0, (1.0 - sine) * (1.0 + sine))));
}

std::optional<glm::dvec2> orthographic_point(const OrthographicMap& map, const glm::dvec3& eye,
                                             const glm::dvec3& direction, double zoom) {
  const auto hit = sphere_hit(eye, direction);
  if (!hit || !(hit->z <= 0.0)) return std::nullopt;
  const glm::dvec2 point = glm::dvec2(hit->x, hit->y) * (zoom / map.sin_half);
  if (!(glm::length(point) <= rim)) return std::nullopt;
  return glm::dvec2(point.x / map.scale_s, point.y / map.scale_t);
}

double orthographic_density(const OrthographicMap& map, glm::dvec2 size_px) {
  return std::max(0.5 * size_px.x / map.scale_s, 0.5 * size_px.y / map.scale_t) / map.sin_half;
}

} // namespace cupola::projection
