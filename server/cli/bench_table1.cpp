#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <epoxy/gl.h>
#include <numeric>

#include "server/cli/bench.h"
#include "server/cli/commands.h"
#include "server/cli/offline.h"

namespace cupola::cli {

namespace {

using Clock = std::chrono::steady_clock;

/// The paper's scene: a textured city of 35,000 triangles in 14 groups, 1600 × 1200, a path through it.
model::Show paper_show() {
  model::Show show;
  show.scene.content = model::City{};
  show.camera.loop = true;
  for (int i = 0; i <= 8; ++i) {
    const double angle = i * 2.0 * 3.14159265358979 / 8.0;
    model::Keyframe key;
    key.time = i;
    key.position = {60.0 * std::sin(angle), 12.0 + 6.0 * std::sin(2.0 * angle), 60.0 * std::cos(angle)};
    key.orientation.yaw.degrees = std::fmod(angle * 180.0 / 3.14159265358979 + 90.0, 360.0);
    show.camera.path.push_back(key);
  }
  model::Projection cylinder;
  cylinder.shape = model::Cylinder{{360.0}, {134.0}};
  model::Projection perspective;
  perspective.shape = model::Perspective{{75.0}, std::nullopt};
  show.projections = {{"cylinder", cylinder}, {"perspective", perspective}};
  model::Output output;
  output.sink = model::HeadlessOutput{};
  output.width = 1600;
  output.height = 1200;
  output.viewports["all"] = {"cylinder", model::Method::piecewise, 0, 0, 1, 1, 0};
  show.outputs["main"] = output;
  show.quality.cubemap_size = 2048;
  return show;
}

struct Row {
  const char* name;
  const char* projection;
  model::Method method;
  bool high_quality;
  double paper_fps; ///< 0: not in the paper
  double paper_replication;
};

constexpr Row rows[] = {
    {"plain perspective", "perspective", model::Method::piecewise, false, 0.0, 0.0},
    {"IB", "cylinder", model::Method::cubemap, false, 41.7, 0.61},
    {"PPP", "cylinder", model::Method::piecewise, false, 84.7, 1.96},
    {"IB HQ", "cylinder", model::Method::cubemap, true, 33.8, 0.61},
    {"PPP HQ", "cylinder", model::Method::piecewise, true, 54.8, 1.96},
};

struct Measured {
  double milliseconds = 0.0; ///< a frame: mean over the path of the median of the repeats
  double triangles = 0.0, replication = 0.0, buffer_kb = 0.0;
};

Measured measure(frame::Renderer& renderer, int poses, int repeats) {
  Measured sum;
  for (int pose = 0; pose < poses; ++pose) {
    const double time = 8.0 * pose / poses;
    std::vector<double> times;
    frame::FrameStatistics statistics;
    for (int i = 0; i < repeats + 1; ++i) { // the first of a pose warms caches and is not counted
      glFinish();
      const auto start = Clock::now();
      statistics = renderer.draw(time);
      glFinish();
      if (i > 0) times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                     times.end());
    sum.milliseconds += times[times.size() / 2];
    sum.triangles += static_cast<double>(statistics.drawn);
    sum.replication += static_cast<double>(statistics.replicated) / static_cast<double>(statistics.triangles);
    sum.buffer_kb += static_cast<double>(statistics.vertex_bytes) / 1024.0;
  }
  return {sum.milliseconds / poses, sum.triangles / poses, sum.replication / poses, sum.buffer_kb / poses};
}

double rounded(double value, double step) { return std::round(value / step) * step; }

} // namespace

int bench_table1(bool as_json, bool quick) {
  auto offline = make_offline_renderer();
  if (!offline) {
    print_problems(offline.error());
    return exit_unusable;
  }
  frame::Renderer& renderer = *offline->renderer;
  BenchReport report;
  report.device = renderer.device().name + ", OpenGL " + renderer.device().version;
  model::Show show = paper_show();
  std::shared_ptr<const content::Scene> scene;
  std::vector<double> milliseconds;
  double replication = 0.0;
  for (const Row& row : rows) {
    model::Viewport& viewport = show.outputs["main"].viewports["all"];
    viewport.projection = row.projection;
    viewport.method = row.method;
    show.quality.anisotropy = row.high_quality ? renderer.device().max_anisotropy : 1;
    show.quality.samples = row.high_quality ? renderer.device().max_samples : 1;
    auto stage = make_stage(show, ".", scene);
    if (!stage) {
      print_problems(stage.error());
      return exit_no;
    }
    scene = (*stage)->scene;
    renderer.set_stage(*stage);
    // A software rasteriser takes seconds for a frame of high quality: few of them have to do.
    const bool slow = row.high_quality && renderer.device().software;
    const int poses = quick ? 2 : (slow ? 3 : 12), repeats = quick || slow ? 1 : 5;
    if (!as_json) std::fprintf(stderr, "%s: %d poses × %d frames\n", row.name, poses, repeats);
    const Measured measured = measure(renderer, poses, repeats);
    if (model::Problems failed = renderer.take_problems(); !failed.empty()) {
      print_problems(failed);
      return exit_no;
    }
    milliseconds.push_back(measured.milliseconds);
    const bool piecewise =
        row.method == model::Method::piecewise && std::string(row.projection) == "cylinder";
    if (piecewise && !row.high_quality) replication = measured.replication;
    const double ratio = piecewise
                             ? measured.replication
                             : measured.triangles / static_cast<double>(scene->geometry.indices.size() / 3);
    report.rows.push_back(
        {{"method", row.name},
         {"fps", rounded(1000.0 / measured.milliseconds, 0.01)},
         {"ms", rounded(measured.milliseconds, 0.01)},
         {"av. triangles", std::llround(measured.triangles)},
         {"av. replication", rounded(ratio, 0.001)},
         {"buffers kB", std::llround(measured.buffer_kb)},
         {"paper fps", row.paper_fps > 0 ? nlohmann::ordered_json(row.paper_fps) : nullptr},
         {"paper replication", row.paper_fps > 0 ? nlohmann::ordered_json(row.paper_replication) : nullptr}});
  }
  report.ratios = {{"ppp_over_ib", rounded(milliseconds[1] / milliseconds[2], 0.001)},
                   {"ppp_hq_over_ib_hq", rounded(milliseconds[3] / milliseconds[4], 0.001)},
                   {"ppp_time_over_plain", rounded(milliseconds[2] / milliseconds[0], 0.001)},
                   {"replication", rounded(replication, 0.001)}};
  report.notes = {"1600x1200, city of " + std::to_string(scene->geometry.indices.size() / 3) +
                      " triangles, cubemap 2048; " + "HQ: anisotropy " +
                      std::to_string(renderer.device().max_anisotropy) + ", " +
                      std::to_string(renderer.device().max_samples) + " samples.",
                  "The paper's GeForce 8800 GTS: PPP over IB 2.03, in high quality 1.62."};
  print_report(report, as_json);
  return exit_done;
}

} // namespace cupola::cli
