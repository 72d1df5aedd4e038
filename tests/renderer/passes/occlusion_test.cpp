#include "renderer/passes/occlusion.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "renderer/passes/piece_table.h"
#include "renderer/plan/plan.h"

using namespace cupola;

namespace {

passes::PieceTable table() {
  model::Projection projection;
  projection.shape = model::Fisheye{{180.0}};
  return passes::PieceTable(*plan::make_cells(projection::make_map(projection, 1.0), {0, 0, 256, 256}, 0.25));
}

} // namespace

TEST_CASE("a group hides from the distance that the farthest of its pieces is covered to") {
  const passes::PieceTable pieces = table();
  passes::Occlusion occlusion;
  occlusion.reset(pieces);
  std::vector<float> reach(pieces.pieces().size(), std::numeric_limits<float>::infinity());
  std::mt19937 random(1);
  std::uniform_real_distribution<float> metres(1.0f, 9.0f);
  const auto check = [&] {
    for (std::uint32_t i = 0; i < pieces.groups().size(); ++i) {
      const passes::PieceTable::Group& group = pieces.groups()[i];
      const float farthest =
          *std::max_element(reach.begin() + group.first, reach.begin() + group.first + group.count);
      CHECK_FALSE(occlusion.hides_in_group(i, farthest));
      CHECK(occlusion.hides_in_group(i, farthest + 0.5f) == std::isfinite(farthest));
    }
  };
  check();
  for (const float share : {0.5f, 1.0f}) {
    for (std::uint32_t i = 0; i < share * static_cast<float>(reach.size()); ++i) {
      const float distance = metres(random);
      occlusion.cover(i, distance * 2.0f, distance);
      reach[i] = std::min(reach[i], distance);
      CHECK(occlusion.covers(i));
      CHECK(occlusion.hides(i, 20.0f));
    }
    check();
  }
  occlusion.reset(pieces);
  CHECK_FALSE(occlusion.covers(0));
  CHECK_FALSE(occlusion.hides_in_group(0, 1e30f));
}
