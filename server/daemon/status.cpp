#include "server/daemon/status.h"

#include <cmath>
#include <fmt/core.h>

#include "server/control/problem_json.h"

namespace cupola::daemon {

namespace {

double rounded(double value, double step) { return std::round(value / step) * step; }

} // namespace

std::string status_line(const frame::LoopStatus& status) {
  return fmt::format("revision {}, {:.1f} frames a second, {} late, {} output{}", status.last.revision,
                     status.fps, status.late, status.outputs.size(), status.outputs.size() == 1 ? "" : "s");
}

model::Json status_json(const frame::LoopStatus& status, const model::Problems& problems) {
  model::Json outputs = model::Json::object();
  for (const frame::OutputStatus& output : status.outputs)
    outputs[output.name] = {{"description", output.description},
                            {"width", output.width},
                            {"height", output.height},
                            {"frames", output.presented},
                            {"dropped", output.dropped}};
  return {{"device", status.device.name},
          {"context", status.context},
          {"shown_revision", status.last.revision},
          {"frames", status.frames},
          {"late_frames", status.late},
          {"fps", rounded(status.fps, 0.01)},
          {"frame_mean_ms", rounded(status.frame_mean_ms, 0.01)},
          {"frame_max_ms", rounded(status.frame_max_ms, 0.01)},
          {"show_time", rounded(status.show_time, 0.001)},
          {"triangles", status.last.triangles},
          {"triangles_drawn", status.last.drawn},
          {"replicated", status.last.replicated},
          {"vertex_bytes", status.last.vertex_bytes},
          {"quality",
           {{"automatic", status.last.automatic_quality},
            {"anisotropy", status.last.quality.anisotropy},
            {"samples", status.last.quality.samples},
            {"supersampling", status.last.quality.supersampling}}},
          {"uploading", status.last.uploading},
          {"outputs", std::move(outputs)},
          {"problems", control::problems_json(problems)}};
}

} // namespace cupola::daemon
