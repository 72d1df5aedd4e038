// Orthographic fisheye: the hemisphere ahead as seen from infinitely far, the sine of the angle from the
// centre growing with the distance from the image centre. At a right angle from the centre it ends: nothing
// is shown beyond, and directions crowd towards it without limit.
//
// Its circle is inscribed as a fisheye's: see fisheye.h.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct OrthographicMap {
  double sin_half; ///< sine of half the field of view, above 0, at most 1
  double scale_s;  ///< image coordinates are multiplied by these; the circle is then the unit circle
  double scale_t;
};

/// The point of the unit sphere that an image point shows, in the shape's axes.
[[nodiscard]] std::optional<glm::dvec3> orthographic_ray(const OrthographicMap& map, glm::dvec2 st,
                                                         double zoom);

/// The same outside the circle too, to a right angle from the centre.
[[nodiscard]] std::optional<glm::dvec3> orthographic_beyond(const OrthographicMap& map, glm::dvec2 st,
                                                            double zoom);

/// Inverse, seen from `eye` inside the sphere. nullopt where the circle does not reach, and for what lies on
/// the hemisphere behind.
[[nodiscard]] std::optional<glm::dvec2> orthographic_point(const OrthographicMap& map, const glm::dvec3& eye,
                                                           const glm::dvec3& direction, double zoom);

/// Pixels per radian at the image centre, the greater of both directions, without zoom and off-axis vector.
[[nodiscard]] double orthographic_density(const OrthographicMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
