// Which strips a triangle touches. Twin of passes/strip_range.h; the draw's clip distances are exact, so
// this may name a strip too many by rounding but never one too few. A part of replicate.comp.glsl.

const float pi = 3.14159265358979;
const float margin = 1e-4; // radians; float azimuths are good to 1e-6

layout(location = 0) uniform mat3 axes_from_view; // rows: right, axis, back of the cylinder
layout(location = 2) uniform int strip_count;
layout(location = 3) uniform bool full_turn;
layout(std430, binding = 6) readonly buffer Borders { float borders[]; }; // strip_count + 1, rising

float azimuth(vec3 p) { return atan(p.x, -p.z); }

float short_turn(float a) {
  return a > pi ? a - 2.0 * pi : (a < -pi ? a + 2.0 * pi : a);
}

/// Strip that holds an azimuth within [borders[0], borders[strip_count]], clamped to the ends.
int strip_at(float a) {
  int low = 0, high = strip_count; // borders[low] <= a < borders[high]
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (borders[middle] <= a) low = middle;
    else high = middle;
  }
  return low;
}

struct StripRange {
  int first, count; // strips first … first + count − 1, modulo strip_count
};

/// Strips that an azimuth interval [from, to] touches, to - from < 2π.
StripRange strips_between(float from, float to) {
  StripRange none = StripRange(0, 0);
  float left = borders[0], right = borders[strip_count];
  // The interval, turned so that it starts within one turn right of the first border.
  float turns = floor((from - left) / (2.0 * pi));
  from -= turns * 2.0 * pi;
  to -= turns * 2.0 * pi;
  if (full_turn) {
    int first = strip_at(from);
    int last = to < right ? strip_at(to) : strip_at(to - 2.0 * pi) + strip_count;
    return StripRange(first, min(last - first + 1, strip_count));
  }
  bool starts_inside = from <= right;
  bool wraps_inside = to - 2.0 * pi >= left;
  if (starts_inside && wraps_inside) return StripRange(0, strip_count); // both ends: rare, take all
  if (starts_inside) {
    int first = strip_at(from);
    return StripRange(first, strip_at(min(to, right)) - first + 1);
  }
  if (wraps_inside) return StripRange(0, strip_at(min(to - 2.0 * pi, right)) + 1);
  return none;
}

StripRange triangle_strips(vec3 a, vec3 b, vec3 c) {
  float azimuth_a = azimuth(a);
  float ab = short_turn(azimuth(b) - azimuth_a);
  float bc = short_turn(azimuth(c) - azimuth(b));
  float ca = short_turn(azimuth_a - azimuth(c));
  if (abs(ab + bc + ca) > pi || max(max(abs(ab), abs(bc)), abs(ca)) > pi - 1e-3)
    return StripRange(0, strip_count); // the axis pierces it, or passes too close to tell
  float low = min(0.0, min(ab, ab + bc)), high = max(0.0, max(ab, ab + bc));
  return strips_between(azimuth_a + low - margin, azimuth_a + high + margin);
}

/// False when no strip can see anything of the cluster.
bool cluster_visible(GpuCluster cluster) {
  if (cluster.sphere.w < 0.0 || full_turn) return true;
  vec3 p = axes_from_view * (frame.view_from_world * (cluster.sphere.xyz - frame.eye_near.xyz));
  float distance = length(p.xz);
  if (distance <= cluster.sphere.w) return true;
  float half_angle = asin(min(cluster.sphere.w / distance, 1.0)) + margin;
  return strips_between(azimuth(p) - half_angle, azimuth(p) + half_angle).count > 0;
}

void find_entries(GpuCluster cluster, uint lane, uint wanted) {
  if (lane == 0u) entry_count = cluster_visible(cluster) ? 1u : 0u;
}

void find_pieces(uint triangle, mat3 corners, bool back, uint first_entry, uint end_entry) {
  StripRange range = triangle_strips(axes_from_view * corners[0], axes_from_view * corners[1],
                                     axes_from_view * corners[2]);
  for (int i = 0; i < range.count; ++i) add_pair(triangle, uint((range.first + i) % strip_count), back);
}
