#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "renderer/plan/measure.h"
#include "renderer/plan/plan.h"

using namespace cupola;
using namespace cupola::plan;

namespace {

projection::Map map_of(const model::Shape& shape, const PixelRect& rect, double zoom = 1.0,
                       glm::dvec3 off_axis = {}, model::Orientation orientation = {}) {
  model::Projection projection;
  projection.shape = shape;
  projection.zoom = zoom;
  projection.off_axis = off_axis;
  projection.orientation = orientation;
  return projection::make_map(projection, double(rect.width) / rect.height);
}

int twos(long n) { return std::countr_zero(static_cast<unsigned long>(std::labs(n))); }

/// Borders: between whole pixels; sloped ones by the rule; each of one piece or of two.
void check_borders(const PieceSet& set, const PixelRect& rect) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  long touching = 0, broken = 0, repeated = 0;
  const auto pixel = [&](std::uint32_t corner) {
    const glm::dvec2 s = set.corners[corner].screen;
    const glm::dvec2 p((s.x + 1.0) * 0.5 * rect.width, (1.0 - s.y) * 0.5 * rect.height);
    if (std::abs(p.x - std::round(p.x)) > 1e-6 || std::abs(p.y - std::round(p.y)) > 1e-6) ++broken;
    return std::pair{std::lround(p.x), std::lround(p.y)};
  };
  for (const auto& t : set.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (++sides[{a, b}] > 1) ++repeated;
      const auto p = pixel(a), q = pixel(b);
      const long dx = q.first - p.first, dy = q.second - p.second;
      if (dx != 0 && dy != 0 && twos(dx) == twos(dy)) ++touching;
    }
  CHECK(broken == 0);
  CHECK(touching == 0);
  CHECK(repeated == 0);
}

/// Groups: a tree whose leaves are all pieces, in cones that hold their rays.
void check_groups(const PieceSet& set) {
  REQUIRE_FALSE(set.groups.empty());
  CHECK(set.groups[0].first == 0);
  CHECK(set.groups[0].count == set.pieces.size());
  CHECK(set.groups[0].next == set.groups.size());
  long outside = 0;
  std::size_t in_leaves = 0;
  for (std::uint32_t g = 0; g < set.groups.size(); ++g) {
    const PieceGroup& group = set.groups[g];
    if (group.next == g + 1) in_leaves += group.count;
    if (group.cosine <= -1.0) continue;
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i)
      for (const std::uint32_t corner : set.triangles[i])
        if (glm::dot(group.axis, set.corners[corner].ray) < group.cosine - 1e-9) ++outside;
  }
  CHECK(outside == 0);
  CHECK(in_leaves == set.pieces.size());
}

struct Case {
  const char* name;
  model::Shape shape;
  PixelRect rect;
  double zoom = 1.0;
  glm::dvec3 off_axis{0.0};
  double looked_up = 0.0; ///< share of what is shown, at most
};

const std::vector<Case>& cases() {
  using namespace model;
  static const std::vector<Case> all{
      {"fisheye 180", Fisheye{{180.0}}, {0, 0, 1024, 1024}},
      {"fisheye 180, wide picture", Fisheye{{180.0}}, {7, 3, 901, 415}},
      {"fisheye 260", Fisheye{{260.0}}, {0, 0, 800, 800}},
      {"fisheye 340", Fisheye{{340.0}}, {0, 0, 800, 800}},
      {"fisheye 360", Fisheye{{360.0}}, {0, 0, 512, 512}, 1.0, {}, 0.1},
      {"fisheye zoomed out", Fisheye{{180.0}}, {0, 0, 600, 600}, 0.6},
      {"fisheye zoomed in", Fisheye{{180.0}}, {0, 0, 600, 600}, 3.0},
      {"fisheye off axis", Fisheye{{220.0}}, {0, 0, 640, 480}, 1.0, {0.3, 0.2, 0.5}},
      {"equirectangular", Equirectangular{}, {0, 0, 1024, 512}, 1.0, {}, 0.07},
      {"equirectangular without poles", Equirectangular{{200.0}, {120.0}}, {0, 0, 800, 480}},
      {"equirectangular zoomed out", Equirectangular{}, {0, 0, 1024, 512}, 0.6, {}, 0.12},
      {"cylinder", Cylinder{{180.0}, {60.0}}, {0, 0, 900, 300}},
      {"stereographic", Stereographic{{220.0}}, {0, 0, 700, 700}},
      {"orthographic", Orthographic{{160.0}}, {0, 0, 700, 700}, 1.0, {}, 0.01},
      {"orthographic 180", Orthographic{{180.0}}, {0, 0, 700, 700}, 1.0, {}, 0.03},
      {"mercator", Mercator{}, {0, 0, 700, 700}},
      {"panini", Panini{}, {0, 0, 960, 540}},
      {"perspective", Perspective{}, {0, 0, 640, 480}},
      {"cube cross", CubeCross{}, {0, 0, 640, 480}},
      {"cube cross, border on pixel centres", CubeCross{}, {0, 0, 683, 513}},
      {"cube cross zoomed", CubeCross{}, {0, 0, 500, 333}, 0.8},
  };
  return all;
}

} // namespace

