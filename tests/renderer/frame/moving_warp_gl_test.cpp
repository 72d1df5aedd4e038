// A warp that changes with every frame: the pieces follow in the same frame, and none is missed.
#include <doctest/doctest.h>
#include <epoxy/gl.h>

#include "tests/support/drawing.h"

using namespace cupola;

namespace {

constexpr int frames = 24;

model::Show bent(double phase) {
  model::CameraTexture texture;
  texture.columns = 24;
  texture.rows = 16;
  texture.deformations["turn"] = {model::Swirl{{40.0 * phase}}, 0.3 * phase, 0.1, 0.6, 0};
  texture.deformations["wave"] = {model::Ripple{0.02 * phase, 0.5}, 0.0, 0.0, 0.9, 1};
  model::Projection projection;
  projection.shape = texture;
  return tests::make_show(model::Room{}, projection, model::Method::piecewise, 120, 80);
}

model::Show opening(double phase) {
  model::Projection projection;
  projection.shape = model::Fisheye{{120.0 + 100.0 * phase}};
  return tests::make_show(model::Room{}, projection, model::Method::piecewise, 96, 96);
}

std::shared_ptr<const frame::Stage> stage_of(const model::Show& show, const frame::Stage* before) {
  auto made = cli::make_stage(show, ".", before ? before->scene : nullptr, cli::Warnings::dropped);
  REQUIRE(made);
  auto stage = std::make_shared<frame::Stage>(**made);
  stage->revision = before ? before->revision + 1 : 1;
  return stage;
}

} // namespace

TEST_CASE("a warp that changes with every frame is drawn as it stands in that frame") {
  auto context = outputs::Context::make_headless([](outputs::MessageLevel, std::string_view) {});
  REQUIRE(context);
  for (const auto& show_at : {bent, opening})
    for (const model::Engine engine : {model::Engine::cpu, model::Engine::gpu}) {
      std::vector<tests::Shot> alone;
      for (int i = 0; i < frames; ++i) {
        model::Show show = show_at(double(i) / frames);
        show.pieces.engine = engine;
        alone.push_back(tests::draw(show));
      }
      REQUIRE((*context)->make_current());
      {
        auto renderer = frame::Renderer::make({}); // as a running show has it
        REQUIRE(renderer);
        std::shared_ptr<const frame::Stage> stage;
        for (int i = 0; i < frames; ++i) {
          model::Show show = show_at(double(i) / frames);
          show.pieces.engine = engine;
          stage = stage_of(show, stage.get());
          (*renderer)->set_stage(stage);
          const frame::FrameStatistics statistics = (*renderer)->draw(0.0);
          CAPTURE(i);
          CHECK(statistics.revision == stage->revision);
          REQUIRE((*renderer)->pictures().size() == 1);
          outputs::ByteImage image = cli::read_picture((*renderer)->pictures().front());
          const tests::Shot shot{image.width, image.height, std::move(image.rgba)};
          const tests::Shot& wanted = alone[static_cast<std::size_t>(i)];
          CHECK(shot.rgba == wanted.rgba);
          if (i > 0) CHECK(shot.rgba != alone[static_cast<std::size_t>(i) - 1].rgba);
        }
        CHECK((*renderer)->take_problems().empty());
      }
      REQUIRE(tests::renderer().context->make_current());
    }
}
