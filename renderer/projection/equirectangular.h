// Longitude across, latitude upwards, both in equal steps, on the unit sphere about the shape's centre.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct EquirectangularMap {
  double half_h, half_v; ///< radians, above 0, at most π and π/2
};

/// The point of the unit sphere that an image point shows, in the shape's axes. nullopt beyond half a turn to
/// either side and beyond the poles.
[[nodiscard]] std::optional<glm::dvec3> equirectangular_ray(const EquirectangularMap& map, glm::dvec2 st,
                                                            double zoom);

/// The same for longitudes without an end, to the poles.
[[nodiscard]] std::optional<glm::dvec3> equirectangular_beyond(const EquirectangularMap& map, glm::dvec2 st,
                                                               double zoom);

/// Inverse, seen from `eye` inside the sphere. Of a pole, and directly behind, one of the image points that
/// show it.
[[nodiscard]] std::optional<glm::dvec2> equirectangular_point(const EquirectangularMap& map,
                                                              const glm::dvec3& eye,
                                                              const glm::dvec3& direction, double zoom);

/// Pixels per radian along the equator or a meridian, the greater, without zoom and off-axis vector.
[[nodiscard]] double equirectangular_density(const EquirectangularMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
