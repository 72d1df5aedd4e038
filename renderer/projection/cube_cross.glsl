// twin of cube_cross.cpp. map: unused.

struct CrossFace {
  vec2 corner; // column and row in the cross, from its top left
  vec3 right, up, out_;
};
const CrossFace cross_faces[6] = CrossFace[6](
  CrossFace(vec2(1, 1), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, -1)),
  CrossFace(vec2(2, 1), vec3(0, 0, 1), vec3(0, 1, 0), vec3(1, 0, 0)),
  CrossFace(vec2(0, 1), vec3(0, 0, -1), vec3(0, 1, 0), vec3(-1, 0, 0)),
  CrossFace(vec2(3, 1), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)),
  CrossFace(vec2(1, 0), vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0)),
  CrossFace(vec2(1, 2), vec3(1, 0, 0), vec3(0, 0, -1), vec3(0, -1, 0)));

// twin of cube_cross.cpp: cube_cross_ray
bool cube_cross_ray(vec4 map, vec2 st, float zoom, out vec3 ray) {
  vec2 at = vec2(st.x / zoom + 1.0, 1.0 - st.y / zoom) * vec2(2.0, 1.5);
  ray = vec3(0.0, 0.0, -1.0);
  for (int i = 0; i < 6; ++i) {
    vec2 rest = at - cross_faces[i].corner;
    if (any(lessThan(rest, vec2(0.0))) || any(greaterThan(rest, vec2(1.0)))) continue;
    ray = cross_faces[i].out_ + (2.0 * rest.x - 1.0) * cross_faces[i].right +
          (1.0 - 2.0 * rest.y) * cross_faces[i].up;
    return true;
  }
  return false;
}

// twin of cube_cross.cpp: cube_cross_point
bool cube_cross_point(vec4 map, vec3 eye, vec3 direction, float zoom, out vec2 st) {
  st = vec2(0.0);
  int face = -1;
  float reach = 3.0e38;
  for (int i = 0; i < 6; ++i) {
    float ahead = dot(cross_faces[i].out_, direction), distance = 1.0 - dot(cross_faces[i].out_, eye);
    if (!(distance > 0.0)) return false;
    if (!(ahead > 0.0) || !(distance < reach * ahead)) continue;
    reach = distance / ahead;
    face = i;
  }
  if (face < 0) return false;
  vec3 hit = eye + reach * direction;
  vec2 at = cross_faces[face].corner +
            0.5 * vec2(1.0 + dot(cross_faces[face].right, hit), 1.0 - dot(cross_faces[face].up, hit));
  st = vec2(at.x / 2.0 - 1.0, 1.0 - at.y / 1.5) * zoom;
  return true;
}
