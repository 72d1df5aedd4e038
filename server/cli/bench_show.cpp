#include "server/cli/bench_show.h"

#include <cmath>
#include <numbers>

#include "server/cli/commands.h"
#include "server/cli/offline.h"

namespace cupola::cli {

int run_bench(bool as_json, const frame::RendererOptions& options,
              const std::function<bool(frame::Renderer&, BenchReport&)>& body) {
  auto offline = make_offline_renderer(options);
  if (!offline) {
    print_problems(offline.error());
    return exit_unusable;
  }
  BenchReport report;
  report.device = device_line(*offline->renderer);
  if (!body(*offline->renderer, report)) return exit_no;
  print_report(report, as_json);
  return exit_done;
}

std::vector<model::Keyframe> round_the_city(int places) {
  std::vector<model::Keyframe> path;
  for (int i = 0; i <= places; ++i) {
    const double angle = i * 2.0 * std::numbers::pi / places;
    model::Keyframe key;
    key.time = i;
    key.position = {60.0 * std::sin(angle), 12.0 + 6.0 * std::sin(2.0 * angle), 60.0 * std::cos(angle)};
    key.orientation.yaw.degrees = std::fmod(angle * 180.0 / std::numbers::pi + 90.0, 360.0);
    path.push_back(key);
  }
  return path;
}

model::Show city_show(const model::Shape& shape, int width, int height, int places) {
  model::Show show;
  show.scene.content = model::City{};
  show.camera.loop = true;
  show.camera.path = round_the_city(places);
  show.projections["view"].shape = shape;
  model::Output output;
  output.sink = model::HeadlessOutput{};
  output.width = width;
  output.height = height;
  output.viewports["all"] = {"view", model::Method::piecewise, 0, 0, 1, 1, 0};
  show.outputs["main"] = output;
  return show;
}

model::Viewport& viewport_of(model::Show& show) { return show.outputs["main"].viewports["all"]; }

std::optional<TimedShow> time_show(frame::Renderer& renderer, const model::Show& show,
                                   std::shared_ptr<const content::Scene>& scene, const Frames& frames) {
  auto stage = make_stage(show, ".", scene);
  if (!stage) {
    print_problems(stage.error());
    return std::nullopt;
  }
  scene = (*stage)->scene;
  renderer.set_stage(*stage);
  for (int i = 0; i < frames.before; ++i) renderer.draw(0.0);
  const Timing timing = time_frames(renderer, frames.duration, frames.poses, frames.repeats);
  if (const model::Problems failed = renderer.take_problems(); !failed.empty()) {
    print_problems(failed);
    return std::nullopt;
  }
  return TimedShow{timing, *stage};
}

} // namespace cupola::cli
