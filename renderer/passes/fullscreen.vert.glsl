// One triangle over the whole viewport; no buffers.

out vec2 v_st; // [-1,1], t upwards

void main() {
  v_st = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(v_st, 0.0, 1.0);
}
