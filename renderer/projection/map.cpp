#include "renderer/projection/map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <type_traits>

namespace cupola::projection {

namespace {

template <class... F>
struct Overload : F... {
  using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;

ShapeMap make_shape(const model::Shape& shape, double aspect) {
  const glm::dvec2 circle(std::max(aspect, 1.0), std::max(1.0 / aspect, 1.0)); // in the shorter side
  return std::visit(
      Overload{[&](const model::Perspective& p) -> ShapeMap {
                 const double across = std::tan(p.horizontal_fov.radians() / 2);
                 return PerspectiveMap{across, p.vertical_fov ? std::tan(p.vertical_fov->radians() / 2)
                                                              : across / aspect};
               },
               [](const model::Cylinder& c) -> ShapeMap {
                 return CylinderMap{c.horizontal_fov.radians() / 2, std::tan(c.vertical_fov.radians() / 2)};
               },
               [&](const model::Fisheye& f) -> ShapeMap {
                 return FisheyeMap{f.fov.radians() / 2, circle.x, circle.y};
               },
               [](const model::Equirectangular& e) -> ShapeMap {
                 return EquirectangularMap{e.horizontal_fov.radians() / 2, e.vertical_fov.radians() / 2};
               },
               [&](const model::Stereographic& f) -> ShapeMap {
                 return StereographicMap{std::tan(f.fov.radians() / 4), circle.x, circle.y};
               },
               [&](const model::Orthographic& f) -> ShapeMap {
                 return OrthographicMap{std::sin(f.fov.radians() / 2), circle.x, circle.y};
               },
               [](const model::Mercator& m) -> ShapeMap {
                 return MercatorMap{m.horizontal_fov.radians() / 2,
                                    std::asinh(std::tan(m.vertical_fov.radians() / 2))};
               },
               [&](const model::Panini& p) -> ShapeMap {
                 const double across = panini_x(p.horizontal_fov.radians() / 2, p.distance);
                 return PaniniMap{across,
                                  p.vertical_fov ? std::tan(p.vertical_fov->radians() / 2) : across / aspect,
                                  p.distance};
               },
               [](const model::CubeCross&) -> ShapeMap { return CubeCrossMap{}; },
               [&](const model::CameraTexture& texture) -> ShapeMap {
                 return make_camera_texture(texture, aspect);
               }},
      shape);
}

/// Sine and cosine of an angle in degrees; exact at quarter turns.
glm::dvec2 sine_cosine(const model::Angle& angle) {
  const double turned = std::fmod(angle.degrees, 360.0);
  const double quarters = std::round(turned / 90.0);
  const double rest = model::Angle{turned - 90.0 * quarters}.radians();
  const double s = std::sin(rest), c = std::cos(rest);
  switch (((static_cast<int>(quarters) % 4) + 4) % 4) {
  case 0:
    return {s, c};
  case 1:
    return {c, -s};
  case 2:
    return {-s, -c};
  default:
    return {-c, s};
  }
}

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::optional<glm::dvec3> shape_ray(const Map& map, glm::dvec2 st) {
  return std::visit(
      Overload{[&](const PerspectiveMap& shape) { return perspective_ray(shape, st, map.zoom); },
               [&](const CylinderMap& shape) { return cylinder_ray(shape, st, map.zoom); },
               [&](const FisheyeMap& shape) { return fisheye_ray(shape, st, map.zoom); },
               [&](const EquirectangularMap& shape) { return equirectangular_ray(shape, st, map.zoom); },
               [&](const StereographicMap& shape) { return stereographic_ray(shape, st, map.zoom); },
               [&](const OrthographicMap& shape) { return orthographic_ray(shape, st, map.zoom); },
               [&](const MercatorMap& shape) { return mercator_ray(shape, st, map.zoom); },
               [&](const PaniniMap& shape) { return panini_ray(shape, st, map.zoom); },
               [&](const CubeCrossMap& shape) { return cube_cross_ray(shape, st, map.zoom); },
               [&](const CameraTextureMap& shape) { return camera_texture_ray(shape, st, map.zoom); }},
      map.shape);
}

std::optional<glm::dvec3> shape_beyond(const Map& map, glm::dvec2 st, glm::dvec2 inside) {
  return std::visit(
      Overload{[&](const PerspectiveMap& shape) { return perspective_ray(shape, st, map.zoom); },
               [&](const CylinderMap& shape) { return cylinder_beyond(shape, st, map.zoom); },
               [&](const FisheyeMap& shape) { return fisheye_beyond(shape, st, map.zoom); },
               [&](const EquirectangularMap& shape) { return equirectangular_beyond(shape, st, map.zoom); },
               [&](const StereographicMap& shape) { return stereographic_beyond(shape, st, map.zoom); },
               [&](const OrthographicMap& shape) { return orthographic_beyond(shape, st, map.zoom); },
               [&](const MercatorMap& shape) { return mercator_beyond(shape, st, map.zoom); },
               [&](const PaniniMap& shape) { return panini_ray(shape, st, map.zoom); },
               [&](const CubeCrossMap& shape) { return cube_cross_beyond(shape, st, map.zoom, inside); },
               [&](const CameraTextureMap& shape) { return camera_texture_ray(shape, st, map.zoom); }},
      map.shape);
}

/// From a point of the shape to a direction in view axes.
std::optional<glm::dvec3> seen_from_eye(const Map& map, const std::optional<glm::dvec3>& point) {
  if (!point) return std::nullopt;
  const glm::dvec3 direction = map.orientation * (*point - map.off_axis);
  if (!finite(direction) || direction == glm::dvec3(0.0)) return std::nullopt;
  return direction;
}

std::optional<glm::dvec2> shape_point(const Map& map, const glm::dvec3& direction) {
  const glm::dvec3& eye = map.off_axis;
  return std::visit(
      Overload{
          [&](const PerspectiveMap& shape) { return perspective_point(shape, eye, direction, map.zoom); },
          [&](const CylinderMap& shape) { return cylinder_point(shape, eye, direction, map.zoom); },
          [&](const FisheyeMap& shape) { return fisheye_point(shape, eye, direction, map.zoom); },
          [&](const EquirectangularMap& shape) {
            return equirectangular_point(shape, eye, direction, map.zoom);
          },
          [&](const StereographicMap& shape) { return stereographic_point(shape, eye, direction, map.zoom); },
          [&](const OrthographicMap& shape) { return orthographic_point(shape, eye, direction, map.zoom); },
          [&](const MercatorMap& shape) { return mercator_point(shape, eye, direction, map.zoom); },
          [&](const PaniniMap& shape) { return panini_point(shape, eye, direction, map.zoom); },
          [&](const CubeCrossMap& shape) { return cube_cross_point(shape, eye, direction, map.zoom); },
          [&](const CameraTextureMap& shape) {
            return camera_texture_point(shape, eye, direction, map.zoom);
          }},
      map.shape);
}

/// From the eye to where the shape is farthest, as far as matched_density goes.
double farthest(const Map& map) {
  const glm::dvec3& eye = map.off_axis;
  return std::visit(
      [&](const auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, PerspectiveMap> || std::is_same_v<Shape, PaniniMap> ||
                      std::is_same_v<Shape, CameraTextureMap>)
          return 1.0 + eye.z;
        else if constexpr (std::is_same_v<Shape, CylinderMap>)
          return 1.0 + std::hypot(eye.x, eye.z);
        else if constexpr (std::is_same_v<Shape, CubeCrossMap>)
          return 1.0 + std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)});
        else
          return 1.0 + glm::length(eye);
      },
      map.shape);
}

