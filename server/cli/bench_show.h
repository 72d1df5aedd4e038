// Shows that benchmarks draw, and the drawing of one. Render thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "configs/model/show.h"
#include "renderer/frame/renderer.h"
#include "server/cli/bench.h"
#include "server/cli/bench_timing.h"

namespace cupola::cli {

/// Keyframes at the seconds 0 … `places`: once round the middle of the city, each place looking along the
/// path. The last is the first again.
[[nodiscard]] std::vector<model::Keyframe> round_the_city(int places);

/// The default city, round which the camera goes in `places` seconds; one projection, "view", on one headless
/// output, "main", of one viewport, "all".
[[nodiscard]] model::Show city_show(const model::Shape& shape, int width, int height, int places);

/// The viewport "all" of the output "main".
[[nodiscard]] model::Viewport& viewport_of(model::Show& show);

/// Opens a headless renderer, lets `body` fill the report, and prints it. `body` answers false where
/// something could not be drawn and has been told. Returns an exit code.
[[nodiscard]] int run_bench(bool as_json, const frame::RendererOptions& options,
                            const std::function<bool(frame::Renderer&, BenchReport&)>& body);

struct Frames {
  double duration = 1.0;      ///< seconds of the show over which the poses are spread
  int poses = 1, repeats = 1; ///< frames of each pose that are timed
  int before = 0;             ///< frames to settle in
};

struct TimedShow {
  Timing timing;
  std::shared_ptr<const frame::Stage> stage;
};

/// Plans the show, over `scene` where one is given, and times its frames. Leaves its scene in `scene`. With
/// the problems printed, nothing when it cannot be drawn.
[[nodiscard]] std::optional<TimedShow> time_show(frame::Renderer& renderer, const model::Show& show,
                                                 std::shared_ptr<const content::Scene>& scene,
                                                 const Frames& frames);

} // namespace cupola::cli
