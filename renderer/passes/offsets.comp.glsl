// Counts of clusters become offsets (exclusive prefix sum), and every run gets its draw commands: one for each
// round, over the pairs that the list then holds, and one for the clusters that no round reaches: all of their
// triangles times all pieces.
#include "renderer/passes/replication.glsl"

layout(local_size_x = 256) in;

layout(std430, binding = 7) buffer Offsets { uint offsets[]; };
layout(std430, binding = 8) readonly buffer Runs { GpuRun runs[]; };
layout(std430, binding = 9) writeonly buffer Commands { DrawCommand commands[]; };
layout(location = 0) uniform uint pair_capacity;
layout(location = 1) uniform uint piece_count;
layout(location = 2) uniform uint rounds;
layout(location = 3) uniform uint most_pairs; // of all rounds

shared uint sums[256];
shared uint carry;
shared uint rest; // first cluster that ends beyond the last round

void sum_up(uint lane, uint count) {
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
    uint end = carry + sums[lane];
    if (start + lane < count) {
      offsets[start + lane] = end - own;
      if (end > most_pairs) atomicMin(rest, start + lane);
    }
    barrier();
    if (lane == 0u) carry += sums[255];
    barrier();
  }
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint count = uint(clusters.length());
  if (lane == 0u) {
    carry = 0u;
    rest = count;
  }
  barrier();
  sum_up(lane, count);
  memoryBarrierBuffer();
  barrier();
  uint limit = rest < count ? offsets[rest] : carry;
  if (lane == 0u) {
    control.total = carry;
    control.limit = limit;
    control.rest = rest;
  }
  for (uint run = lane; run < uint(runs.length()); run += 256u) {
    uvec4 range = runs[run].range;
    uint end_cluster = range.x + range.y;
    uint from = min(offsets[range.x], limit);
    uint to = min(end_cluster < count ? offsets[end_cluster] : carry, limit);
    uint at = run * (rounds + 1u);
    for (uint round = 0u; round < rounds; ++round) {
      uint window = round * pair_capacity;
      uint first = max(from, window), end = min(to, window + pair_capacity);
      commands[at + round] = DrawCommand(end > first ? 3u * (end - first) : 0u, 1u, 3u * (first - window), 0u);
    }
    uint left = range.z + range.w, triangle = left;
    if (rest < end_cluster) triangle = rest > range.x ? clusters[rest].range.x : range.z;
    commands[at + rounds] = DrawCommand(3u * (left - triangle), piece_count, 3u * triangle, 0u);
  }
}