/// How the unit direction changes over a pixel step along `step`; one-sided at a border of what is shown.
glm::dvec3 slope(const Map& map, glm::dvec2 st, const glm::dvec3& here, glm::dvec2 step) {
  constexpr double share = 1e-3; // of a pixel
  const auto plus = ray(map, st + share * step), minus = ray(map, st - share * step);
  if (!plus && !minus) return glm::dvec3(0.0);
  const glm::dvec3 a = plus ? glm::normalize(*plus) : here, b = minus ? glm::normalize(*minus) : here;
  return (a - b) / (share * ((plus ? 1.0 : 0.0) + (minus ? 1.0 : 0.0)));
}

} // namespace

Map make_map(const model::Projection& projection, double aspect) {
  return {make_shape(projection.shape, aspect), projection.zoom, projection.off_axis,
          rotation(projection.orientation)};
}

glm::dmat3 rotation(const model::Orientation& orientation) {
  const glm::dvec2 y = sine_cosine(orientation.yaw), p = sine_cosine(orientation.pitch),
                   r = sine_cosine(orientation.roll);
  // Columns are the images of x, y, z.
  using glm::dvec3;
  const glm::dmat3 yaw(dvec3(y.y, 0.0, -y.x), dvec3(0.0, 1.0, 0.0), dvec3(y.x, 0.0, y.y));
  const glm::dmat3 pitch(dvec3(1.0, 0.0, 0.0), dvec3(0.0, p.y, p.x), dvec3(0.0, -p.x, p.y));
  const glm::dmat3 roll(dvec3(r.y, -r.x, 0.0), dvec3(r.x, r.y, 0.0), dvec3(0.0, 0.0, 1.0));
  return yaw * pitch * roll;
}

