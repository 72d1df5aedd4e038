// twin of stereographic.cpp. map: tan_quarter, scale_s, scale_t, unused.
#include "renderer/projection/sphere.glsl"

// twin of stereographic.cpp: stereographic_ray
bool stereographic_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  vec2 p = st * map.yz;
  vec2 tangent = p * (map.x / zoom);
  float square = dot(tangent, tangent);
  ray = vec3(2.0 * tangent, square - 1.0) / (1.0 + square);
  return length(p) <= 1.0;
}

// twin of stereographic.cpp: stereographic_point
bool stereographic_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  vec3 hit;
  if (!sphere_hit(eye, direction, hit)) return false;
  float scale = hit.z > 0.0 ? (1.0 + hit.z) / dot(hit.xy, hit.xy) : 1.0 / (1.0 - hit.z);
  vec2 p = hit.xy * (scale * zoom / map.x);
  if (!(length(p) <= 1.0)) return false;
  st = p / map.yz;
  return true;
}
