// twin of sphere.cpp

// twin of sphere.cpp: sphere_hit
bool sphere_hit(vec3 eye, vec3 direction, out vec3 hit) {
  hit = vec3(0.0);
  float a = dot(direction, direction);
  float b = dot(eye, direction);
  float inside = 1.0 - dot(eye, eye);
  if (!(a > 0.0) || !(inside > 0.0)) return false;
  float root = sqrt(b * b + a * inside);
  float reach = b > 0.0 ? inside / (root + b) : (root - b) / a;
  hit = eye + reach * direction;
  return true;
}