bool inside(const Map& map) {
  const glm::dvec3& eye = map.off_axis;
  return std::visit(Overload{[&](const PerspectiveMap&) { return eye.z > -1.0; },
                             [&](const CameraTextureMap&) { return eye.z > -1.0; },
                             [&](const CylinderMap&) { return eye.x * eye.x + eye.z * eye.z < 1.0; },
                             [&](const PaniniMap& shape) { return panini_inside(shape, eye); },
                             [&](const CubeCrossMap&) {
                               return std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)}) < 1.0;
                             },
                             [&](const auto&) { return glm::dot(eye, eye) < 1.0; }}, // spheres
                    map.shape);
}

std::optional<glm::dvec3> ray(const Map& map, glm::dvec2 st) {
  if (!std::isfinite(st.x) || !std::isfinite(st.y)) return std::nullopt;
  return seen_from_eye(map, shape_ray(map, st));
}

bool folds(const Map& map) {
  const auto* texture = std::get_if<CameraTextureMap>(&map.shape);
  if (!texture) return false;
  const std::uint32_t count = texture->grid->triangle_count();
  for (std::uint32_t i = 0; i < count; ++i)
    if (texture->grid->twice_area(i) < 0.0) return true;
  return false;
}

std::vector<std::uint32_t> covering(const Map& map, glm::dvec2 st) {
  const auto* texture = std::get_if<CameraTextureMap>(&map.shape);
  if (!texture || !std::isfinite(st.x) || !std::isfinite(st.y)) return {};
  return texture->grid->covering(st / map.zoom);
}

std::optional<glm::dvec3> ray_by(const Map& map, std::uint32_t triangle, glm::dvec2 st) {
  const auto* texture = std::get_if<CameraTextureMap>(&map.shape);
  if (!texture || !std::isfinite(st.x) || !std::isfinite(st.y)) return std::nullopt;
  return seen_from_eye(map, camera_texture_ray_by(*texture, triangle, st, map.zoom));
}

std::optional<glm::dvec3> beyond(const Map& map, glm::dvec2 st, glm::dvec2 inside) {
  if (!std::isfinite(st.x) || !std::isfinite(st.y)) return std::nullopt;
  return seen_from_eye(map, shape_beyond(map, st, inside));
}

Breaks breaks(const Map& map) {
  Breaks out;
  if (!std::holds_alternative<CubeCrossMap>(map.shape)) return out;
  for (const double border : {-0.5, 0.0, 0.5})
    if (std::abs(border * map.zoom) < 1.0) out.s.push_back(border * map.zoom);
  for (const double border : {-1.0 / 3.0, 1.0 / 3.0})
    if (std::abs(border * map.zoom) < 1.0) out.t.push_back(border * map.zoom);
  return out;
}

std::optional<glm::dvec2> image_point(const Map& map, const glm::dvec3& direction) {
  const double longest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!finite(direction) || !(longest > 0.0)) return std::nullopt;
  const auto st = shape_point(map, glm::transpose(map.orientation) * (direction / longest));
  if (!st || !std::isfinite(st->x) || !std::isfinite(st->y)) return std::nullopt;
  return st;
}

