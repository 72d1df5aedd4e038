// twin of perspective.cpp. map: tan_half_h, tan_half_v, unused, unused.

// twin of perspective.cpp: perspective_ray
bool perspective_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  ray = vec3(st / zoom * map.xy, -1.0);
  return true;
}

// twin of perspective.cpp: perspective_point
bool perspective_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  float ahead = -direction.z, distance = 1.0 + eye.z;
  if (!(ahead > 0.0) || !(distance > 0.0)) return false;
  st = (eye.xy + distance / ahead * direction.xy) * zoom / map.xy;
  return true;
}
