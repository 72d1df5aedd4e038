// /quality/automatic from show to picture; how it chooses is quality_choice_test.cpp's affair.
#include <doctest/doctest.h>
#include <epoxy/gl.h>

#include "renderer/frame/automatic_quality.h"
#include "renderer/frame/draw_timer.h"
#include "tests/support/drawing.h"

using namespace cupola;

namespace {

model::Show room(model::Method method) {
  model::Projection projection;
  projection.shape = model::Cylinder{{200.0}, {70.0}};
  model::Show show = tests::make_show(model::Room{}, projection, method, 96, 48);
  show.quality.automatic = true;
  return show;
}

tests::Shot shot_of(const frame::Renderer& renderer) {
  outputs::ByteImage image = cli::read_picture(renderer.pictures().front());
  return {image.width, image.height, std::move(image.rgba)};
}

struct Headless {
  std::unique_ptr<outputs::Context> context;
  std::unique_ptr<frame::Renderer> renderer;
};

Headless headless(bool offline) {
  auto context = outputs::Context::make_headless([](outputs::MessageLevel, std::string_view) {});
  REQUIRE(context);
  REQUIRE((*context)->make_current());
  frame::RendererOptions options;
  options.offline = offline;
  auto renderer = frame::Renderer::make(options);
  REQUIRE(renderer);
  return {std::move(*context), std::move(*renderer)};
}

std::shared_ptr<const frame::Stage> stage_of(const model::Show& show) {
  auto made = cli::make_stage(show, ".");
  REQUIRE(made);
  return *made;
}

std::vector<frame::QualityLevel> ladder_of(const frame::Renderer& renderer) {
  return frame::quality_ladder(renderer.device().max_anisotropy, renderer.device().max_samples, 3,
                               renderer.device().software);
}

} // namespace

TEST_CASE("off-line the best there is, and the picture as if it had been asked for") {
  const Headless made = headless(true);
  for (const model::Method method : {model::Method::piecewise, model::Method::cubemap}) {
    model::Show show = room(method);
    made.renderer->set_stage(stage_of(show));
    const frame::QualityLevel level = made.renderer->draw(0.0).quality;
    CHECK(level == ladder_of(*made.renderer).back());
    const tests::Shot chosen = shot_of(*made.renderer);
    show.quality = {};
    show.quality.anisotropy = level.anisotropy;
    show.quality.samples = level.samples;
    show.quality.supersampling = level.supersampling;
    made.renderer->set_stage(stage_of(show));
    CHECK(made.renderer->draw(0.0).quality == level);
    // The cubemap's faces are three times what one sample a pixel needs, rounded before, not after.
    CHECK(tests::psnr(chosen, shot_of(*made.renderer)) > (method == model::Method::piecewise ? 50.0 : 40.0));
  }
}

TEST_CASE("a running show climbs while there is time, level by level the same view") {
  const Headless made = headless(false);
  model::Show show = room(model::Method::automatic);
  show.frame_rate = 1.0; // a whole second for a picture that takes thousandths of it
  made.renderer->set_stage(stage_of(show));
  made.renderer->draw(0.0);
  const tests::Shot plain = shot_of(*made.renderer);
  const std::vector<frame::QualityLevel> ladder = ladder_of(*made.renderer);
  std::vector<frame::QualityLevel> seen{ladder.front()};
  for (int i = 0; i < 300 && seen.back() != ladder.back(); ++i) {
    const frame::QualityLevel level = made.renderer->draw(0.0).quality;
    if (level == seen.back()) continue;
    seen.push_back(level);
    CHECK(tests::psnr(shot_of(*made.renderer), plain) > 25.0);
  }
  CHECK(seen == ladder);
  show.quality.automatic = false;
  made.renderer->set_stage(stage_of(show));
  while (made.renderer->draw(0.0).uploading) {}
  CHECK(made.renderer->draw(0.0).quality == frame::QualityLevel{1, 1, 1});
}

TEST_CASE("no level asks for more than the driver and its memory have") {
  const auto best = [](int width, int height, const frame::Device& device) {
    model::Show show = room(model::Method::piecewise);
    show.outputs["main"].width = width;
    show.outputs["main"].height = height;
    const auto stage = stage_of(show);
    frame::AutomaticQuality automatic(device, true);
    automatic.restart(*stage);
    const model::Quality quality = automatic.of(*stage);
    return frame::QualityLevel{quality.anisotropy, quality.samples, quality.supersampling};
  };
  const frame::Device device{"", "", true, 8, 16, 16384};
  CHECK(best(1024, 1024, device) == frame::QualityLevel{16, 4, 3});
  CHECK(best(4096, 4096, device) == frame::QualityLevel{16, 4, 2}); // three times: 4.5 GiB
  CHECK(best(8192, 8192, device) == frame::QualityLevel{16, 4, 1});
  CHECK(best(4096, 4096, {"", "", true, 8, 16, 4096}) == frame::QualityLevel{16, 8, 1});
  CHECK(best(1024, 1024, {"", "", true, 1, 1, 4096}) == frame::QualityLevel{1, 1, 3});
}

TEST_CASE("timer queries: a frame's time comes once, when it is there; forgotten ones never come") {
  const Headless made = headless(false);
  const gl::Texture picture = gl::Texture::make(GL_TEXTURE_2D);
  glTextureStorage2D(picture.id(), 1, GL_RGBA8, 256, 256);
  frame::DrawTimer timer(false);
  const auto draw = [&](int frames, double beside_ms) {
    for (int i = 0; i < frames; ++i) {
      timer.begin();
      glClearTexImage(picture.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
      timer.end(beside_ms);
    }
    glFinish();
  };
  const auto taken = [&] {
    int count = 0;
    while (const auto milliseconds = timer.take()) {
      CHECK(*milliseconds >= 5000.0); // the processor's share is the longer one here
      ++count;
    }
    return count;
  };
  draw(3, 5000.0);
  CHECK(taken() == 3);
  CHECK(taken() == 0);
  draw(6, 5000.0); // more than are kept on their way: the latest are not timed
  CHECK(taken() == 4);
  draw(2, 5000.0);
  timer.forget();
  CHECK(taken() == 0);
  draw(2, 5000.0);
  CHECK(taken() == 2);
  CHECK(glGetError() == GL_NO_ERROR);
}
