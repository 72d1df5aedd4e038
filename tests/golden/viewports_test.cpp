// Several viewports in one output: each shows its own projection, turned its own way, exactly as it would
// alone.
#include <doctest/doctest.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/drawing.h"

using namespace cupola;
using namespace cupola::tests;

namespace {

constexpr int side = 160;

model::Projection turned(double yaw) {
  model::Projection projection;
  projection.shape = model::Cylinder{{120.0}, {90.0}};
  projection.orientation.yaw.degrees = yaw;
  return projection;
}

model::Show base(model::Method method, model::Engine engine, int supersampling) {
  model::Show show = make_show(model::City{}, turned(0.0), method, side, side);
  show.camera.position = {4.0, 9.0, 6.0};
  show.pieces.engine = engine;
  show.quality.supersampling = supersampling;
  show.quality.cubemap_size = 128;
  return show;
}

/// The part of the picture that starts at this column and row.
Shot part(const Shot& whole, int left, int top) {
  Shot out{side, side, {}};
  for (int y = 0; y < side; ++y) {
    const auto from = whole.rgba.begin() + ((top + y) * whole.width + left) * 4;
    out.rgba.insert(out.rgba.end(), from, from + side * 4);
  }
  return out;
}

} // namespace

TEST_CASE("viewports side by side and one above the other do not share anything") {
  using enum model::Method;
  using model::Engine;
  const std::vector<std::pair<model::Method, Engine>> ways{{piecewise, Engine::cpu},
                                                           {piecewise, Engine::gpu},
                                                           {cubemap, Engine::automatic},
                                                           {reference, Engine::automatic}};
  for (const auto& way : ways)
    for (const int supersampling : {1, 2}) {
      const model::Method method = way.first;
      const model::Engine engine = way.second;
      CAPTURE(static_cast<int>(method));
      CAPTURE(static_cast<int>(engine));
      CAPTURE(supersampling);
      model::Show show = base(method, engine, supersampling);
      show.projections = {{"a", turned(0.0)}, {"b", turned(45.0)}, {"c", turned(-90.0)}};
      model::Output& output = show.outputs["main"];
      output.width = output.height = 2 * side;
      output.viewports = {{"left", {"a", method, 0.0, 0.0, 0.5, 0.5, 0}},
                          {"right", {"b", method, 0.5, 0.0, 0.5, 0.5, 0}},
                          {"below", {"c", method, 0.5, 0.5, 0.5, 0.5, 0}}};
      const Shot together = draw(show);
      const std::string reason = "the same arithmetic at another place of the picture";
      for (const auto& [yaw, left, top] : {std::tuple{0.0, 0, 0}, {45.0, side, 0}, {-90.0, side, side}}) {
        model::Show alone = base(method, engine, supersampling);
        alone.projections["it"] = turned(yaw);
        expect_same(part(together, left, top), draw(alone), "viewport", {2, 0.002, reason});
      }
      // Where no viewport is, the output is black.
      const Shot rest = part(together, 0, side);
      CHECK(count_pixels(rest, 0, 0, 0) == side * side);
    }
}

TEST_CASE("of overlapping viewports the one with the higher order is on top") {
  model::Show show = base(model::Method::piecewise, model::Engine::cpu, 1);
  show.projections = {{"a", turned(0.0)}, {"b", turned(90.0)}};
  auto& viewports = show.outputs["main"].viewports;
  viewports = {{"over", {"b", model::Method::piecewise, 0, 0, 1, 1, 2}},
               {"under", {"a", model::Method::piecewise, 0, 0, 1, 1, 1}}};
  const Shot stacked = draw(show);
  model::Show alone = base(model::Method::piecewise, model::Engine::cpu, 1);
  alone.projections["it"] = turned(90.0);
  expect_same(stacked, draw(alone), "order", {0, 0.0, "nothing differs"});
}
