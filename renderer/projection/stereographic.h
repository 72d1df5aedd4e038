// Stereographic fisheye: the sphere seen from the point behind on a plane ahead. Conformal: what is small
// keeps its form, growing towards the rim. The tangent of half the angle from the centre grows with the
// distance from the image centre.
//
// Its circle is inscribed as a fisheye's: see fisheye.h.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct StereographicMap {
  double tan_quarter; ///< tangent of a quarter of the field of view, above 0
  double scale_s;     ///< image coordinates are multiplied by these; the circle is then the unit circle
  double scale_t;
};

/// The point of the unit sphere that an image point shows, in the shape's axes.
[[nodiscard]] std::optional<glm::dvec3> stereographic_ray(const StereographicMap& map, glm::dvec2 st,
                                                          double zoom);

/// The same outside the circle too: the plane has no end.
[[nodiscard]] std::optional<glm::dvec3> stereographic_beyond(const StereographicMap& map, glm::dvec2 st,
                                                             double zoom);

/// Inverse, seen from `eye` inside the sphere. nullopt where the circle does not reach.
[[nodiscard]] std::optional<glm::dvec2> stereographic_point(const StereographicMap& map,
                                                            const glm::dvec3& eye,
                                                            const glm::dvec3& direction, double zoom);

/// Pixels per radian half way from the centre to the rim, the greater of both directions, without zoom and
/// off-axis vector.
[[nodiscard]] double stereographic_density(const StereographicMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
