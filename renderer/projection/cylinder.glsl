// twin of cylinder.cpp. map: half_h, tan_half_v, unused, unused.

// twin of cylinder.cpp: cylinder_ray
bool cylinder_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  float azimuth = st.x / zoom * map.x;
  ray = vec3(sin(azimuth), st.y / zoom * map.y, -cos(azimuth));
  return abs(azimuth) <= 3.14159274;
}

// twin of cylinder.cpp: cylinder_point
bool cylinder_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  float a = dot(direction.xz, direction.xz);
  float b = dot(eye.xz, direction.xz);
  float inside = 1.0 - dot(eye.xz, eye.xz);
  if (!(a > 0.0) || !(inside > 0.0)) return false;
  float root = sqrt(b * b + a * inside);
  float reach = b > 0.0 ? inside / (root + b) : (root - b) / a;
  float azimuth = atan(eye.x + reach * direction.x, -(eye.z + reach * direction.z));
  st = vec2(azimuth * zoom / map.x, (eye.y + reach * direction.y) * zoom / map.y);
  return true;
}
