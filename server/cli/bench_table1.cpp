#include <cmath>
#include <cstdio>

#include "server/cli/bench.h"
#include "server/cli/bench_show.h"

namespace cupola::cli {

namespace {

constexpr int places = 8; ///< through which the path goes

/// The paper's scene: a textured city of 35,000 triangles in 14 groups, 1600 × 1200, a path through it.
model::Show paper_show() {
  model::Show show = city_show(model::Cylinder{{360.0}, {134.0}}, 1600, 1200, places);
  show.projections["plain"].shape = model::Perspective{{75.0}, std::nullopt};
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
    {"plain perspective", "plain", model::Method::piecewise, false, 0.0, 0.0},
    {"IB", "view", model::Method::cubemap, false, 41.7, 0.61},
    {"PPP", "view", model::Method::piecewise, false, 84.7, 1.96},
    {"IB HQ", "view", model::Method::cubemap, true, 33.8, 0.61},
    {"PPP HQ", "view", model::Method::piecewise, true, 54.8, 1.96},
};

bool measure_table1(frame::Renderer& renderer, BenchReport& report, bool as_json, bool quick) {
  model::Show show = paper_show();
  std::shared_ptr<const content::Scene> scene;
  std::vector<double> milliseconds;
  double replication = 0.0;
  for (const Row& row : rows) {
    model::Viewport& viewport = viewport_of(show);
    viewport.projection = row.projection;
    viewport.method = row.method;
    show.quality.anisotropy = row.high_quality ? renderer.device().max_anisotropy : 1;
    show.quality.samples = row.high_quality ? renderer.device().max_samples : 1;
    // A software rasteriser takes seconds for a frame of high quality: few of them have to do.
    const bool slow = row.high_quality && renderer.device().software;
    const int poses = quick ? 2 : (slow ? 3 : 12), repeats = quick || slow ? 1 : 5;
    if (!as_json) std::fprintf(stderr, "%s: %d poses × %d frames\n", row.name, poses, repeats);
    const auto timed = time_show(renderer, show, scene, {double{places}, poses, repeats});
    if (!timed) return false;
    const Timing& measured = timed->timing;
    milliseconds.push_back(measured.milliseconds);
    const bool piecewise = row.method == model::Method::piecewise && std::string(row.projection) == "view";
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
  return true;
}

} // namespace

int bench_table1(bool as_json, bool quick) {
  return run_bench(as_json, {}, [&](frame::Renderer& renderer, BenchReport& report) {
    return measure_table1(renderer, report, as_json, quick);
  });
}

} // namespace cupola::cli
