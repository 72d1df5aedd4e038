// twin of mercator.cpp. map: half_h, half_up, unused, unused.
#include "renderer/projection/sphere.glsl"

// twin of mercator.cpp: mercator_ray
bool mercator_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  float longitude = st.x / zoom * map.x, up = st.y / zoom * map.y;
  float small = exp(-abs(up));
  float level = 2.0 * small / (1.0 + small * small);
  float height = (1.0 - small * small) / (1.0 + small * small);
  ray = vec3(level * sin(longitude), up < 0.0 ? -height : height, -level * cos(longitude));
  return abs(longitude) <= 3.14159274;
}

// twin of mercator.cpp: mercator_point
bool mercator_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  vec3 hit;
  if (!sphere_hit(eye, direction, hit)) return false;
  float level = length(hit.xz);
  if (!(level > 0.0)) return false;
  float slope = abs(hit.y) / level;
  float up = log(slope + sqrt(slope * slope + 1.0)); // asinh, which some drivers compute badly
  st = vec2(atan(hit.x, -hit.z) * zoom / map.x, (hit.y < 0.0 ? -up : up) * zoom / map.y);
  return true;
}
