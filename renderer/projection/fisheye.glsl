// twin of fisheye.cpp. map: half_fov, scale_s, scale_t, unused.
#include "renderer/projection/sphere.glsl"

// twin of fisheye.cpp: fisheye_ray
bool fisheye_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  vec2 p = st * map.yz;
  float radius = length(p);
  float angle = radius / zoom * map.x;
  float across = radius > 0.0 ? sin(angle) / radius : 0.0;
  ray = vec3(p * across, -cos(angle));
  return radius <= 1.0 && angle <= 3.14159274;
}

// twin of fisheye.cpp: fisheye_point
bool fisheye_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  vec3 hit;
  if (!sphere_hit(eye, direction, hit)) return false;
  float across = length(hit.xy);
  float radius = atan(across, -hit.z) * zoom / map.x;
  if (!(radius <= 1.0)) return false;
  st = (across > 0.0 ? radius * hit.xy / across : vec2(radius, 0.0)) / map.yz;
  return true;
}
