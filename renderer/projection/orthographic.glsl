// twin of orthographic.cpp. map: sin_half, scale_s, scale_t, unused.
#include "renderer/projection/sphere.glsl"

// twin of orthographic.cpp: orthographic_ray
bool orthographic_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  vec2 p = st * map.yz;
  vec2 across = p * (map.x / zoom);
  float sine = length(across);
  ray = vec3(across, -sqrt(max(0.0, (1.0 - sine) * (1.0 + sine))));
  return length(p) <= 1.0 && sine <= 1.0;
}

// twin of orthographic.cpp: orthographic_point
bool orthographic_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  vec3 hit;
  if (!sphere_hit(eye, direction, hit) || !(hit.z <= 0.0)) return false;
  vec2 p = hit.xy * (zoom / map.x);
  if (!(length(p) <= 1.0)) return false;
  st = p / map.yz;
  return true;
}
