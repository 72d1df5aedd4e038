// Leaves the pixels that the projection does not show: what is drawn here lies before the whole scene.
#include "renderer/projection/map.glsl"

in vec2 v_st;

layout(location = 0) out vec4 out_color; // not written: the colour mask is off

void main() {
  vec3 direction;
  if (map_ray(v_st, direction)) discard;
  out_color = vec4(0.0);
}
