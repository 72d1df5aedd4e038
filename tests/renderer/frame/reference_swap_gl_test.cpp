// A running show that turns to the reference method goes on as it was until the rays are traced.
#include <chrono>
#include <doctest/doctest.h>
#include <thread>

#include "tests/support/drawing.h"

using namespace cupola;

namespace {

std::shared_ptr<const frame::Stage> stage_of(const model::Show& show, std::uint64_t revision,
                                             const std::shared_ptr<const frame::Stage>& before) {
  auto made = cli::make_stage(show, ".", before ? before->scene : nullptr);
  REQUIRE(made);
  auto stage = std::make_shared<frame::Stage>(**made);
  stage->revision = revision;
  return stage;
}

tests::Shot shot_of(const frame::Renderer& renderer) {
  outputs::ByteImage image = cli::read_picture(renderer.pictures().front());
  return {image.width, image.height, std::move(image.rgba)};
}

/// Draws until `revision` is shown; no picture on the way is black.
tests::Shot show(frame::Renderer& renderer, std::uint64_t revision) {
  for (int frame = 0; frame < 10'000; ++frame) {
    const std::uint64_t drawn = renderer.draw(0.0).revision;
    tests::Shot shot = shot_of(renderer);
    CHECK(tests::count_pixels(shot, 0, 0, 0) == 0);
    if (drawn == revision) return shot;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  FAIL("the revision is never shown");
  return {};
}

} // namespace

TEST_CASE("no black picture, and no old one, on the way to the reference method and back") {
  const auto context = outputs::Context::make_headless([](outputs::MessageLevel, std::string_view) {});
  REQUIRE(context);
  REQUIRE((*context)->make_current());
  const auto renderer = frame::Renderer::make();
  REQUIRE(renderer);
  model::Projection projection;
  projection.shape = model::Equirectangular{};
  model::Show wanted = tests::make_show(model::Room{}, projection, model::Method::cubemap, 96, 48);
  std::shared_ptr<const frame::Stage> stage;
  const auto turn_to = [&](model::Method method, std::uint64_t revision) {
    wanted.outputs["main"].viewports["all"].method = method;
    stage = stage_of(wanted, revision, stage);
    (*renderer)->set_stage(stage);
    return show(**renderer, revision);
  };
  const tests::Shot cubemap = turn_to(model::Method::cubemap, 1);
  const tests::Shot traced = turn_to(model::Method::reference, 2);
  CHECK(tests::psnr(traced, cubemap) > 20.0);
  turn_to(model::Method::cubemap, 3);
  wanted.camera.orientation.yaw.degrees = 90.0;
  const tests::Shot turned = turn_to(model::Method::cubemap, 4);
  const tests::Shot traced_again = turn_to(model::Method::reference, 5);
  CHECK(tests::psnr(traced_again, turned) > 20.0);
  CHECK(tests::psnr(traced_again, traced) < 20.0);
}
