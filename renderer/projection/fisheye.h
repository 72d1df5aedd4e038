// Equidistant fisheye: the angle from the centre's direction grows with the distance from the image centre
// [Trapp & Döllner, sec. 3: the spherical projection].
//
// The circle is inscribed in the shorter side of the viewport whatever the zoom: outside it nothing is shown.
// zoom magnifies what is inside: at the rim the angle is half_fov / zoom. Angles beyond half a turn show
// nothing.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct FisheyeMap {
  double half_fov; ///< radians, above 0, at most π
  double scale_s;  ///< image coordinates are multiplied by these; the circle is then the unit circle
  double scale_t;
};

/// The point of the unit sphere that an image point shows, in the shape's axes.
[[nodiscard]] std::optional<glm::dvec3> fisheye_ray(const FisheyeMap& map, glm::dvec2 st, double zoom);

/// The same outside the circle too, to half a turn from the centre.
[[nodiscard]] std::optional<glm::dvec3> fisheye_beyond(const FisheyeMap& map, glm::dvec2 st, double zoom);

/// Inverse, seen from `eye` inside the sphere. nullopt where the circle does not reach. Directly behind, one
/// of the image points that show it.
[[nodiscard]] std::optional<glm::dvec2> fisheye_point(const FisheyeMap& map, const glm::dvec3& eye,
                                                      const glm::dvec3& direction, double zoom);

/// Pixels per radian along a radius, the greater of both directions, without zoom and off-axis vector.
[[nodiscard]] double fisheye_density(const FisheyeMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
