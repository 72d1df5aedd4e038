// Every projection by every method: against a stored picture, and against the reference method, which
// computes each pixel by rays and knows nothing of pieces, cubemaps or GL.
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
  bool piecewise;
  double min_psnr; ///< of the methods against the reference
};

model::Projection shaped(model::Shape shape) {
  model::Projection projection;
  projection.shape = std::move(shape);
  return projection;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"perspective", shaped(model::Perspective{{80.0}, std::nullopt}), 320, 240, true, 25.0});
  all.push_back({"cylinder", shaped(model::Cylinder{{360.0}, {134.0}}), 400, 300, true, 24.0});
  Case turned{"cylinder-turned", shaped(model::Cylinder{{200.0}, {70.0}}), 400, 200, true, 24.0};
  turned.projection.zoom = 1.25;
  turned.projection.off_axis = {0.3, 0.1, -0.2};
  turned.projection.orientation = {{40.0}, {-12.0}, {8.0}};
  all.push_back(turned);
  all.push_back({"fisheye", shaped(model::Fisheye{{180.0}}), 300, 240, false, 24.0});
  all.back().projection.orientation.pitch.degrees = 90.0;
  all.push_back({"fisheye-wide", shaped(model::Fisheye{{270.0}}), 256, 256, false, 24.0});
  all.push_back({"equirectangular", shaped(model::Equirectangular{{360.0}, {180.0}}), 400, 200, false, 24.0});
  all.push_back({"stereographic", shaped(model::Stereographic{{240.0}}), 300, 240, false, 24.0});
  all.back().projection.orientation.pitch.degrees = -90.0; // a small planet
  all.push_back({"orthographic", shaped(model::Orthographic{{180.0}}), 300, 240, false, 24.0});
  all.push_back({"mercator", shaped(model::Mercator{{360.0}, {140.0}}), 360, 200, false, 24.0});
  all.push_back({"panini", shaped(model::Panini{{200.0}, std::nullopt, 1.0}), 400, 200, false, 24.0});
  Case leaning{"panini-turned", shaped(model::Panini{{150.0}, std::nullopt, 0.6}), 300, 200, false, 24.0};
  leaning.projection.off_axis = {0.3, 0.1, -0.2};
  leaning.projection.orientation = {{-30.0}, {10.0}, {-8.0}};
  all.push_back(leaning);
  model::CameraTexture texture;
  texture.columns = texture.rows = 12;
  texture.deformations["bulge"] = {model::RadialZoom{0.6}, 0.0, 0.0, 0.9, 0};
  texture.deformations["turn"] = {model::Swirl{{60.0}}, 0.0, 0.0, 0.8, 1};
  all.push_back({"camera-texture", shaped(texture), 320, 240, true, 24.0});
  texture.deformations = {{"rings", {model::Ripple{0.12, 0.5}, 0.2, -0.1, 0.8, 0}}};
  texture.columns = texture.rows = 40;
  Case folded{"camera-texture-folded", shaped(texture), 320, 240, true, 24.0};
  folded.projection.zoom = 1.2;
  folded.projection.off_axis = {0.2, 0.1, -0.2};
  folded.projection.orientation = {{15.0}, {5.0}, {-8.0}};
  all.push_back(folded);
  all.push_back({"cube-cross", shaped(model::CubeCross{}), 400, 300, false, 24.0});
  return all;
}

model::Show show_of(const Case& it, model::Method method) {
  model::Show show = make_show(model::City{}, it.projection, method, it.width, it.height);
  show.camera.position = {4.0, 9.0, 6.0};
  show.camera.orientation.yaw.degrees = 20.0;
  show.scene.fog.density = 0.002;
  show.quality.samples = 4;
  return show;
}

constexpr const char* gl_reason =
    "rounding of the rasteriser and texture filter, one or two steps apart between drivers";

} // namespace