double pixel_density(const Map& map, glm::dvec2 st, glm::dvec2 size_px) {
  st *= 1.0 - 1e-9; // a hair inwards: beside a point of the rim, along it, nothing is shown
  const auto here = ray(map, st);
  if (!here) return 0.0;
  const glm::dvec3 unit = glm::normalize(*here);
  const glm::dvec3 right = slope(map, st, unit, {2.0 / size_px.x, 0.0});
  const glm::dvec3 up = slope(map, st, unit, {0.0, 2.0 / size_px.y});
  // Singular values of the 3×2 matrix (right, up), radians per pixel.
  const double a = glm::dot(right, right), b = glm::dot(right, up), c = glm::dot(up, up);
  const double largest = std::sqrt(0.5 * (a + c + std::hypot(a - c, 2.0 * b)));
  const double smallest = glm::length(glm::cross(right, up)) / largest;
  return smallest > 0.0 ? 1.0 / smallest : std::numeric_limits<double>::infinity();
}

double matched_density(const Map& map, glm::dvec2 size_px) {
  const double own = std::visit(
      Overload{[&](const PerspectiveMap& shape) { return perspective_density(shape, size_px); },
               [&](const CylinderMap& shape) { return cylinder_density(shape, size_px); },
               [&](const FisheyeMap& shape) { return fisheye_density(shape, size_px); },
               [&](const EquirectangularMap& shape) { return equirectangular_density(shape, size_px); },
               [&](const StereographicMap& shape) { return stereographic_density(shape, size_px); },
               [&](const OrthographicMap& shape) { return orthographic_density(shape, size_px); },
               [&](const MercatorMap& shape) { return mercator_density(shape, size_px); },
               [&](const PaniniMap& shape) { return panini_density(shape, size_px); },
               [&](const CubeCrossMap& shape) { return cube_cross_density(shape, size_px); },
               [&](const CameraTextureMap& shape) { return camera_texture_density(shape, size_px); }},
      map.shape);
  return own * map.zoom * farthest(map);
}

Map before_bending(const Map& map) {
  const auto* texture = std::get_if<CameraTextureMap>(&map.shape);
  if (!texture) return map;
  return {texture->base, 1.0, map.off_axis, map.orientation};
}

MapUniforms uniforms(const Map& map) {
  MapUniforms out;
  out.shape = static_cast<std::int32_t>(map.shape.index());
  out.parameters = glm::vec4(std::visit(
      Overload{[](const PerspectiveMap& s) { return glm::dvec4(s.tan_half_h, s.tan_half_v, 0.0, 0.0); },
               [](const CylinderMap& s) { return glm::dvec4(s.half_h, s.tan_half_v, 0.0, 0.0); },
               [](const FisheyeMap& s) { return glm::dvec4(s.half_fov, s.scale_s, s.scale_t, 0.0); },
               [](const EquirectangularMap& s) { return glm::dvec4(s.half_h, s.half_v, 0.0, 0.0); },
               [](const StereographicMap& s) { return glm::dvec4(s.tan_quarter, s.scale_s, s.scale_t, 0.0); },
               [](const OrthographicMap& s) { return glm::dvec4(s.sin_half, s.scale_s, s.scale_t, 0.0); },
               [](const MercatorMap& s) { return glm::dvec4(s.half_h, s.half_up, 0.0, 0.0); },
               [](const PaniniMap& s) { return glm::dvec4(s.half_x, s.half_y, s.distance, 0.0); },
               [](const CubeCrossMap&) { return glm::dvec4(0.0); },
               [](const CameraTextureMap& s) {
                 return glm::dvec4(s.base.tan_half_h, s.base.tan_half_v, 0.0, 0.0);
               }},
      map.shape));
  out.zoom = static_cast<float>(map.zoom);
  out.off_axis = glm::vec3(map.off_axis);
  out.orientation = glm::mat3(map.orientation);
  return out;
}

} // namespace cupola::projection
