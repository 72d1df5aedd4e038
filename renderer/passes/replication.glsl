// The GPU engine's buffers [Lorenz & Döllner, sec. 2.1, with compute in place of transform feedback]:
// clusters of triangles are counted, counts become offsets by a prefix sum, (triangle, piece) pairs are
// emitted in order, and one indirect draw per run of a material fetches them. No read-back.

struct GpuCluster {
  vec4 sphere;  // centre (world) and radius; negative radius: cannot be culled
  uvec4 range;  // first triangle, triangles, 1 when double-sided, first of its counts
};
struct GpuPiece {
  mat3 to_screen;
  vec4 planes[3]; // inside where dot(plane.xyz, v) >= 0; w: its overlap, times w; unused ones are zero
};
struct GpuRun {
  uvec4 range;    // first cluster, clusters, first triangle, triangles
};
struct DrawCommand {
  uint count, instances, first, base_instance;
};

const uint back_bit = 1u << 31; // of a pair's piece: the triangle is seen from behind

layout(std430, binding = 2) readonly buffer Clusters { GpuCluster clusters[]; };
layout(std430, binding = 3) readonly buffer Pieces { GpuPiece pieces[]; };
#ifdef CUPOLA_REPLICATED
layout(std430, binding = 4) readonly buffer Pairs { uvec2 pairs[]; };
#else
layout(std430, binding = 4) writeonly buffer Pairs { uvec2 pairs[]; };
layout(std430, binding = 5) buffer Control {
  uint total; // pairs counted
  uint limit; // pairs that all rounds together hold: those of whole clusters
  uint rest;  // first cluster whose pairs they do not hold
} control;
#endif
