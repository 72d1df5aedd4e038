// Triangles of the viewport's own area, all at one depth.

layout(location = 0) in vec2 in_st;
layout(location = 0) uniform float depth; // 1 nearest, 0 farthest

out vec2 v_st; // [-1,1], t upwards

void main() {
  v_st = in_st;
  gl_Position = vec4(in_st, depth, 1.0);
}
