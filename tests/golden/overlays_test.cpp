// What is drawn over pictures to show how they come about: borders of pieces, edges of triangles.
#include <array>
#include <cstddef>
#include <doctest/doctest.h>
#include <utility>
#include <vector>

#include "renderer/plan/plan.h"
#include "tests/support/drawing.h"

using namespace cupola;
using tests::Shot;

namespace {

model::Show room(const model::Shape& shape, model::Method method) {
  model::Projection projection;
  projection.shape = shape;
  projection.orientation = {{20.0}, {10.0}, {}};
  model::Show show = tests::make_show(model::Room{}, projection, method, 200, 120);
  show.camera.position = {0.5, 0.3, 0.2};
  return show;
}

std::array<int, 3> at(const Shot& shot, std::size_t pixel) {
  return {shot.rgba[4 * pixel], shot.rgba[4 * pixel + 1], shot.rgba[4 * pixel + 2]};
}

int sum(const std::array<int, 3>& color) { return color[0] + color[1] + color[2]; }

std::size_t pixels(const Shot& shot) { return shot.rgba.size() / 4; }

} // namespace

TEST_CASE("borders of strips are black columns, and nothing else changes") {
  for (const auto& way :
       {std::pair{model::Engine::cpu, 1}, {model::Engine::gpu, 1}, {model::Engine::cpu, 2}}) {
    const model::Engine engine = way.first;
    const int supersampling = way.second;
    CAPTURE(int(engine));
    CAPTURE(supersampling);
    model::Show show = room(model::Cylinder{{200.0}, {80.0}}, model::Method::piecewise);
    show.pieces.engine = engine;
    show.quality.supersampling = supersampling;
    const auto planned = plan::make_plan(show);
    REQUIRE(planned);
    const auto& strips = planned->plan.outputs[0].viewports[0].pieces->pieces;
    REQUIRE(strips.size() > 3);
    std::vector<bool> border(200, false);
    for (std::size_t i = 1; i < strips.size(); ++i)
      border[static_cast<std::size_t>(strips[i].bounds.x)] = true;
    const Shot plain = tests::draw(show);
    show.debug.pieces = true;
    const Shot lined = tests::draw(show);
    long wrong = 0;
    for (std::size_t i = 0; i < pixels(plain); ++i)
      if (at(lined, i) != (border[i % 200] ? std::array{0, 0, 0} : at(plain, i))) ++wrong;
    CHECK(wrong == 0);
  }
}

TEST_CASE("borders of triangles are black, few pixels wide, and within their viewport") {
  model::Show show = room(model::Fisheye{}, model::Method::piecewise);
  auto& viewport = show.outputs["main"].viewports["all"];
  viewport.x = 0.25;
  viewport.width = 0.75;
  const Shot plain = tests::draw(show);
  show.debug.pieces = true;
  const Shot lined = tests::draw(show);
  long black = 0, other = 0, beside = 0;
  for (std::size_t i = 0; i < pixels(plain); ++i) {
    if (at(lined, i) == at(plain, i)) continue;
    ++(sum(at(lined, i)) == 0 ? black : other);
    if (i % 200 < 50) ++beside;
  }
  CHECK(other == 0);
  CHECK(beside == 0);
  CHECK(black > 500);
  CHECK(black < 150 * 120 / 2);
}

TEST_CASE("edges of triangles are white over the picture, by every method and engine") {
  for (const model::Shape& shape : {model::Shape(model::Fisheye{}), model::Shape(model::Cylinder{}),
                                    model::Shape(model::Perspective{{100.0}, {}})})
    for (const auto& way : {std::pair{model::Method::piecewise, model::Engine::cpu},
                            {model::Method::piecewise, model::Engine::gpu},
                            {model::Method::cubemap, model::Engine::cpu}}) {
      const model::Method method = way.first;
      const model::Engine engine = way.second;
      CAPTURE(shape.index());
      CAPTURE(int(method));
      CAPTURE(int(engine));
      model::Show show = room(shape, method);
      show.pieces.engine = engine;
      const Shot plain = tests::draw(show);
      show.debug.primitives = true;
      const Shot lined = tests::draw(show);
      long white = 0, brighter = 0, darker = 0;
      for (std::size_t i = 0; i < pixels(plain); ++i) {
        const int change = sum(at(lined, i)) - sum(at(plain, i));
        if (change > 6) ++brighter;
        if (change < -6) ++darker;
        if (change > 6 && sum(at(lined, i)) > 3 * 250) ++white;
      }
      CHECK(darker == 0);
      CHECK(white > 200);
      CHECK(brighter < 200 * 120 / 2);
    }
}

TEST_CASE("without pieces there are no borders") {
  model::Show show = room(model::Fisheye{}, model::Method::cubemap);
  const Shot plain = tests::draw(show);
  show.debug.pieces = true;
  CHECK(tests::draw(show).rgba == plain.rgba);
}
