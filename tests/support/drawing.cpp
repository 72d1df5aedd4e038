#include "tests/support/drawing.h"

#include <cmath>
#include <doctest/doctest.h>

namespace cupola::tests {

namespace {
frame::FrameStatistics statistics;
}

cli::OfflineRenderer& renderer() {
  static model::Result<cli::OfflineRenderer> made = cli::make_offline_renderer();
  if (!made) {
    cli::print_problems(made.error());
    FAIL("no headless renderer");
  }
  return *made;
}

model::Show make_show(model::Content content, const model::Projection& projection, model::Method method,
                      int width, int height) {
  model::Show show;
  show.scene.content = std::move(content);
  show.projections["it"] = projection;
  model::Output output;
  output.sink = model::HeadlessOutput{};
  output.width = width;
  output.height = height;
  output.viewports["all"] = {"it", method, 0, 0, 1, 1, 0};
  show.outputs["main"] = output;
  return show;
}

Shot draw(const model::Show& show, double time) {
  static model::Content last_content;
  static std::shared_ptr<const content::Scene> last_scene;
  if (!(last_content == show.scene.content)) last_scene = nullptr;
  auto stage = cli::make_stage(show, ".", last_scene, cli::Warnings::dropped);
  if (!stage) {
    cli::print_problems(stage.error());
    FAIL("the show cannot be drawn");
  }
  last_content = show.scene.content;
  last_scene = (*stage)->scene;
  frame::Renderer& drawer = *renderer().renderer;
  drawer.set_stage(*stage);
  statistics = drawer.draw(time);
  const model::Problems problems = drawer.take_problems();
  cli::print_problems(problems);
  REQUIRE(problems.empty());
  outputs::ByteImage image = cli::read_picture(drawer.pictures().front());
  return {image.width, image.height, std::move(image.rgba)};
}

const frame::FrameStatistics& last_statistics() { return statistics; }

long count_pixels(const Shot& shot, int red, int green, int blue) {
  long count = 0;
  for (std::size_t i = 0; i + 3 < shot.rgba.size(); i += 4)
    if (shot.rgba[i] == red && shot.rgba[i + 1] == green && shot.rgba[i + 2] == blue) ++count;
  return count;
}

double psnr(const Shot& a, const Shot& b) {
  REQUIRE(a.rgba.size() == b.rgba.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const double difference = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
    sum += difference * difference;
  }
  const double mean = sum / (static_cast<double>(a.rgba.size()) * 0.75);
  return mean == 0.0 ? 999.0 : 10.0 * std::log10(255.0 * 255.0 / mean);
}

} // namespace cupola::tests