TEST_CASE("pieces of every projection: each pixel once, within the error, borders clear of pixel centres") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    const auto map = map_of(c.shape, c.rect, c.zoom, c.off_axis, {{30.0}, {-20.0}, {10.0}});
    const auto set = make_cells(map, c.rect, 0.25);
    REQUIRE(set);
    const Measured m = measure(*set, map, c.rect);
    CHECK(m.uncovered == 0);
    CHECK(m.covered_twice == 0);
    CHECK(m.not_shown == 0);
    CHECK(m.outside_bounds == 0);
    CHECK(m.largest <= 0.25);
    CHECK(m.least_w > 0.0);
    CHECK(set->max_error == doctest::Approx(m.largest).epsilon(0.2).scale(0.05));
    CHECK(set->rms_error == doctest::Approx(m.rms).epsilon(0.3).scale(0.05));
    CHECK(double(m.looked_up) <= c.looked_up * double(m.shown));
    CHECK(set->fills == (m.shown == long(c.rect.width) * c.rect.height));
    if (!std::holds_alternative<model::CubeCross>(c.shape)) check_borders(*set, c.rect);
    check_groups(*set);
  }
}

TEST_CASE("an inner border belongs to two pieces: no corner stands on another's border") {
  const PixelRect rect{0, 0, 700, 700};
  const auto map = map_of(model::Stereographic{{200.0}}, rect); // its pieces hang over the picture all around
  const auto set = make_cells(map, rect, 0.25);
  REQUIRE(set);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : set->triangles)
    for (std::size_t i = 0; i < 3; ++i) ++sides[{t[i], t[(i + 1) % 3]}];
  long lonely_within = 0;
  for (const auto& [side, count] : sides) {
    if (sides.contains({side.second, side.first})) continue;
    // Only where what lies beyond shows nothing: the whole side is outside the circle.
    const glm::dvec2 a = set->corners[side.first].screen, b = set->corners[side.second].screen;
    for (int i = 0; i <= 20; ++i)
      if (glm::length(a + (b - a) * (i / 20.0)) < 1.0 - 2.0 / 700) {
        ++lonely_within;
        break;
      }
  }
  CHECK(lonely_within == 0);
}

TEST_CASE("a fisheye takes less than half the pieces of a fixed lattice") {
  const PixelRect rect{0, 0, 2048, 2048};
  const auto set = make_cells(map_of(model::Fisheye{{180.0}}, rect), rect, 0.25);
  REQUIRE(set);
  CHECK(set->pieces.size() < 4400); // 8,800 of 32 × 24 pixels have 0.23 px of error
  CHECK(set->looked_up.empty());
}

TEST_CASE("what is flat stays whole") {
  const PixelRect rect{0, 0, 2048, 2048};
  const auto set = make_cells(map_of(model::Perspective{{100.0}, {}}, rect), rect, 1e-3);
  REQUIRE(set);
  CHECK(set->pieces.size() <= 2 * 8 * 9); // roots of 320 × 256
  CHECK(set->max_error < 1e-4);
}

TEST_CASE("more error allowed, fewer pieces; turned the other way, the same") {
  const PixelRect rect{0, 0, 1000, 1000};
  std::size_t before = 1'000'000;
  for (const double error : {0.05, 0.25, 1.0, 4.0}) {
    const auto set = make_cells(map_of(model::Fisheye{}, rect), rect, error);
    REQUIRE(set);
    CHECK(set->pieces.size() < before);
    CHECK(set->max_error <= error);
    before = set->pieces.size();
  }
  const auto one = make_cells(map_of(model::Fisheye{}, rect), rect, 0.25);
  const auto turned = make_cells(map_of(model::Fisheye{}, rect, 1.0, {}, {{90.0}, {45.0}, {}}), rect, 0.25);
  REQUIRE(one);
  REQUIRE(turned);
  CHECK(double(turned->pieces.size()) == doctest::Approx(double(one->pieces.size())).epsilon(0.02));
}

TEST_CASE("pictures of any size, errors of any size: bounded") {
  const auto fisheye = [](const PixelRect& rect, double error) {
    return make_cells(map_of(model::Fisheye{}, rect), rect, error);
  };
  for (const PixelRect rect : {PixelRect{0, 0, 1, 1}, {0, 0, 3, 2}, {0, 0, 1, 500}, {0, 0, 20, 20}}) {
    CAPTURE(rect.width);
    const auto map = map_of(model::Fisheye{}, rect);
    const auto set = make_cells(map, rect, 0.25);
    REQUIRE(set);
    const Measured m = measure(*set, map, rect);
    CHECK(m.uncovered == 0);
    CHECK(m.covered_twice == 0);
    CHECK(m.largest <= 0.25);
  }
  const auto large = fisheye({0, 0, 16384, 16384}, 0.25);
  REQUIRE(large);
  CHECK(large->max_error <= 0.25);
  CHECK(large->pieces.size() < 40'000);
  const auto fine = fisheye({0, 0, 2048, 2048}, 0.0);
  REQUIRE(fine);
  CHECK(fine->pieces.size() + fine->looked_up.size() <= max_cells + 100); // what a last split forces
  CHECK(fine->unfinished);
  CHECK_FALSE(large->unfinished);
  CHECK_FALSE(fisheye({0, 0, 0, 10}, 0.25));
}
