// Reading the GPU engine's list in the vertex program.

#ifdef CUPOLA_REPLICATED
#include "renderer/passes/replication.glsl"

layout(location = 13) uniform bool rest; // what no list holds: items are triangles, instances are pieces
layout(location = 14) uniform float overlap; // 1: pieces reach over their borders; 0: they do not

struct Pair {
  uint triangle, piece;
  bool back;
};

bool seen_from_behind(uint triangle) {
  vec3 a = pull_position(indices[triangle * 3u]) - frame.eye_near.xyz;
  vec3 b = pull_position(indices[triangle * 3u + 1u]) - frame.eye_near.xyz;
  vec3 c = pull_position(indices[triangle * 3u + 2u]) - frame.eye_near.xyz;
  return dot(cross(b - a, c - a), a) >= 0.0;
}

/// Not negative inside the piece; `w` is the point's.
float clip_distance(vec4 plane, vec3 v, float w) { return dot(plane.xyz, v) + overlap * plane.w * w; }

Pair pulled_pair(uint item, uint instance) {
  if (rest) return Pair(item, instance, seen_from_behind(item));
  uvec2 pair = pairs[item];
  return Pair(pair.x, pair.y & ~back_bit, (pair.y & back_bit) != 0u);
}
#endif
