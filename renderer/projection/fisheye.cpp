#include "renderer/projection/fisheye.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/projection/sphere.h"

namespace cupola::projection {

namespace {
constexpr double rim = 1.0 + 1e-12; // a point that was computed to lie on the rim belongs to the circle
} // namespace

std::optional<glm::dvec3> fisheye_ray(const FisheyeMap& map, glm::dvec2 st, double zoom) {
  const double x = st.x * map.scale_s, y = st.y * map.scale_t;
  if (!(x * x + y * y <= rim)) return std::nullopt;
  return fisheye_beyond(map, st, zoom);
}

std::optional<glm::dvec3> fisheye_beyond(const FisheyeMap& map, glm::dvec2 st, double zoom) {
  const double x = st.x * map.scale_s, y = st.y * map.scale_t;
  const double radius = std::sqrt(x * x + y * y);
  const double angle = radius / zoom * map.half_fov;
  if (!(angle <= std::numbers::pi * rim)) return std::nullopt;
  if (radius == 0.0) return glm::dvec3(0.0, 0.0, -1.0);
  const double across = std::sin(angle) / radius;
  return glm::dvec3(x * across, y * across, -std::cos(angle));
}

std::optional<glm::dvec2> fisheye_point(const FisheyeMap& map, const glm::dvec3& eye,
                                        const glm::dvec3& direction, double zoom) {
  const auto hit = sphere_hit(eye, direction);
  if (!hit) return std::nullopt;
  const double across = std::hypot(hit->x, hit->y);
  const double radius = std::atan2(across, -hit->z) * zoom / map.half_fov;
  if (!(radius <= rim)) return std::nullopt;
  if (across == 0.0) return glm::dvec2(radius / map.scale_s, 0.0); // ahead: the centre
  return glm::dvec2(radius * hit->x / across / map.scale_s, radius * hit->y / across / map.scale_t);
}

double fisheye_density(const FisheyeMap& map, glm::dvec2 size_px) {
  return std::max(0.5 * size_px.x / map.scale_s, 0.5 * size_px.y / map.scale_t) / map.half_fov;
}

} // namespace cupola::projection
