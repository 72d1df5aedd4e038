// Inside a closed room no view may show the background, whatever the method: a single pixel would be a hole.
#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/support/drawing.h"

using namespace cupola;
using namespace cupola::tests;

namespace {

struct Way {
  std::string name;
  model::Shape shape;
  model::Method method;
  model::Engine engine;
  int samples;
  bool single_pass;
};

std::vector<Way> ways() {
  const model::Cylinder round{{360.0}, {134.0}}, part{{220.0}, {100.0}};
  const model::Perspective flat{{90.0}, std::nullopt};
  const model::Equirectangular whole{{360.0}, {180.0}};
  const model::Fisheye dome{{180.0}}, wide{{270.0}};
  using enum model::Method;
  return {{"cylinder 360, cpu", round, piecewise, model::Engine::cpu, 1, false},
          {"cylinder 360, gpu", round, piecewise, model::Engine::gpu, 1, false},
          {"cylinder 360, cpu, multisampled", round, piecewise, model::Engine::cpu, 4, false},
          {"cylinder 360, gpu, multisampled", round, piecewise, model::Engine::gpu, 4, false},
          {"cylinder 220, cpu", part, piecewise, model::Engine::cpu, 1, false},
          {"cylinder 220, gpu", part, piecewise, model::Engine::gpu, 1, false},
          {"perspective", flat, piecewise, model::Engine::automatic, 1, false},
          {"fisheye 180, cpu", dome, piecewise, model::Engine::cpu, 1, false},
          {"fisheye 180, gpu", dome, piecewise, model::Engine::gpu, 1, false},
          {"fisheye 180, gpu, multisampled", dome, piecewise, model::Engine::gpu, 4, false},
          {"fisheye 270, gpu", wide, piecewise, model::Engine::gpu, 1, false},
          {"equirectangular, gpu", whole, piecewise, model::Engine::gpu, 1, false},
          {"cylinder 360, cubemap", round, cubemap, model::Engine::automatic, 1, false},
          {"equirectangular, cubemap", whole, cubemap, model::Engine::automatic, 1, false},
          {"equirectangular, cubemap, single pass", whole, cubemap, model::Engine::automatic, 1, true},
          {"equirectangular, cubemap, multisampled", whole, cubemap, model::Engine::automatic, 4, false}};
}

/// Pixels that have any of the background in them: drawn twice, before black and before white, they differ.
long holes(model::Show show) {
  show.background = {0.0, 0.0, 0.0};
  const Shot black = draw(show);
  show.background = {1.0, 1.0, 1.0};
  const Shot white = draw(show);
  long count = 0;
  for (std::size_t i = 0; i + 3 < black.rgba.size(); i += 4)
    if (black.rgba[i] != white.rgba[i] || black.rgba[i + 1] != white.rgba[i + 1] ||
        black.rgba[i + 2] != white.rgba[i + 2])
      ++count;
  return count;
}

} // namespace

TEST_CASE("no background pixel in a hundred views from inside a closed room") {
  for (const Way& way : ways()) {
    CAPTURE(way.name);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    long found = 0;
    for (int view = 0; view < 100; ++view) {
      model::Projection projection;
      projection.shape = way.shape;
      model::Show show = make_show(model::Room{}, projection, way.method, 320, 240);
      show.pieces.engine = way.engine;
      show.quality.samples = way.samples;
      show.quality.cubemap_single_pass = way.single_pass;
      if (way.method == model::Method::cubemap) show.quality.cubemap_size = 128;
      show.camera.position = {4.5 * unit(random), 4.5 * unit(random), 4.5 * unit(random)};
      show.camera.orientation = {{180.0 * unit(random)}, {90.0 * unit(random)}, {180.0 * unit(random)}};
      found += holes(show);
    }
    CHECK(found == 0);
  }
}

TEST_CASE("the test can see a hole") {
  model::Projection projection;
  projection.shape = model::Cylinder{{360.0}, {134.0}};
  model::Show show = make_show(model::Room{}, projection, model::Method::piecewise, 320, 240);
  show.camera.position = {0.0, 0.0, 20.0}; // outside: backs of walls are not drawn, the far walls' fronts are
  const long found = holes(show);
  CHECK(found > 320 * 240 / 2);
  CHECK(found < 320 * 240);
}
