#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include "server/cli/bench.h"
#include "server/cli/bench_show.h"
#include "server/cli/offline.h"

namespace cupola::cli {

namespace {

constexpr int places = 5, poses = 2 * places; ///< each level and with the view raised by 20°

/// A dome picture in the middle of the city.
model::Show dome_show(int size, int triangles) {
  model::Show show = city_show(model::Fisheye{{180.0}}, size, size, places);
  show.scene.content = model::City{1, triangles};
  show.camera.loop = false;
  show.camera.path.pop_back();
  for (int i = 0; i < places; ++i) {
    model::Keyframe raised = show.camera.path[static_cast<std::size_t>(i)];
    raised.time += places;
    raised.orientation.pitch.degrees = 20.0;
    show.camera.path.push_back(raised);
  }
  return show;
}

struct Way {
  std::string name;
  model::Method method;
  double cubemap_scale; ///< of the matched size; 0: no cubemap is given
};

const std::array ways{Way{"IB, cubemap 0.79 of matched", model::Method::cubemap, 0.79},
                      Way{"IB, matched cubemap", model::Method::cubemap, 0.0},
                      Way{"IB, cubemap 1.57 of matched", model::Method::cubemap, 1.57},
                      Way{"PPP", model::Method::piecewise, 0.0}, Way{"auto", model::Method::automatic, 0.0}};

class FisheyeBench {
public:
  FisheyeBench(frame::Renderer& renderer, BenchReport& report, bool as_json, bool quick)
      : renderer_(renderer)
      , report_(report)
      , as_json_(as_json)
      , quick_(quick) {}

  /// False when something could not be drawn; the problems have been printed.
  bool city(int triangles) {
    scene_ = nullptr;
    for (const int size : {2048, 4096}) {
      std::map<model::Method, double> best;
      for (const Way& way : ways) {
        const auto timing = measure(way, size, triangles);
        if (!timing) return false;
        if (way.cubemap_scale == 0.0) best[way.method] = timing->milliseconds;
      }
      const double pieces = best[model::Method::piecewise], cubemap = best[model::Method::cubemap];
      const std::string label = std::to_string(triangles / 1000) + "k";
      const std::string key = size == 2048 ? label : label + "_" + std::to_string(size);
      report_.ratios["ppp_over_ib_" + key] = rounded(cubemap / pieces, 0.001);
      const double automatic = std::min(pieces, cubemap) / best[model::Method::automatic];
      report_.ratios["auto_over_best_" + key] = rounded(automatic, 0.001);
      worst_auto_ = std::min(worst_auto_, automatic);
    }
    report_.ratios["auto_over_best"] = rounded(worst_auto_, 0.001);
    return true;
  }

private:
  std::optional<Timing> measure(const Way& way, int size, int triangles) {
    model::Show show = dome_show(size, triangles);
    viewport_of(show).method = way.method;
    if (way.cubemap_scale > 0.0) {
      const int matched =
          plan::matched_cubemap_size(projection::make_map(show.projections["view"], 1.0), {0, 0, size, size});
      show.quality.cubemap_size = static_cast<int>(std::lround(matched * way.cubemap_scale / 8.0)) * 8;
    }
    // The sizes beside, and frames that take seconds, do with every other pose.
    const bool few = quick_ || way.cubemap_scale > 0.0 || triangles > 1'000'000;
    Frames frames{double{poses}, few ? poses / 2 : poses, quick_ ? 1 : (few ? 2 : 3), 0};
    if (way.method == model::Method::automatic) frames.before = frame::method_trial_frames;
    if (!as_json_) std::fprintf(stderr, "%dk triangles, %d²: %s\n", triangles / 1000, size, way.name.c_str());
    const auto timed = time_show(renderer_, show, scene_, frames);
    if (!timed) return std::nullopt;
    const auto& [timing, stage] = *timed;
    const plan::ViewportPlan& viewport = stage->plan->outputs.front().viewports.front();
    report_.rows.push_back(
        {{"triangles", triangles},
         {"size", size},
         {"method", way.name},
         {"ms", rounded(timing.milliseconds, 0.01)},
         {"fps", rounded(1000.0 / timing.milliseconds, 0.01)},
         {"sent", std::llround(timing.triangles)},
         {"replication", rounded(timing.replication, 0.001)},
         {"pieces", viewport.pieces ? nlohmann::ordered_json(viewport.pieces->pieces.size()) : nullptr},
         {"cubemap", stage->plan->cubemap ? nlohmann::ordered_json(stage->plan->cubemap->size) : nullptr}});
    return timing;
  }

  frame::Renderer& renderer_;
  BenchReport& report_;
  bool as_json_, quick_;
  std::shared_ptr<const content::Scene> scene_;
  double worst_auto_ = 10.0;
};

} // namespace

int bench_fisheye(bool as_json, bool quick) {
  frame::RendererOptions options;
  options.measure_methods = true;
  return run_bench(as_json, options, [&](frame::Renderer& renderer, BenchReport& report) {
    report.notes = {
        "Fisheye of 180°, city; cubemap faces are cropped to what the fisheye sees. Ratios are at "
        "2048² unless a size is named, with the matched cubemap.",
        "auto_over_best: the worst of all rows."};
    FisheyeBench bench(renderer, report, as_json, quick);
    return bench.city(35'000) && bench.city(350'000) && bench.city(3'500'000);
  });
}

} // namespace cupola::cli
