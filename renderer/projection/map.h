// A projection as mathematics: the map from image coordinates to directions, and back. Pure functions,
// double precision, radians, no GL. Each shape has a file of its own and a GLSL twin beside it.
//
// Image coordinates (s,t) run over [-1,1]², s to the right, t upwards. Directions are in view space: x right,
// y up, -z ahead. A ray is a direction, not normalised: its length carries the weight of the piecewise method
// (a perspective's rays have -z = 1, a cylinder's have horizontal length 1, before off_axis).
//
// [Trapp & Döllner 2008, sec. 3]: V = C · δ(F·s) − O, with C the orientation and O the off-axis vector. The
// paper's s scales the image coordinates; here zoom = 1/s, a magnification.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <variant>

#include "configs/model/show.h"

namespace cupola::projection {

struct PerspectiveMap {
  double tan_half_h, tan_half_v;
};
struct CylinderMap {
  double half_h;     ///< radians, at most π
  double tan_half_v; ///< of the vertical half angle
};
struct FisheyeMap {
  double half_fov; ///< radians, at most π
  double scale_s;  ///< image coordinates are multiplied by these; the circle is then the unit circle
  double scale_t;
};
struct EquirectangularMap {
  double half_h, half_v; ///< radians, at most π and π/2
};

struct Map {
  std::variant<PerspectiveMap, CylinderMap, FisheyeMap, EquirectangularMap> shape;
  double zoom = 1.0;
  glm::dvec3 off_axis{0.0};    ///< in the shape's own axes, |O| < 1
  glm::dmat3 orientation{1.0}; ///< the shape's axes to view axes
};

/// `aspect`: width over height of the viewport in pixels.
[[nodiscard]] Map make_map(const model::Projection& projection, double aspect);

/// Rotation from turned axes to the axes they are turned against: yaw, then pitch, then roll.
[[nodiscard]] glm::dmat3 rotation(const model::Orientation& orientation);

/// nullopt where the image point shows nothing (outside the fisheye's circle, beyond a full turn).
[[nodiscard]] std::optional<glm::dvec3> ray(const Map& map, glm::dvec2 st);

/// The image point that shows a direction; it may lie outside [-1,1]². nullopt where no image point does.
[[nodiscard]] std::optional<glm::dvec2> image_point(const Map& map, const glm::dvec3& direction);

/// Pixels per radian at an image point, in the direction in which they are densest; 0 where nothing is shown.
[[nodiscard]] double pixel_density(const Map& map, glm::dvec2 st, glm::dvec2 size_px);

} // namespace cupola::projection
