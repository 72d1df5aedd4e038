#include "renderer/plan/lattice.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <map>
#include <random>
#include <utility>

using namespace cupola::plan;

namespace {

long doubled_area(const Lattice& lattice, const Lattice::Triangle& triangle) {
  const auto& p = lattice.points();
  const glm::ivec2 a = p[triangle.corners[1]] - p[triangle.corners[0]],
                   b = p[triangle.corners[2]] - p[triangle.corners[0]];
  return long(a.y) * b.x - long(a.x) * b.y; // y downwards: positive when counter-clockwise on screen
}

int twos(int n) { return std::countr_zero(static_cast<unsigned>(std::abs(n))); }

} // namespace

TEST_CASE("a lattice stays conforming, keeps its area and keeps clear of pixel centres") {
  Lattice lattice({-64, -32}, {640, 500}, {320, 256});
  long area = 0;
  for (const auto& triangle : lattice.triangles()) area += doubled_area(lattice, triangle);
  CHECK(area == 2L * 640 * 512);

  std::mt19937 random(7);
  std::vector<std::uint32_t> changed;
  int halved = 0;
  for (int i = 0; i < 2000; ++i) {
    // Small numbers more often: deep refinement in places.
    const auto limit = static_cast<double>(lattice.triangles().size());
    const auto triangle =
        static_cast<std::uint32_t>(limit * std::pow(std::uniform_real_distribution<>(0.0, 1.0)(random), 3.0));
    if (!lattice.divisible(triangle, 2)) continue;
    lattice.bisect(triangle, changed);
    ++halved;
  }
  CHECK(halved > 1000);

  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> sides; // each once in each direction
  long after = 0;
  bool repeated = false, touching = false;
  for (std::uint32_t t = 0; t < lattice.triangles().size(); ++t) {
    const auto& corners = lattice.triangles()[t].corners;
    REQUIRE(doubled_area(lattice, lattice.triangles()[t]) > 0);
    after += doubled_area(lattice, lattice.triangles()[t]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
      repeated = repeated || !sides.try_emplace({from, to}, t).second;
      const glm::ivec2 d = lattice.points()[to] - lattice.points()[from];
      touching = touching || (d.x != 0 && d.y != 0 && twos(d.x) == twos(d.y));
    }
  }
  CHECK(after == area);
  CHECK_FALSE(repeated);
  CHECK_FALSE(touching);
  int lonely = 0, wrong_neighbours = 0;
  for (const auto& [side, triangle] : sides) {
    const auto other = sides.find({side.second, side.first});
    const std::uint32_t beyond = other == sides.end() ? Lattice::none : other->second;
    const auto& t = lattice.triangles()[triangle];
    for (std::size_t i = 0; i < 3; ++i)
      if (t.corners[(i + 1) % 3] == side.first && t.beyond[i] != beyond) ++wrong_neighbours;
    if (beyond != Lattice::none) continue;
    const glm::ivec2 a = lattice.points()[side.first], b = lattice.points()[side.second];
    const bool outer =
        (a.x == b.x && (a.x == -64 || a.x == 576)) || (a.y == b.y && (a.y == -32 || a.y == 480));
    if (!outer) ++lonely; // a corner would stand on its neighbour's side
  }
  CHECK(lonely == 0);
  CHECK(wrong_neighbours == 0);
}

TEST_CASE("the points of a lattice stand once each") {
  Lattice lattice({0, 0}, {320, 256}, {320, 256});
  std::vector<std::uint32_t> changed;
  for (int i = 0; i < 300; ++i)
    if (const auto t = static_cast<std::uint32_t>(i * 7 % lattice.triangles().size());
        lattice.divisible(t, 2))
      lattice.bisect(t, changed);
  std::map<std::pair<int, int>, int> seen;
  for (const glm::ivec2& point : lattice.points()) CHECK(++seen[{point.x, point.y}] == 1);
  // As far as whole pixels go: 5 × 4.
  for (int i = 0; i < 100'000 && lattice.divisible(0, 2); ++i) lattice.bisect(0, changed);
  CHECK_FALSE(lattice.divisible(0, 2));
}
