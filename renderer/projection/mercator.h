// Mercator: longitude across in equal steps, latitudes stretched upwards so that the picture is conformal, on
// the unit sphere about the shape's centre. The poles lie infinitely far up and down.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct MercatorMap {
  double half_h;  ///< radians, above 0, at most π
  double half_up; ///< stretched latitude of t = 1: atanh(sin(latitude)), above 0
};

/// The point of the unit sphere that an image point shows, in the shape's axes. nullopt beyond half a turn to
/// either side.
[[nodiscard]] std::optional<glm::dvec3> mercator_ray(const MercatorMap& map, glm::dvec2 st, double zoom);

/// The same for longitudes without an end.
[[nodiscard]] std::optional<glm::dvec3> mercator_beyond(const MercatorMap& map, glm::dvec2 st, double zoom);

/// Inverse, seen from `eye` inside the sphere. nullopt at the poles. Directly behind, one of the two image
/// points.
[[nodiscard]] std::optional<glm::dvec2> mercator_point(const MercatorMap& map, const glm::dvec3& eye,
                                                       const glm::dvec3& direction, double zoom);

/// Pixels per radian along the equator and upwards from it, the greater, without zoom and off-axis vector.
[[nodiscard]] double mercator_density(const MercatorMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
