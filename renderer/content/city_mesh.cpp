#include "renderer/content/city_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/content/random.h"

namespace cupola::content::city {
namespace {

using glm::vec2;
using glm::vec3;

vec3 point(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}
vec2 place(double u, double v) { return {static_cast<float>(u), static_cast<float>(v)}; }

struct Corner {
  double x, z;
};

class Builder {
public:
  explicit Builder(Mesh& mesh)
      : mesh_(mesh) {}

  std::uint32_t vertex(const vec3& position, const vec3& normal, const vec2& uv) {
    Vertex made;
    made.position = position;
    made.normal = normal;
    made.uv = uv;
    mesh_.vertices.push_back(made);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }
  void triangle(Group group, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    auto& list = mesh_.triangles[static_cast<std::size_t>(group)];
    list.insert(list.end(), {a, b, c});
  }
  /// Corners counter-clockwise as seen from the front.
  void quad(Group group, const std::array<vec3, 4>& p, const std::array<vec2, 4>& uv, const vec3& normal) {
    std::array<std::uint32_t, 4> v{};
    for (std::size_t i = 0; i < 4; ++i) v[i] = vertex(p[i], normal, uv[i]);
    triangle(group, v[0], v[1], v[2]);
    triangle(group, v[0], v[2], v[3]);
  }
  /// A level rectangle seen from above; its texture lies in world coordinates.
  void level(Group group, const Rect& r, double y) {
    quad(group, {point(r.x0, y, r.z1), point(r.x1, y, r.z1), point(r.x1, y, r.z0), point(r.x0, y, r.z0)},
         {place(r.x0 / tile, r.z1 / tile), place(r.x1 / tile, r.z1 / tile), place(r.x1 / tile, r.z0 / tile),
          place(r.x0 / tile, r.z0 / tile)},
         {0, 1, 0});
  }
  /// An upright rectangle from a (left, as seen from its front) to b. u0 and v0 belong to the foot of a.
  void wall(Group group, Corner a, Corner b, double low, double high, double u0, double v0, double edge) {
    const double dx = b.x - a.x;
    const double dz = b.z - a.z;
    const double length = std::sqrt(dx * dx + dz * dz);
    const double u1 = u0 + length / edge;
    const double v1 = v0 - (high - low) / edge;
    quad(group, {point(a.x, low, a.z), point(b.x, low, b.z), point(b.x, high, b.z), point(a.x, high, a.z)},
         {place(u0, v0), place(u1, v0), place(u1, v1), place(u0, v1)}, point(-dz / length, 0.0, dx / length));
  }
  /// The four walls of a rectangle.
  void walls(Group group, const Rect& r, double low, double high, double u0, double v0, double edge) {
    const std::array<Corner, 4> c = outline(r);
    for (std::size_t i = 0; i < 4; ++i) wall(group, c[i], c[(i + 1) % 4], low, high, u0, v0, edge);
  }
  [[nodiscard]] static std::array<Corner, 4> outline(const Rect& r) {
    return {{{r.x0, r.z1}, {r.x1, r.z1}, {r.x1, r.z0}, {r.x0, r.z0}}};
  }

private:
  Mesh& mesh_;
};

Rect inset(const Rect& r, double by) { return {r.x0 + by, r.z0 + by, r.x1 - by, r.z1 - by}; }

// ---- ground
// -------------------------------------------------------------------------------------------------------

/// A piece of street whose picture runs along x (or z): u across it from 0 to 1, v from v0 to v1 along it.
void street_piece(Builder& b, Group group, const Rect& r, bool along_x, vec2 u, vec2 v) {
  const std::array<vec3, 4> corners{point(r.x0, 0, r.z1), point(r.x1, 0, r.z1), point(r.x1, 0, r.z0),
                                    point(r.x0, 0, r.z0)};
  if (along_x)
    b.quad(group, corners, {vec2(u.x, v.x), vec2(u.x, v.y), vec2(u.y, v.y), vec2(u.y, v.x)}, {0, 1, 0});
  else
    b.quad(group, corners, {vec2(u.x, v.x), vec2(u.y, v.x), vec2(u.y, v.y), vec2(u.x, v.y)}, {0, 1, 0});
}

/// Between two crossings: a pedestrian crossing, the road, a pedestrian crossing.
void street(Builder& b, const Rect& r, bool along_x) {
  const double begin = along_x ? r.x0 : r.z0;
  const double end = along_x ? r.x1 : r.z1;
  const auto part = [&](double from, double to) {
    Rect piece = r;
    (along_x ? piece.x0 : piece.z0) = from;
    (along_x ? piece.x1 : piece.z1) = to;
    return piece;
  };
  // the crossing's picture is 24 m wide: the square above, the stripes below it
  const vec2 stripes_u = place(0.0, street_width / wall_tile);
  const vec2 stripes_v = place(16.0 / wall_tile, (16.0 + zebra_length) / wall_tile);
  const auto road_v = static_cast<float>((end - begin - 2.0 * zebra_length) / 14.0);
  street_piece(b, Group::crossing, part(begin, begin + zebra_length), along_x, stripes_u, stripes_v);
  street_piece(b, Group::street, part(begin + zebra_length, end - zebra_length), along_x, vec2(0, 1),
               vec2(0, road_v));
  street_piece(b, Group::crossing, part(end - zebra_length, end), along_x, stripes_u, stripes_v);
}

/// Kerb and pavement, cut where the pedestrian crossings end so that every corner meets a corner.
void block_ground(Builder& b, const Block& block) {
  const Rect& kerb = block.kerb;
  const Rect inner = inset(kerb, walk_width);
  const std::array<double, 4> xs{kerb.x0, inner.x0, inner.x1, kerb.x1};
  const std::array<double, 4> zs{kerb.z0, inner.z0, inner.z1, kerb.z1};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto edge = [&](Corner from, Corner to) {
      b.wall(Group::pavement, from, to, 0.0, kerb_height, 0.0, 0.0, tile);
    };
    edge({xs[i], kerb.z1}, {xs[i + 1], kerb.z1});
    edge({kerb.x1, zs[i + 1]}, {kerb.x1, zs[i]});
    edge({xs[i + 1], kerb.z0}, {xs[i], kerb.z0});
    edge({kerb.x0, zs[i]}, {kerb.x0, zs[i + 1]});
    for (std::size_t k = 0; k < 3; ++k) {
      const bool middle = i == 1 && k == 1;
      const Group group = middle && (block.park || block.garden) ? Group::grass : Group::pavement;
      b.level(group, {xs[i], zs[k], xs[i + 1], zs[k + 1]}, kerb_height);
    }
  }
}

/// Where streets and blocks begin and end along one axis: all their corners lie on these lines.
std::vector<double> border_lines(int first, int last) {
  std::vector<double> lines;
  const double half = street_width * 0.5;
  for (int i = first; i <= last; ++i) {
    lines.push_back(i * pitch - half);
    lines.push_back(i * pitch + half);
    if (i == last) break;
    lines.push_back(i * pitch + half + zebra_length);
    lines.push_back((i + 1) * pitch - half - zebra_length);
  }
  return lines;
}

/// Meadows from the city's border to beyond the sky, joined to the streets' own corners.
void meadows(Builder& b, const Plan& plan, double reach) {
  const std::vector<double> xs = border_lines(plan.first_x, plan.last_x);
  const std::vector<double> zs = border_lines(plan.first_z, plan.last_z);
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    b.level(Group::grass, {xs[i], -reach, xs[i + 1], zs.front()}, 0.0);
    b.level(Group::grass, {xs[i], zs.back(), xs[i + 1], reach}, 0.0);
  }
  for (std::size_t i = 0; i + 1 < zs.size(); ++i) {
    b.level(Group::grass, {-reach, zs[i], xs.front(), zs[i + 1]}, 0.0);
    b.level(Group::grass, {xs.back(), zs[i], reach, zs[i + 1]}, 0.0);
  }
  b.level(Group::grass, {-reach, -reach, xs.front(), zs.front()}, 0.0);
  b.level(Group::grass, {xs.back(), -reach, reach, zs.front()}, 0.0);
  b.level(Group::grass, {-reach, zs.back(), xs.front(), reach}, 0.0);
  b.level(Group::grass, {xs.back(), zs.back(), reach, reach}, 0.0);
}