// Stands first, cubemap first: what a style binds must be there in the first draw of a program, with nothing
// left behind by other passes.
TEST_CASE("styles keep their widths in output pixels") {
  const Case it = cases()[1];
  for (const model::StyleKind style : {model::StyleKind::wireframe, model::StyleKind::hatching}) {
    const std::string name = style == model::StyleKind::wireframe ? "wireframe" : "hatching";
    for (const auto& [method, word] : {std::pair{model::Method::cubemap, "cubemap"},
                                       {model::Method::piecewise, "piecewise"},
                                       {model::Method::reference, "reference"}}) {
      model::Show show = show_of(it, method);
      show.scene.style.kind = style;
      show.quality.samples = method == model::Method::reference ? 16 : 1;
      expect_image(draw(show), "styles/" + name + "-" + word + ".png", {6, 0.01, gl_reason});
    }
  }
}

TEST_CASE("every projection by every method looks as it did") {
  for (const Case& it : cases()) {
    CAPTURE(it.name);
    model::Show reference = show_of(it, model::Method::reference);
    reference.quality.samples = 16;
    const Shot traced = draw(reference);
    expect_image(traced, it.name + "/reference.png",
                 {2, 0.002, "float rounding of the ray intersections differs between processors"});
    const Shot cubemap = draw(show_of(it, model::Method::cubemap));
    expect_image(cubemap, it.name + "/cubemap.png", {4, 0.004, gl_reason});
    MESSAGE(it.name << ": cubemap against reference " << psnr(cubemap, traced) << " dB");
    CHECK(psnr(cubemap, traced) > it.min_psnr);
    if (!it.piecewise) continue;
    const Shot piecewise = draw(show_of(it, model::Method::piecewise));
    expect_image(piecewise, it.name + "/piecewise.png", {4, 0.004, gl_reason});
    MESSAGE(it.name << ": piecewise against reference " << psnr(piecewise, traced) << " dB");
    CHECK(psnr(piecewise, traced) > it.min_psnr);
  }
}

TEST_CASE("a fold looked up in a cubemap drawn in one pass looks as in six") {
  for (const Case& it : cases()) {
    if (it.name != "camera-texture-folded") continue;
    for (const int samples : {1, 4}) {
      CAPTURE(samples);
      model::Show show = show_of(it, model::Method::cubemap);
      show.quality.samples = samples;
      const Shot six = draw(show);
      show.quality.cubemap_single_pass = true;
      CHECK(psnr(six, draw(show)) > 50.0);
      show.quality.cubemap_single_pass = false;
      show.projections.begin()->second.zoom *= 1.5;
      CHECK(psnr(six, draw(show)) < 30.0);
    }
  }
}

TEST_CASE("both engines draw the same pieces") {
  for (const Case& it : cases()) {
    if (!it.piecewise || it.name == "perspective") continue;
    CAPTURE(it.name);
    model::Show show = show_of(it, model::Method::piecewise);
    show.pieces.engine = model::Engine::cpu;
    const Shot cpu = draw(show);
    const auto cpu_pairs = last_statistics().replicated;
    show.pieces.engine = model::Engine::gpu;
    for (int i = 0; i < 2; ++i) CHECK(psnr(cpu, draw(show)) > 50.0);
    // The GPU's counts are read back a frame late. It takes strips by azimuth alone; the CPU also leaves out
    // what is above or below the picture, and what nearer triangles cover.
    static_cast<void>(draw(show));
    const auto gpu_pairs = last_statistics().replicated;
    MESSAGE(it.name << ": pairs of the CPU " << cpu_pairs << ", of the GPU " << gpu_pairs);
    CHECK(gpu_pairs >= cpu_pairs);
    CHECK(gpu_pairs < cpu_pairs * 3);
  }
}

TEST_CASE("with too little memory for its pairs an engine loses nothing") {
  const Case it = cases()[1];
  model::Show show = show_of(it, model::Method::piecewise);
  const Shot wanted = draw(show);
  show.pieces.max_replicated = 1000;
  for (const model::Engine engine : {model::Engine::cpu, model::Engine::gpu}) {
    show.pieces.engine = engine;
    // A viewport of another name has an engine of its own, whose list has not grown yet.
    auto& viewports = show.outputs["main"].viewports;
    const model::Viewport viewport = viewports.begin()->second;
    viewports = {{"short", viewport}};
    for (int frame = 0; frame < 3; ++frame) CHECK(psnr(draw(show), wanted) > 50.0);
    CHECK(last_statistics().replicated > 1000);
  }
}
