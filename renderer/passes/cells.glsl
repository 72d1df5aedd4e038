// Which triangular pieces a triangle touches: its pyramid of three planes through the eye against a tree of
// cones, then against each piece's own pyramid. Both are convex: where they do not meet, a plane of either
// tells them apart, or, where one lies behind the other, the plane on which w is 0.
// Twin of passes/cells.cpp. A part of replicate.comp.glsl.

struct GpuGroup {
  vec4 axis_sine; // of a cone about all rays of its pieces; half angle
  float cosine;   // of the half angle; -1: everything
  uint first, count, next;
};
layout(std430, binding = 6) readonly buffer Groups { GpuGroup groups[]; }; // a tree in pre-order
layout(std430, binding = 10) readonly buffer Rays { vec4 rays[]; };        // three of each piece

const uint most_entries = 128u;
shared uint entries[2][most_entries]; // groups that the cluster's triangles are tried against

bool is_leaf(uint at) { return groups[at].next == at + 1u; }

/// Whether a group's cone may meet a sphere of view space.
bool meets(uint at, vec3 center, float radius) {
  GpuGroup group = groups[at];
  float square = dot(center, center);
  if (group.cosine <= -1.0 || square <= radius * radius) return true;
  float distance = sqrt(square);
  float sine = radius / distance, cosine = sqrt(max(0.0, 1.0 - sine * sine));
  if (sine * group.cosine + cosine * group.axis_sine.w < 0.0) return true; // beyond half a turn together
  return dot(group.axis_sine.xyz, center) >=
         distance * (group.cosine * cosine - group.axis_sine.w * sine) - 1e-6 * distance;
}

/// Groups that meet the cluster's sphere, in order, as small as `wanted` of them get: level by level.
void find_entries(GpuCluster cluster, uint lane, uint wanted) {
  if (lane != 0u) return;
  vec3 center = frame.view_from_world * (cluster.sphere.xyz - frame.eye_near.xyz);
  float radius = cluster.sphere.w;
  bool unbounded = radius < 0.0;
  entries[0][0] = 0u;
  uint count = unbounded || meets(0u, center, radius) ? 1u : 0u;
  uint now = 0u;
  bool finer = !unbounded;
  while (finer && count < wanted) {
    finer = false;
    uint kept = 0u;
    for (uint i = 0u; i < count; ++i) {
      uint at = entries[now][i];
      bool leaf = is_leaf(at);
      finer = finer || !leaf;
      uint child = leaf ? at : at + 1u;
      if (leaf || meets(child, center, radius)) entries[now ^ 1u][kept++] = child;
      if (leaf) continue;
      child = groups[child].next;
      if (meets(child, center, radius)) entries[now ^ 1u][kept++] = child;
    }
    now ^= 1u;
    count = kept;
    finer = finer && count > 0u;
  }
  entry_count = count;
  entry_list = now;
}

/// A triangle as seen from the eye: planes not negative inside, by column the one opposite a corner.
struct Pyramid {
  mat3 corners, planes;
  vec3 lengths; // of the planes
  vec3 slack;   // by which rounding may move a plane
};

/// Edges as differences of corners: their rounding does not grow with the distance.
Pyramid pyramid_of(mat3 corners) {
  Pyramid t;
  t.corners = corners;
  mat3 edges = mat3(corners[2] - corners[1], corners[0] - corners[2], corners[1] - corners[0]);
  t.planes = mat3(cross(corners[1], edges[0]), cross(corners[2], edges[1]), cross(corners[0], edges[2]));
  if (dot(t.planes[0], corners[0]) < 0.0) t.planes = -t.planes;
  t.lengths = vec3(length(t.planes[0]), length(t.planes[1]), length(t.planes[2]));
  t.slack = 4e-7 * vec3(length(corners[1]) * length(edges[0]), length(corners[2]) * length(edges[1]),
                        length(corners[0]) * length(edges[2]));
  return t;
}

bool touches(Pyramid t, uint piece) {
  mat3 to_screen = pieces[piece].to_screen;
  vec3 w_row = vec3(to_screen[0].z, to_screen[1].z, to_screen[2].z);
  vec3 w = w_row * t.corners;
  if (all(lessThan(w, vec3(0.0)))) return false; // behind all of the piece
  for (int i = 0; i < 3; ++i) {
    vec4 plane = pieces[piece].planes[i];
    if (all(lessThan(plane.xyz * t.corners + plane.w * w, vec3(0.0)))) return false;
  }
  mat3 own = mat3(rays[piece * 3u].xyz, rays[piece * 3u + 1u].xyz, rays[piece * 3u + 2u].xyz);
  for (int i = 0; i < 3; ++i)
    if (all(lessThan(t.planes[i] * own, vec3(-t.slack[i])))) return false;
  return true;
}

void find_pieces(uint triangle, mat3 corners, bool back, uint first_entry, uint end_entry) {
  Pyramid t = pyramid_of(corners);
  if (dot(t.planes[0], corners[0]) == 0.0) return; // through the eye: seen edge on
  for (uint entry = first_entry; entry < end_entry; ++entry) {
    uint at = entries[entry_list][entry];
    uint end = groups[at].next;
    while (at < end) {
      GpuGroup group = groups[at];
      vec3 heights = group.axis_sine.xyz * t.planes;
      vec3 reach = group.axis_sine.w * t.lengths + t.slack;
      bool everywhere = group.cosine <= -1.0;
      bool behind = all(lessThan(group.axis_sine.xyz * t.corners, vec3(0.0)));
      if (!everywhere && (behind || any(lessThan(heights, -reach)))) {
        at = group.next;
        continue;
      }
      bool whole = !everywhere && all(greaterThan(heights, reach));
      if (whole || group.next == at + 1u)
        for (uint i = group.first; i < group.first + group.count; ++i)
          if (whole || touches(t, i)) add_pair(triangle, i, back);
      at = whole ? group.next : at + 1u;
    }
  }
}