void streets(Builder& b, const Plan& plan) {
  const double half = street_width * 0.5;
  for (int z = plan.first_z; z <= plan.last_z; ++z) {
    for (int x = plan.first_x; x <= plan.last_x; ++x) {
      const double cx = x * pitch;
      const double cz = z * pitch;
      const auto edge = static_cast<float>(street_width / wall_tile);
      street_piece(b, Group::crossing, {cx - half, cz - half, cx + half, cz + half}, false, vec2(0, edge),
                   vec2(edge, 0));
      if (x < plan.last_x) street(b, {cx + half, cz - half, cx + pitch - half, cz + half}, true);
      if (z < plan.last_z) street(b, {cx - half, cz + half, cx + half, cz + pitch - half}, false);
    }
  }
}

// ---- buildings
// ----------------------------------------------------------------------------------------------------

/// Foot and head of the walls above the shops; draws the shops with `draw(group, low, high, u0, v0)`.
template <class Draw>
double ground_floor(const Building& building, const Draw& draw) {
  if (!building.shops) return kerb_height;
  const double head = kerb_height + shop_height;
  draw(Group::shop, kerb_height, head, 0.0, (building.shift % 6 + 1) / 6.0);
  return head;
}

void box_like(Builder& b, const Building& building) {
  double foot = ground_floor(building, [&](Group group, double low, double high, double u0, double v0) {
    b.walls(group, building.rect, low, high, u0, v0, wall_tile);
  });
  double v0 = 1.0;
  for (int tier = 1; tier <= building.tiers; ++tier) {
    const Rect rect = inset(building.rect, 1.5 * (tier - 1));
    const double head = kerb_height + height_of(building, tier);
    b.walls(building.wall, rect, foot, head, building.shift / 8.0, v0, wall_tile);
    b.level(Group::flat_roof, rect, head);
    v0 -= (head - foot) / wall_tile;
    foot = head;
  }
}

