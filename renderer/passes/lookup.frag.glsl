// The image-based method: the direction of each pixel, looked up in the cubemap [Trapp & Döllner, sec. 5.3].
#include "renderer/projection/map.glsl"

in vec2 v_st;

layout(binding = 0) uniform samplerCube cubemap; // view axes

layout(location = 0) out vec4 out_color;

void main() {
  vec3 direction;
  if (!map_ray(v_st, direction)) discard;
  out_color = vec4(texture(cubemap, direction).rgb, 1.0);
}
