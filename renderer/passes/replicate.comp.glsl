// Counts, or (EMIT) emits, the pairs of one cluster: one work group each, 64 items at a time. An item is a
// triangle, or in a small cluster a triangle and a share of the entries. Pieces are STRIPS or triangles.
#include "renderer/shaders/frame.glsl"
#include "renderer/passes/pull.glsl"
#include "renderer/passes/replication.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 7) buffer Offsets { uint offsets[]; }; // counted pairs of a cluster; then their start
layout(std430, binding = 11) buffer Counts { uint counts[]; };  // pairs of an item
layout(location = 4) uniform uint pair_capacity;
layout(location = 5) uniform uint window; // EMIT: number of the first pair that the list holds in this round

shared uint running[64];
shared uint entry_count, entry_list;

uint found = 0u; // pairs of the item so far
uint place = 0u; // of the item's first pair

void add_pair(uint triangle, uint piece, bool back) {
#ifdef CUPOLA_EMIT
  uint number = place + found;
  if (number >= window && number - window < pair_capacity && number < control.limit)
    pairs[number - window] = uvec2(triangle, back ? piece | back_bit : piece);
#endif
  ++found;
}

#ifdef CUPOLA_STRIPS
#include "renderer/passes/strips.glsl"
#else
#include "renderer/passes/cells.glsl"
#endif

/// Pairs of one item: of a triangle with the pieces of some entries.
void find_pairs(GpuCluster cluster, uint triangle, uint first_entry, uint end_entry) {
  vec3 a = pull_position(indices[triangle * 3u]) - frame.eye_near.xyz;
  vec3 b = pull_position(indices[triangle * 3u + 1u]) - frame.eye_near.xyz;
  vec3 c = pull_position(indices[triangle * 3u + 2u]) - frame.eye_near.xyz;
  bool back = dot(cross(b - a, c - a), a) >= 0.0;
  if (back && cluster.range.z == 0u) return;
  mat3 corners = frame.view_from_world * mat3(a, b, c);
  find_pieces(triangle, corners, back, first_entry, end_entry);
}

/// The running sum of all lanes' values, own included.
uint prefix_sum(uint lane, uint value) {
  running[lane] = value;
  barrier();
  for (uint step = 1u; step < 64u; step *= 2u) {
    uint before = lane >= step ? running[lane - step] : 0u;
    barrier();
    running[lane] += before;
    barrier();
  }
  return running[lane];
}

void main() {
  uint id = gl_WorkGroupID.y * 32768u + gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationID.x;
  if (id >= uint(clusters.length())) return; // the whole group
  GpuCluster cluster = clusters[id];
  uint triangles = cluster.range.y;
#ifdef CUPOLA_EMIT
  uint base = offsets[id];
  uint end = id + 1u < uint(clusters.length()) ? offsets[id + 1u] : control.total;
  if (base >= end || base >= control.limit || end <= window ||
      (base >= window && base - window >= pair_capacity))
    return; // nothing of this round
#endif
  uint shares = max(1u, 64u / max(triangles, 1u));
  find_entries(cluster, lane, max(8u, shares));
  barrier();
  uint total = 0u;
  uint items = entry_count > 0u ? triangles * shares : 0u;
  for (uint start = 0u; start < items; start += 64u) {
    uint item = start + lane;
    uint share = item % shares, triangle = cluster.range.x + item / shares;
    uint first_entry = share * entry_count / shares, end_entry = (share + 1u) * entry_count / shares;
    found = 0u;
#ifdef CUPOLA_EMIT
    uint own = item < items ? counts[cluster.range.w + item] : 0u;
    place = base + total + prefix_sum(lane, own) - own;
    if (own > 0u) find_pairs(cluster, triangle, first_entry, end_entry);
#else
    if (item < items && first_entry < end_entry) find_pairs(cluster, triangle, first_entry, end_entry);
    if (item < items) counts[cluster.range.w + item] = found;
    prefix_sum(lane, found);
#endif
    total += running[63];
    barrier();
  }
#ifndef CUPOLA_EMIT
  if (lane == 0u) offsets[id] = total;
#endif
}
