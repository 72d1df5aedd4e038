// The grid of a camera texture as a mesh: each vertex where it lands, carrying where it stood in the flat
// picture. Twin of GridVertex in lookup_pass.cpp. w is 1, so places are interpolated as the grid has it:
// linear in each triangle.

layout(location = 0) in vec2 landing;
layout(location = 1) in vec2 place;

layout(location = 18) uniform float map_zoom; // as in map.glsl

out vec2 v_st; // of the flat picture

void main() {
  v_st = place;
  gl_Position = vec4(landing * map_zoom, 0.0, 1.0);
}
