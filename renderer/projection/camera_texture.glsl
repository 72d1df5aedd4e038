// twin of camera_texture.cpp. map: tan_half_h, tan_half_v, unused, unused.
//
// The grid is drawn as a mesh, whose triangles carry their places in the perspective's picture
// (lookup_grid.vert.glsl): an image point here is such a place, and zoom is in where the mesh lands.
#include "renderer/projection/perspective.glsl"

// twin of camera_texture.cpp: camera_texture_ray, of a place
bool camera_texture_ray(vec4 map, vec2 place, out vec3 ray) {
  return perspective_ray(map, place, 1.0, ray);
}

// twin of camera_texture.cpp: camera_texture_point, up to the place
bool camera_texture_point(vec4 map, vec3 eye, vec3 direction, out vec2 place) {
  return perspective_point(map, eye, direction, 1.0, place);
}
