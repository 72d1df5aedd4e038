// Both engines of the piecewise method draw the same picture, whatever the projection.
#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/drawing.h"

using namespace cupola;
using namespace cupola::tests;

namespace {

struct Case {
  std::string name;
  model::Projection projection;
  int width, height;
};

std::vector<Case> cases() {
  const std::vector<std::pair<std::string, model::Shape>> shapes{
      {"fisheye", model::Fisheye{{180.0}}},
      {"fisheye-wide", model::Fisheye{{300.0}}},
      {"equirectangular", model::Equirectangular{{360.0}, {180.0}}},
      {"stereographic", model::Stereographic{{240.0}}},
      {"orthographic", model::Orthographic{{180.0}}},
      {"mercator", model::Mercator{{360.0}, {140.0}}},
      {"panini", model::Panini{{200.0}, std::nullopt, 1.0}},
      {"cube-cross", model::CubeCross{}}};
  std::vector<Case> all;
  for (const auto& [name, shape] : shapes) {
    all.push_back({name, {}, 360, 270});
    all.back().projection.shape = shape;
  }
  all.push_back(all.front());
  all.back().name = "fisheye, turned and off its axis";
  all.back().projection.off_axis = {0.3, 0.1, -0.2};
  all.back().projection.orientation = {{40.0}, {60.0}, {8.0}};
  all.back().projection.zoom = 1.25;
  return all;
}

model::Show show_of(const Case& it, model::Engine engine) {
  model::Show show = make_show(model::City{}, it.projection, model::Method::piecewise, it.width, it.height);
  show.camera.position = {4.0, 9.0, 6.0};
  show.camera.orientation.yaw.degrees = 20.0;
  show.scene.fog.density = 0.002;
  show.pieces.engine = engine;
  return show;
}

} // namespace

TEST_CASE("the GPU engine draws what the CPU engine draws") {
  for (const Case& it : cases()) {
    CAPTURE(it.name);
    const Shot cpu = draw(show_of(it, model::Engine::cpu));
    const auto cpu_pairs = static_cast<double>(last_statistics().replicated);
    const model::Show show = show_of(it, model::Engine::gpu);
    const double first = psnr(cpu, draw(show)), second = psnr(cpu, draw(show));
    static_cast<void>(draw(show)); // counts come a frame late
    const auto gpu_pairs = static_cast<double>(last_statistics().replicated);
    MESSAGE(it.name << ": " << first << " dB; pairs of the CPU " << cpu_pairs << ", of the GPU "
                    << gpu_pairs);
    CHECK(first > 50.0);
    CHECK(second > 50.0);
    CHECK(gpu_pairs >= 0.99 * cpu_pairs); // which may count slivers, and leaves out what others hide
  }
}

TEST_CASE("the engines agree in samples and in lines") {
  const Case it = cases().front();
  for (const bool wireframe : {false, true}) {
    CAPTURE(wireframe);
    model::Show show = show_of(it, model::Engine::cpu);
    show.scene.style.kind = wireframe ? model::StyleKind::wireframe : model::StyleKind::textured;
    show.quality.samples = wireframe ? 1 : 4;
    show.quality.supersampling = wireframe ? 2 : 1;
    const Shot cpu = draw(show);
    show.pieces.engine = model::Engine::gpu;
    CHECK(psnr(cpu, draw(show)) > 50.0);
  }
}
