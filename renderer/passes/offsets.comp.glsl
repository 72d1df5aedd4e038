// Counts of clusters become offsets (exclusive prefix sum), and every run gets its two draw commands: over the
// pairs of the list, or, when the list is too short, over all triangles times all pieces.
#include "renderer/passes/replication.glsl"

layout(local_size_x = 256) in;

layout(std430, binding = 7) buffer Offsets { uint offsets[]; };
layout(std430, binding = 8) readonly buffer Runs { GpuRun runs[]; };
layout(std430, binding = 9) writeonly buffer Commands { DrawCommand commands[]; };
layout(location = 0) uniform uint pair_capacity;
layout(location = 1) uniform uint piece_count;

shared uint sums[256];
shared uint carry;

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint count = uint(clusters.length());
  if (lane == 0u) carry = 0u;
  barrier();
  for (uint start = 0u; start < count; start += 256u) {
    uint own = start + lane < count ? offsets[start + lane] : 0u;
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
      uint value = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += value;
      barrier();
    }
    if (start + lane < count) offsets[start + lane] = carry + sums[lane] - own;
    barrier();
    if (lane == 0u) carry += sums[255];
    barrier();
  }
  if (lane == 0u) {
    control.total = carry;
    control.overflowed = carry > pair_capacity ? 1u : 0u;
  }
  memoryBarrierBuffer();
  barrier();
  bool over = carry > pair_capacity;
  for (uint run = lane; run < uint(runs.length()); run += 256u) {
    uvec4 range = runs[run].range;
    uint from = offsets[range.x];
    uint to = range.x + range.y < count ? offsets[range.x + range.y] : carry;
    commands[run * 2u] = DrawCommand(over ? 0u : 3u * (to - from), 1u, 3u * from, 0u);
    commands[run * 2u + 1u] = DrawCommand(over ? 3u * range.w : 0u, piece_count, 3u * range.z, 0u);
  }
}
