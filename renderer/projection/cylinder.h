// A horizontal cylinder of radius 1 about the shape's y axis: equal angles across, perspective along the axis
// [Trapp & Döllner, sec. 3; Lorenz & Döllner, sec. 3.1].
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct CylinderMap {
  double half_h;     ///< radians, above 0, at most π
  double tan_half_v; ///< of the vertical half angle, above 0
};

/// The point of the cylinder that an image point shows, in the shape's axes: its horizontal length is 1.
/// nullopt beyond half a turn to either side.
[[nodiscard]] std::optional<glm::dvec3> cylinder_ray(const CylinderMap& map, glm::dvec2 st, double zoom);

/// The same without an end: beyond half a turn the wall comes again.
[[nodiscard]] std::optional<glm::dvec3> cylinder_beyond(const CylinderMap& map, glm::dvec2 st, double zoom);

/// Inverse, seen from `eye` inside the cylinder: the image point of where the ray from `eye` meets it.
/// nullopt along the axis. Directly behind, one of the two image points.
[[nodiscard]] std::optional<glm::dvec2> cylinder_point(const CylinderMap& map, const glm::dvec3& eye,
                                                       const glm::dvec3& direction, double zoom);

/// Pixels per radian along the horizon and upwards from it, the greater, without zoom and off-axis vector.
[[nodiscard]] double cylinder_density(const CylinderMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