void ell(Builder& b, const Building& building) {
  const Rect& r = building.rect;
  const double nx = building.notch_x * bay;
  const double nz = building.notch_z * bay;
  // counter-clockwise from above (as outline()), with the notch at one corner
  const std::array<Corner, 4> c = Builder::outline(r);
  const std::array<Corner, 4> inward{{{nx, -nz}, {-nx, -nz}, {-nx, nz}, {nx, nz}}};
  const auto cut = static_cast<std::size_t>(building.corner == 0   ? 0
                                            : building.corner == 1 ? 1
                                            : building.corner == 2 ? 3
                                                                   : 2);
  const bool turned = cut % 2 == 1; // which side of the notch comes first
  const Corner reflex{c[cut].x + inward[cut].x, c[cut].z + inward[cut].z};
  const Corner before = turned ? Corner{reflex.x, c[cut].z} : Corner{c[cut].x, reflex.z};
  const Corner after = turned ? Corner{c[cut].x, reflex.z} : Corner{reflex.x, c[cut].z};
  const std::array<Corner, 6> outline{reflex,           after, c[(cut + 1) % 4], c[(cut + 2) % 4],
                                      c[(cut + 3) % 4], before};
  const auto around = [&](Group group, double low, double high, double u0, double v0) {
    for (std::size_t i = 0; i < 6; ++i)
      b.wall(group, outline[i], outline[(i + 1) % 6], low, high, u0, v0, wall_tile);
  };
  const double foot = ground_floor(building, around);
  const double head = kerb_height + height_of(building, 1);
  around(building.wall, foot, head, building.shift / 8.0, 1.0);
  std::array<std::uint32_t, 6> roof{};
  for (std::size_t i = 0; i < 6; ++i)
    roof[i] = b.vertex(point(outline[i].x, head, outline[i].z), {0, 1, 0},
                       place(outline[i].x / tile, outline[i].z / tile));
  for (std::size_t i = 1; i + 1 < 6; ++i) b.triangle(Group::flat_roof, roof[0], roof[i], roof[i + 1]);
}

