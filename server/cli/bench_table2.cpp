#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include "server/cli/bench.h"
#include "server/cli/bench_show.h"

namespace cupola::cli {

namespace {

constexpr int poses = 8;

/// The paper's scene and size; the grid lies over a perspective of 75° and bends every cell of it.
model::Show grid_show(int columns, int rows) {
  model::CameraTexture texture;
  texture.columns = columns;
  texture.rows = rows;
  texture.deformations["zoom"] = {model::RadialZoom{0.35}, 0.0, 0.0, 1.6, 0};
  texture.deformations["swirl"] = {model::Swirl{{12.0}}, 0.0, 0.0, 1.6, 1};
  model::Show show = city_show(texture, 1600, 1200, poses);
  show.projections["plain"].shape = model::Perspective{{75.0}, std::nullopt};
  return show;
}

struct Row {
  const char* name;
  const char* projection;
  int columns, rows;
  model::Method method;
  double paper_fps, paper_replication; ///< 0: not in the paper
};

constexpr Row rows[] = {
    {"plain perspective", "plain", 128, 128, model::Method::piecewise, 0.0, 0.0},
    {"IB 128x128", "view", 128, 128, model::Method::cubemap, 206.2, 1.0},
    {"PPP 128x128", "view", 128, 128, model::Method::piecewise, 8.4, 21.04},
    {"IB 80x60", "view", 80, 60, model::Method::cubemap, 0.0, 0.0},
    {"PPP 80x60", "view", 80, 60, model::Method::piecewise, 22.1, 10.17},
};

nlohmann::ordered_json row_of(const Row& row, const Timing& timing, const plan::Plan& plan) {
  const auto& pieces = plan.outputs.front().viewports.front().pieces;
  const auto known = [](double figure) {
    return figure > 0.0 ? nlohmann::ordered_json(figure) : nlohmann::ordered_json(nullptr);
  };
  return {{"method", row.name},
          {"fps", rounded(1000.0 / timing.milliseconds, 0.01)},
          {"ms", rounded(timing.milliseconds, 0.01)},
          {"av. triangles", std::llround(timing.triangles)},
          {"av. replication", rounded(timing.replication, 0.001)},
          {"buffers kB", std::llround(timing.buffer_kb)},
          {"pieces", pieces ? nlohmann::ordered_json(pieces->pieces.size()) : nullptr},
          {"paper fps", known(row.paper_fps)},
          {"paper replication", known(row.paper_replication)}};
}

bool measure_table2(frame::Renderer& renderer, BenchReport& report, bool as_json, bool quick) {
  std::shared_ptr<const content::Scene> scene;
  std::map<std::string, Timing> timings;
  int picture = 0;
  for (const Row& row : rows) {
    model::Show show = grid_show(row.columns, row.rows);
    model::Viewport& viewport = viewport_of(show);
    viewport.projection = row.projection;
    viewport.method = row.method;
    if (!as_json) std::fprintf(stderr, "%s\n", row.name);
    const auto timed = time_show(renderer, show, scene, {double{poses}, quick ? 2 : poses, quick ? 2 : 7});
    if (!timed) return false;
    const auto& [timing, stage] = *timed;
    timings[row.name] = timing;
    if (stage->plan->cubemap) picture = stage->plan->cubemap->size;
    report.rows.push_back(row_of(row, timing, *stage->plan));
  }
  const auto ratio = [&](const char* over, const char* under) {
    return rounded(timings[over].milliseconds / timings[under].milliseconds, 0.001);
  };
  report.ratios = {{"ppp_over_ib_128", ratio("IB 128x128", "PPP 128x128")},
                   {"ppp_over_ib_80x60", ratio("IB 80x60", "PPP 80x60")},
                   {"ppp_time_over_plain_128", ratio("PPP 128x128", "plain perspective")},
                   {"replication_128", rounded(timings["PPP 128x128"].replication, 0.001)}};
  report.notes = {
      "1600x1200, a perspective of 75° bent by a radial zoom with swirl. IB warps one picture: the seen "
      "part of one cubemap face of " +
          std::to_string(picture) + " pixels, the matched size.",
      "The paper's GeForce 8800 GTS: PPP over IB 0.04; with 80x60, 0.11 of the IB above."};
  return true;
}

} // namespace

int bench_table2(bool as_json, bool quick) {
  return run_bench(as_json, {}, [&](frame::Renderer& renderer, BenchReport& report) {
    return measure_table2(renderer, report, as_json, quick);
  });
}

} // namespace cupola::cli
