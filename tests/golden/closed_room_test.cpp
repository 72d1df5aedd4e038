// Inside a closed room no view may show the background, whatever the projection and the method: a single
// pixel would be a hole. And nothing flickers when the camera creeps.
//
// closed_room_test; with CUPOLA_VIEWS=N from that many random views a way, and then with every sample count
// that the driver has: ./dev soak holes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "renderer/passes/targets.h"
#include "tests/support/drawing.h"

using namespace cupola;
using namespace cupola::tests;

namespace {

int views() {
  const char* given = std::getenv("CUPOLA_VIEWS");
  return given != nullptr ? std::max(1, std::atoi(given)) : 50;
}

/// Sample counts to try: 1 and the driver's largest, or all it has.
std::vector<int> sample_counts() {
  std::vector<int> counts{1};
  const bool all = std::getenv("CUPOLA_VIEWS") != nullptr;
  (void)renderer();
  for (int wanted : {2, 4, 8, 16, 32}) {
    const int have = passes::clamp_samples(wanted);
    if (have == counts.back()) continue;
    if (!all && counts.size() > 1) counts.pop_back();
    counts.push_back(have);
  }
  return counts;
}

struct Named {
  std::string name;
  model::Shape shape;
  double zoom = 1.0;
};

/// Every kind, and what is hard about it: rims, poles, seams, faces that meet.
std::vector<Named> projections() {
  model::CameraTexture bent;
  bent.columns = 37;
  bent.rows = 23;
  bent.deformations["zoom"] = {model::RadialZoom{0.5}, 0.1, -0.2, 1.2, 0};
  bent.deformations["swirl"] = {model::Swirl{{40.0}}, 0.0, 0.0, 1.0, 1};
  return {{"cylinder 360", model::Cylinder{{360.0}, {134.0}}},
          {"cylinder 220", model::Cylinder{{220.0}, {100.0}}},
          {"perspective", model::Perspective{{90.0}, std::nullopt}},
          {"fisheye 180", model::Fisheye{{180.0}}},
          {"fisheye 300", model::Fisheye{{300.0}}},
          {"fisheye 360", model::Fisheye{{360.0}}},
          {"fisheye 180, zoomed", model::Fisheye{{180.0}}, 1.7},
          {"equirectangular", model::Equirectangular{{360.0}, {180.0}}},
          {"equirectangular, more than a turn", model::Equirectangular{{360.0}, {180.0}}, 0.8},
          {"stereographic", model::Stereographic{{240.0}}},
          {"orthographic", model::Orthographic{{180.0}}},
          {"mercator", model::Mercator{{360.0}, {150.0}}},
          {"panini", model::Panini{}},
          {"cube cross", model::CubeCross{}},
          {"camera texture", bent}};
}

model::Show room_show(const Named& named, model::Method method, int samples) {
  model::Projection projection;
  projection.shape = named.shape;
  projection.zoom = named.zoom;
  model::Show show = make_show(model::Room{}, projection, method, 320, 240);
  show.quality.samples = samples;
  if (method == model::Method::cubemap) show.quality.cubemap_size = 128;
  return show;
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

long holes_in_views(model::Show show, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto draw_number = [&](double scale) { return scale * unit(random); };
  long found = 0;
  for (int view = 0; view < count; ++view) {
    const double x = draw_number(4.5), y = draw_number(4.5), z = draw_number(4.5);
    const double yaw = draw_number(180.0), pitch = draw_number(90.0), roll = draw_number(180.0);
    show.camera.position = {x, y, z};
    show.camera.orientation = {{yaw}, {pitch}, {roll}};
    found += holes(show);
  }
  return found;
}

} // namespace

TEST_CASE("no background pixel in random views from inside a closed room: pieces") {
  for (const int samples : sample_counts())
    for (const model::Engine engine : {model::Engine::cpu, model::Engine::gpu})
      for (const Named& named : projections()) {
        CAPTURE(named.name);
        CAPTURE(samples);
        CAPTURE(engine == model::Engine::gpu);
        model::Show show = room_show(named, model::Method::piecewise, samples);
        show.pieces.engine = engine;
        CHECK(holes_in_views(show, views()) == 0);
      }
}

TEST_CASE("no background pixel in random views from inside a closed room: cubemap") {
  for (const int samples : sample_counts())
    for (const bool single_pass : {false, true})
      for (const Named& named : {Named{"cylinder 360", model::Cylinder{{360.0}, {134.0}}},
                                 Named{"equirectangular", model::Equirectangular{{360.0}, {180.0}}}}) {
        CAPTURE(named.name);
        CAPTURE(samples);
        CAPTURE(single_pass);
        model::Show show = room_show(named, model::Method::cubemap, samples);
        show.quality.cubemap_single_pass = single_pass;
        CHECK(holes_in_views(show, views()) == 0);
      }
}

TEST_CASE("the test can see a hole") {
  model::Show show = room_show({"", model::Cylinder{{360.0}, {134.0}}}, model::Method::piecewise, 1);
  show.camera.position = {0.0, 0.0, 20.0}; // outside: backs of walls are not drawn, the far walls' fronts are
  const long found = holes(show);
  CHECK(found > 320 * 240 / 2);
  CHECK(found < 320 * 240);
}

TEST_CASE("nothing flickers while the camera turns by a hundredth of a pixel a frame") {
  constexpr int frames = 24, jump = 40, same = 8; // of 255: what is seen, and what is not
  // Corners are snapped to 1/256 pixel, so that an edge may step back by a hair: a pixel or two in all
  // frames.
  constexpr long allowed = 3 * 3;
  for (const Named& named : projections()) {
    CAPTURE(named.name);
    model::Show show = room_show(named, model::Method::piecewise, 1);
    std::array<Shot, 3> last;
    long flickers = 0, changes = 0;
    for (int frame = 0; frame < frames; ++frame) {
      show.camera.position = {1.3, -0.7, 0.9};
      show.camera.orientation = {{17.0 + 0.005 * frame}, {9.0}, {3.0}};
      std::rotate(last.begin(), last.begin() + 1, last.end());
      last[2] = draw(show);
      if (frame < 2) continue;
      for (std::size_t i = 0; i < last[2].rgba.size(); ++i) {
        const int before = last[0].rgba[i], now = last[1].rgba[i], after = last[2].rgba[i];
        changes += now != before ? 1 : 0;
        if (std::abs(now - before) > jump && std::abs(now - after) > jump && std::abs(after - before) < same)
          ++flickers;
      }
    }
    CHECK(changes > 0); // it does move
    CHECK(flickers <= allowed);
  }
}
