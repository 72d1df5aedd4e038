// The image-based method: the direction of each pixel, looked up in the cubemap [Trapp & Döllner, sec. 5.3].
#include "renderer/projection/map.glsl"

in vec2 v_st;

layout(binding = 0) uniform samplerCube cubemap; // view axes

#ifdef CUPOLA_BY_DEPTH
// The picture folds: of the places that land on a pixel the nearest is seen, by its distance in lengths of
// its own ray, as with pieces.
layout(binding = 1) uniform samplerCube cubemap_depth; // near / distance along the face's axis
#endif

layout(location = 0) out vec4 out_color;

void main() {
  vec3 direction;
  if (!map_ray(v_st, direction)) discard;
  out_color = vec4(texture(cubemap, direction).rgb, 1.0);
#ifdef CUPOLA_BY_DEPTH
  const float in_range = 1.0 / 1024.0; // of rays up to that long the order is kept
  vec3 along = abs(direction);
  gl_FragDepth = texture(cubemap_depth, direction).r * max(along.x, max(along.y, along.z)) * in_range;
#endif
}
