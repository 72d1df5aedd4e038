// Fetching vertices by number instead of by attributes.

#ifdef CUPOLA_PULL

layout(std430, binding = 0) readonly buffer Vertices { float vertex_words[]; }; // 9 words each
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };

struct PulledVertex {
  vec3 position;
  vec3 normal;
  vec2 uv;
  vec4 color;
};

vec3 pull_position(uint index) {
  uint at = index * 9u;
  return vec3(vertex_words[at], vertex_words[at + 1u], vertex_words[at + 2u]);
}

PulledVertex pull_vertex(uint index) {
  uint at = index * 9u;
  PulledVertex v;
  v.position = pull_position(index);
  v.normal = vec3(vertex_words[at + 3u], vertex_words[at + 4u], vertex_words[at + 5u]);
  v.uv = vec2(vertex_words[at + 6u], vertex_words[at + 7u]);
  v.color = unpackUnorm4x8(floatBitsToUint(vertex_words[at + 8u]));
  return v;
}
#endif
