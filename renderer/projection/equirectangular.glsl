// twin of equirectangular.cpp. map: half_h, half_v, unused, unused.
#include "renderer/projection/sphere.glsl"

// twin of equirectangular.cpp: equirectangular_ray
bool equirectangular_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  float longitude = st.x / zoom * map.x, latitude = st.y / zoom * map.y;
  float level = cos(latitude);
  ray = vec3(level * sin(longitude), sin(latitude), -level * cos(longitude));
  return abs(longitude) <= 3.14159274 && abs(latitude) <= 1.57079637;
}

// twin of equirectangular.cpp: equirectangular_point
bool equirectangular_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  vec3 hit;
  if (!sphere_hit(eye, direction, hit)) return false;
  float level = length(hit.xz);
  float longitude = level > 0.0 ? atan(hit.x, -hit.z) : 0.0;
  st = vec2(longitude * zoom / map.x, atan(hit.y, level) * zoom / map.y);
  return true;
}
