// Counts (COUNT) or emits (EMIT) the pairs of one cluster: one work group each, 64 triangles at a time.
#include "renderer/shaders/frame.glsl"
#include "renderer/passes/pull.glsl"
#include "renderer/passes/strips.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 7) buffer Offsets { uint offsets[]; }; // COUNT: pairs of a cluster; then their start
layout(location = 4) uniform uint pair_capacity;

shared uint running[64];

/// False when no strip can see anything of the cluster.
bool cluster_visible(GpuCluster cluster) {
  if (cluster.sphere.w < 0.0 || full_turn) return true;
  vec3 p = axes_from_view * (frame.view_from_world * (cluster.sphere.xyz - frame.eye_near.xyz));
  float distance = length(p.xz);
  if (distance <= cluster.sphere.w) return true;
  float half_angle = asin(min(cluster.sphere.w / distance, 1.0)) + margin;
  return strips_between(azimuth(p) - half_angle, azimuth(p) + half_angle).count > 0;
}

StripRange ranges_of(GpuCluster cluster, uint triangle) {
  vec3 a = pull_position(indices[triangle * 3u]) - frame.eye_near.xyz;
  vec3 b = pull_position(indices[triangle * 3u + 1u]) - frame.eye_near.xyz;
  vec3 c = pull_position(indices[triangle * 3u + 2u]) - frame.eye_near.xyz;
  if (cluster.range.z == 0u && dot(cross(b - a, c - a), a) >= 0.0) return StripRange(0, 0); // back face
  mat3 turn = axes_from_view * frame.view_from_world;
  return triangle_strips(turn * a, turn * b, turn * c);
}

void main() {
  uint id = gl_WorkGroupID.y * 32768u + gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationID.x;
  bool exists = id < uint(clusters.length());
  GpuCluster cluster;
  bool visible = false;
  if (exists) {
    cluster = clusters[id];
    visible = cluster_visible(cluster);
  }
  uint base = 0u;
#ifdef CUPOLA_EMIT
  if (exists) base = offsets[id];
  bool fits = control.total <= pair_capacity;
#endif
  uint total = 0u;
  uint rounds = exists && visible ? (cluster.range.y + 63u) / 64u : 0u;
  for (uint round = 0u; round < rounds; ++round) {
    uint at = round * 64u + lane;
    StripRange range = StripRange(0, 0);
    if (at < cluster.range.y) range = ranges_of(cluster, cluster.range.x + at);
    running[lane] = uint(range.count);
    barrier();
    for (uint step = 1u; step < 64u; step *= 2u) { // inclusive prefix sum
      uint value = lane >= step ? running[lane - step] : 0u;
      barrier();
      running[lane] += value;
      barrier();
    }
#ifdef CUPOLA_EMIT
    if (fits) {
      uint place = base + total + running[lane] - uint(range.count);
      for (int i = 0; i < range.count; ++i)
        pairs[place + uint(i)] = uvec2(cluster.range.x + at, uint((range.first + i) % strip_count));
    }
#endif
    total += running[63];
    barrier();
  }
#ifndef CUPOLA_EMIT
  if (lane == 0u && exists) offsets[id] = total;
#endif
}