void gabled(Builder& b, const Building& building) {
  const Rect& r = building.rect;
  const double foot = ground_floor(building, [&](Group group, double low, double high, double u0, double v0) {
    b.walls(group, r, low, high, u0, v0, wall_tile);
  });
  const double head = kerb_height + height_of(building, 1);
  b.walls(building.wall, r, foot, head, building.shift / 8.0, 1.0, wall_tile);
  const bool along_x = building.corner == 0;
  const double span = along_x ? r.depth() : r.width();
  const double rise = span * 0.35;
  const double slope = std::sqrt(rise * rise + span * span * 0.25);
  // corner k of the outline; the ridge joins the middles of two opposite sides
  const std::array<Corner, 4> c = Builder::outline(r);
  const std::size_t first = along_x ? 0 : 1;
  for (std::size_t half = 0; half < 2; ++half) {
    const Corner& left = c[(first + 2 * half) % 4];
    const Corner& right = c[(first + 2 * half + 1) % 4];
    const Corner& far_right = c[(first + 2 * half + 2) % 4];
    const Corner& far_left = c[(first + 2 * half + 3) % 4];
    const vec3 ridge_left = point((left.x + far_left.x) * 0.5, head + rise, (left.z + far_left.z) * 0.5);
    const vec3 ridge_right = point((right.x + far_right.x) * 0.5, head + rise, (right.z + far_right.z) * 0.5);
    const double length = along_x ? r.width() : r.depth();
    const vec3 outward = glm::normalize(point(left.x - far_left.x, 0.0, left.z - far_left.z));
    const auto flat = static_cast<float>(rise / slope);
    const auto up = static_cast<float>(span * 0.5 / slope);
    b.quad(
        Group::tiled_roof,
        {point(left.x, head, left.z), point(right.x, head, right.z), ridge_right, ridge_left},
        {place(0, 0), place(length / tile, 0), place(length / tile, -slope / tile), place(0, -slope / tile)},
        outward * flat + vec3(0, up, 0));
    // the gable at the right end, in the windowless upper quarter of the façade's picture
    const vec3 side = glm::normalize(point(right.x - left.x, 0.0, right.z - left.z));
    const double u1 = span / wall_tile;
    const double scale = std::min(1.0, 5.5 / rise) / wall_tile;
    const std::uint32_t a = b.vertex(point(right.x, head, right.z), side, place(0, 0.24));
    const std::uint32_t e = b.vertex(point(far_right.x, head, far_right.z), side, place(u1, 0.24));
    const std::uint32_t top = b.vertex(ridge_right, side, place(u1 * 0.5, 0.24 - rise * scale));
    b.triangle(building.wall, a, e, top);
  }
}

// ---- small things
// -------------------------------------------------------------------------------------------------

void small_box(Builder& b, Group group, const Filler& f) {
  const Rect r{f.x - f.size, f.z - f.size, f.x + f.size, f.z + f.size};
  b.walls(group, r, f.y, f.y + f.height, 0.0, 0.0, tile);
  b.level(group, r, f.y + f.height);
}

/// Two cones of `sides` sides, base to base, smooth; leaves in the upper three quarters of the picture.
void crown(Builder& b, const Filler& f, int sides, double low, double middle, double high, double radius) {
  std::vector<std::uint32_t> ring;
  for (int i = 0; i <= sides; ++i) {
    const double turn = static_cast<double>(i) / sides + static_cast<double>(f.key % 97) / 97.0;
    const double c = cosine_of_turns(turn);
    const double s = sine_of_turns(turn);
    ring.push_back(b.vertex(point(f.x + c * radius, middle, f.z - s * radius), point(c, 0, -s),
                            place(i * 0.75 / sides * 2.0, 0.36)));
  }
  for (int i = 0; i < sides; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double u = (i + 0.5) * 0.75 / sides * 2.0;
    b.triangle(Group::tree, ring[at], ring[at + 1],
               b.vertex(point(f.x, high, f.z), {0, 1, 0}, place(u, 0.0)));
    b.triangle(Group::tree, ring[at + 1], ring[at],
               b.vertex(point(f.x, low, f.z), {0, -1, 0}, place(u, 0.72)));
  }
}

