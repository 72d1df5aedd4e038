// A projection as mathematics: the map from image coordinates to directions, and back. Pure functions,
// double precision, radians, no GL. Each shape has a file of its own and a GLSL twin beside it.
//
// Image coordinates (s,t) run over [-1,1]², s to the right, t upwards. Directions are in view space: x right,
// y up, -z ahead. A ray is a direction, not normalised: its length is 1/ω, with ω the weight of the
// piecewise method, such that what is a perspective stays one. A perspective's rays have -z = 1 (ω = -z of
// the unit direction), a cylinder's horizontal length 1 (ω = the unit direction's), a sphere's length 1
// (ω = 1), before off_axis. Where a shape is no sphere its file says what its rays end on.
//
// [Trapp & Döllner 2008, sec. 3]: V = C · (δ(F·s) − O), with C the orientation and O the off-axis vector,
// here in the shape's own axes so that it turns with the picture. The paper's s scales the image coordinates;
// here zoom = 1/s, a magnification.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "configs/model/show.h"
#include "renderer/projection/camera_texture.h"
#include "renderer/projection/cube_cross.h"
#include "renderer/projection/cylinder.h"
#include "renderer/projection/equirectangular.h"
#include "renderer/projection/fisheye.h"
#include "renderer/projection/mercator.h"
#include "renderer/projection/orthographic.h"
#include "renderer/projection/panini.h"
#include "renderer/projection/perspective.h"
#include "renderer/projection/stereographic.h"

namespace cupola::projection {

using ShapeMap = std::variant<PerspectiveMap, CylinderMap, FisheyeMap, EquirectangularMap, StereographicMap,
                              OrthographicMap, MercatorMap, PaniniMap, CubeCrossMap, CameraTextureMap>;

/// The place of a shape in ShapeMap: its number in the shaders.
template <class Shape, class... Shapes>
constexpr std::size_t index_in(const std::variant<Shapes...>*) {
  std::size_t index = 0;
  static_cast<void>(((std::is_same_v<Shape, Shapes> || (++index, false)) || ...));
  return index;
}
template <class Shape>
inline constexpr std::size_t index_of = index_in<Shape>(static_cast<const ShapeMap*>(nullptr));

struct Map {
  ShapeMap shape;
  double zoom = 1.0;           ///< above 0
  glm::dvec3 off_axis{0.0};    ///< in the shape's own axes; the eye, which must lie inside(): see there
  glm::dmat3 orientation{1.0}; ///< the shape's axes to view axes
};

/// `aspect`: width over height of the viewport in pixels.
[[nodiscard]] Map make_map(const model::Projection& projection, double aspect);

/// Rotation from turned axes to the axes they are turned against: yaw, then pitch, then roll.
[[nodiscard]] glm::dmat3 rotation(const model::Orientation& orientation);

/// Whether the off-axis vector leaves the eye inside the shape: before the plane, inside the cylinder or
/// sphere of radius 1, the cube, before the conic. Outside, image points lose their one-to-one relation to
/// directions.
[[nodiscard]] bool inside(const Map& map);

/// nullopt where the image point shows nothing (outside the fisheye's circle, beyond a full turn, beside a
/// cross), and for NaN.
[[nodiscard]] std::optional<glm::dvec3> ray(const Map& map, glm::dvec2 st);

/// Where the grid of a camera texture folds, an image point shows several directions, one by each triangle
/// that covers it, and what is nearest along them is seen: a distance is counted in lengths of its own ray.
[[nodiscard]] bool folds(const Map& map);
/// Those triangles, in rising order. Empty for other shapes, and where nothing is shown.
[[nodiscard]] std::vector<std::uint32_t> covering(const Map& map, glm::dvec2 st);
/// ray() by one of the triangles, continued beyond its borders. Precondition: covering() names it somewhere.
[[nodiscard]] std::optional<glm::dvec3> ray_by(const Map& map, std::uint32_t triangle, glm::dvec2 st);

/// ray() continued beyond the limits of what is shown, for corners of pieces that hang over them: as far as
/// it is smooth and one-to-one about the point. Outside a fisheye's circle to half a turn from its axis, past
/// the half turn of a cylinder or of longitudes (directions then come again); not over a pole, nor over the
/// right angle where an orthographic fisheye ends; a camera texture ends with its grid. Wherever ray() has a
/// direction this is the same. Where the map has breaks() it is the continuation of the face that `inside`
/// lies on, an image point that shows something, over all others; elsewhere `inside` does not matter.
[[nodiscard]] std::optional<glm::dvec3> beyond(const Map& map, glm::dvec2 st, glm::dvec2 inside);

/// Values of s and of t within (-1,1), rising, across which the map is not smooth: faces that meet there.
struct Breaks {
  std::vector<double> s, t;
};
[[nodiscard]] Breaks breaks(const Map& map);

/// The image point that shows a direction; it may lie outside [-1,1]². nullopt where no image point does:
/// then ray() has no such direction. Where several do (a pole, the seam behind a full turn), one of them.
[[nodiscard]] std::optional<glm::dvec2> image_point(const Map& map, const glm::dvec3& direction);

/// Pixels per radian at an image point, in the direction in which they are densest; 0 where nothing is shown,
/// infinite at a pole of an equirectangular picture.
[[nodiscard]] double pixel_density(const Map& map, glm::dvec2 st, glm::dvec2 size_px);

/// Pixels per radian along the lines on which the shape counts its angles in equal steps: along the horizon
/// of a cylinder, a radius of a fisheye, the equator of an equirectangular picture or of Mercator's. Where it
/// has none: at the centre of a perspective, also of one that is bent, an orthographic fisheye and a face of
/// a cross, half way to the edge of a stereographic fisheye and of Panini's picture, which grow outwards. The
/// greater of both directions, and where the wall is farthest from an eye off its centre. This is the density
/// that a cubemap is matched to: elsewhere (towards a pole, a rim, a tall picture's top) pixels crowd without
/// limit, and hold no more detail for it.
[[nodiscard]] double matched_density(const Map& map, glm::dvec2 size_px);

/// The perspective whose picture a camera texture bends, whole and without zoom: all that it may show. Any
/// other map as it is.
[[nodiscard]] Map before_bending(const Map& map);

/// A map as uniforms of map.glsl, which fixes their locations.
struct MapUniforms {
  static constexpr int location_shape = 16, location_parameters = 17, location_zoom = 18,
                       location_off_axis = 19, location_orientation = 20;
  std::int32_t shape = 0; ///< index in ShapeMap
  glm::vec4 parameters{0.0f};
  float zoom = 1.0f;
  glm::vec3 off_axis{0.0f};
  glm::mat3 orientation{1.0f}; ///< column by column, as GL reads it
};
[[nodiscard]] MapUniforms uniforms(const Map& map);

} // namespace cupola::projection
