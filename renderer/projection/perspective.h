// A flat picture: the plane at distance 1 ahead of the shape's centre.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct PerspectiveMap {
  double tan_half_h, tan_half_v; ///< tangents of half the field of view, above 0
};

/// The point of the plane z = -1 that an image point shows, in the shape's axes.
[[nodiscard]] std::optional<glm::dvec3> perspective_ray(const PerspectiveMap& map, glm::dvec2 st,
                                                        double zoom);

/// Inverse, seen from `eye`: the image point of where the ray from `eye` meets the plane. nullopt when it
/// never does. `direction` and `eye` in the shape's axes.
[[nodiscard]] std::optional<glm::dvec2> perspective_point(const PerspectiveMap& map, const glm::dvec3& eye,
                                                          const glm::dvec3& direction, double zoom);

/// Pixels per radian at the image centre, the greater of both directions, without zoom and off-axis vector.
[[nodiscard]] double perspective_density(const PerspectiveMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