void tree(Builder& b, const Filler& f) {
  const double trunk = f.height * 0.35;
  crown(b, f, 6, f.y + trunk * 0.85, f.y + f.height * 0.55, f.y + f.height, f.size);
  const Rect r{f.x - 0.14, f.z - 0.14, f.x + 0.14, f.z + 0.14};
  b.walls(Group::tree, r, f.y, f.y + trunk, 0.0, 0.98, tile);
}

// ---- sky
// ----------------------------------------------------------------------------------------------------------

/// A closed ball seen from inside, with a ring of vertices at the horizon. v: 0 zenith, 0.9 horizon, 1 nadir.
void sky(Builder& b, const Plan& plan, double radius) {
  const int rings = 2 * plan.sky_rings;
  std::vector<std::uint32_t> grid;
  for (int ring = 0; ring <= rings; ++ring) {
    const double height = 1.0 - static_cast<double>(ring) / plan.sky_rings; // 1 zenith … -1 nadir
    const double y = ring == plan.sky_rings ? 0.0 : sine_of_turns(height * 0.25);
    const double flat = ring == 0 || ring == rings ? 0.0 : cosine_of_turns(height * 0.25);
    const double v = height >= 0.0 ? 0.9 * (1.0 - height) : 0.9 - 0.1 * height;
    for (int i = 0; i <= plan.sky_segments; ++i) {
      const double pole = ring == 0 || ring == rings ? 0.5 : 0.0; // of each triangle, for an even picture
      const double turn = static_cast<double>(i % plan.sky_segments) / plan.sky_segments;
      const double x = flat * cosine_of_turns(turn);
      const double z = flat * sine_of_turns(turn);
      grid.push_back(b.vertex(point(x * radius, y * radius, z * radius), point(-x, -y, -z),
                              place((i + pole) / plan.sky_segments, v)));
    }
  }
  const auto at = [&](int ring, int i) {
    return grid[static_cast<std::size_t>(ring * (plan.sky_segments + 1) + i)];
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < plan.sky_segments; ++i) {
      // from inside, x turns to z clockwise seen from above: to the right
      if (ring < rings - 1) b.triangle(Group::sky, at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      if (ring > 0) b.triangle(Group::sky, at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
  }
}

} // namespace

Mesh build(const Plan& plan) {
  Mesh mesh;
  mesh.triangles.resize(group_count);
  Builder b(mesh);
  const int side = std::max(plan.last_x - plan.first_x, plan.last_z - plan.first_z);
  const double radius = std::max(1500.0, 1.6 * side * pitch);
  sky(b, plan, radius);
  meadows(b, plan, radius * 1.02);
  streets(b, plan);
  for (const Block& block : plan.blocks) {
    block_ground(b, block);
    for (const Building& building : block.buildings) {
      if (building.form == Form::ell)
        ell(b, building);
      else if (building.form == Form::gabled)
        gabled(b, building);
      else
        box_like(b, building);
    }
  }
  for (const Filler& filler : plan.fillers) {
    switch (filler.kind) {
    case FillerKind::tree:
      tree(b, filler);
      break;
    case FillerKind::bush:
      crown(b, filler, 4, filler.y - 0.2, filler.y + filler.height * 0.45, filler.y + filler.height,
            filler.size);
      break;
    case FillerKind::roof_box:
      small_box(b, Group::flat_roof, filler);
      break;
    case FillerKind::chimney:
      small_box(b, Group::pavement, filler);
      break;
    }
  }
  return mesh;
}

} // namespace cupola::content::city
