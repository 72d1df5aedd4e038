// twin of map.cpp. The uniforms hold projection::uniforms(map); their locations are MapUniforms's.
// A program for one shape defines MAP_SHAPE: drivers that compute all branches then compute one.
#include "renderer/projection/perspective.glsl"
#include "renderer/projection/cylinder.glsl"
#include "renderer/projection/fisheye.glsl"
#include "renderer/projection/equirectangular.glsl"
#include "renderer/projection/stereographic.glsl"
#include "renderer/projection/orthographic.glsl"
#include "renderer/projection/mercator.glsl"
#include "renderer/projection/panini.glsl"
#include "renderer/projection/cube_cross.glsl"
#include "renderer/projection/camera_texture.glsl"

#ifdef MAP_SHAPE
const int map_shape = MAP_SHAPE;
#else
layout(location = 16) uniform int map_shape; // order of Map::shape
#endif
layout(location = 17) uniform vec4 map_parameters;
layout(location = 18) uniform float map_zoom;
layout(location = 19) uniform vec3 map_off_axis;
layout(location = 20) uniform mat3 map_orientation; // the shape's axes to view axes

bool shape_ray(vec2 st, out vec3 ray) {
  if (map_shape == 0) return perspective_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 1) return cylinder_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 2) return fisheye_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 3) return equirectangular_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 4) return stereographic_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 5) return orthographic_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 6) return mercator_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 7) return panini_ray(map_parameters, st, map_zoom, ray);
  if (map_shape == 8) return cube_cross_ray(map_parameters, st, map_zoom, ray);
  return camera_texture_ray(map_parameters, st, ray);
}

bool shape_point(vec3 direction, out vec2 st) {
  if (map_shape == 0) return perspective_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 1) return cylinder_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 2) return fisheye_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 3) return equirectangular_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 4) return stereographic_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 5) return orthographic_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 6) return mercator_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 7) return panini_point(map_parameters, map_off_axis, direction, map_zoom, st);
  if (map_shape == 8) return cube_cross_point(map_parameters, map_off_axis, direction, map_zoom, st);
  return camera_texture_point(map_parameters, map_off_axis, direction, st);
}

// twin of map.cpp: ray. False where the image point shows nothing; direction is then (0, 0, -1).
bool map_ray(vec2 st, out vec3 direction) {
  vec3 ray;
  bool shown = shape_ray(st, ray);
  direction = shown ? map_orientation * (ray - map_off_axis) : vec3(0.0, 0.0, -1.0);
  return shown;
}

// twin of map.cpp: image_point. False where no image point shows the direction; st is then the centre.
bool map_point(vec3 direction, out vec2 st) {
  st = vec2(0.0);
  float longest = max(max(abs(direction.x), abs(direction.y)), abs(direction.z));
  if (!(longest > 0.0) || isinf(longest)) return false;
  return shape_point(transpose(map_orientation) * (direction / longest), st);
}
