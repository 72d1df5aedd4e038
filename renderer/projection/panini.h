// Panini: a cylinder's wall, seen from the eye in its middle, drawn on a plane ahead as a point `distance`
// radii behind the eye sees that wall [Sharpless, Postle, German: Pannini, a New Projection for Rendering
// Wide Angle Perspective Images; CAe 2010, sec. 4]. Distance 0 is a perspective, 1 the Panini proper;
// verticals stay straight, and so do lines to the centre.
//
// x = S sin φ, y = S tan θ with S = (d + 1) / (d + cos φ), φ the azimuth, θ the height on the wall. Points
// S (sin φ, tan θ, -cos φ) lie on a cylinder over a conic with the eye in its focus: a plane for d = 0, a
// parabola for d = 1. That surface is the shape: rays end on it, so that d = 0 has a perspective's weight.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct PaniniMap {
  double half_x;   ///< x at s = 1, above 0
  double half_y;   ///< y at t = 1, above 0
  double distance; ///< d, at least 0
};

/// Azimuth up to which the picture is one-to-one, radians: beyond, it has no image point, or a second
/// direction.
[[nodiscard]] double panini_limit(double distance);

/// x of an azimuth, radians, below the limit.
[[nodiscard]] double panini_x(double azimuth, double distance);

/// The point of the shape that an image point shows, in its axes. nullopt beyond what the wall can show,
/// where the distance is above 1: there it ends by nature.
[[nodiscard]] std::optional<glm::dvec3> panini_ray(const PaniniMap& map, glm::dvec2 st, double zoom);

/// Whether the eye is on the inner side of the conic.
[[nodiscard]] bool panini_inside(const PaniniMap& map, const glm::dvec3& eye);

/// Inverse, seen from `eye` inside. nullopt where the ray from `eye` never meets the shape, or beyond its
/// limit.
[[nodiscard]] std::optional<glm::dvec2> panini_point(const PaniniMap& map, const glm::dvec3& eye,
                                                     const glm::dvec3& direction, double zoom);

/// Pixels per radian along the horizon, half way from the centre to the edge, and upwards in the centre, the
/// greater, without zoom and off-axis vector.
[[nodiscard]] double panini_density(const PaniniMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
