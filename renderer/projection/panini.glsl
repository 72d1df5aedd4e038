// twin of panini.cpp. map: half_x, half_y, distance, unused.

// twin of panini.cpp: panini_ray
bool panini_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  float d = map.z, x = st.x / zoom * map.x;
  float k = x * x / ((d + 1.0) * (d + 1.0));
  float square = 1.0 + k * (1.0 - d) * (1.0 + d);
  float root = sqrt(max(0.0, square));
  ray = vec3(x, st.y / zoom * map.y, -(d + 1.0) * (root - k * d) / (d + root));
  return square >= 0.0;
}

// twin of panini.cpp: panini_inside
bool panini_inside(vec4 map, vec3 eye) { return map.z * length(eye.xz) - eye.z < map.z + 1.0; }

// twin of panini.cpp: panini_point
bool panini_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  if (!panini_inside(map, eye)) return false;
  float d = map.z, rest = d + 1.0 + eye.z;
  float a = (1.0 - d) * (1.0 + d) * direction.z * direction.z - d * d * direction.x * direction.x;
  float b = -rest * direction.z + d * d * dot(eye.xz, direction.xz);
  float c = rest * rest - d * d * dot(eye.xz, eye.xz);
  float square = b * b - a * c;
  if (!(square >= 0.0) || (b <= 0.0 && a >= 0.0)) return false;
  float root = sqrt(square);
  float reach = b > 0.0 ? c / (b + root) : (b - root) / a;
  vec3 hit = eye + reach * direction;
  if (!(length(hit.xz) >= d * hit.z)) return false;
  st = hit.xy * zoom / map.xy;
  return true;
}
