// How long frames take, for all benchmarks alike.
#pragma once

#include <string>

#include "renderer/frame/renderer.h"

namespace cupola::cli {

/// Means over the poses.
struct Timing {
  double milliseconds = 0.0; ///< a frame, to glFinish: median of the repeats
  double triangles = 0.0;    ///< sent to the rasteriser
  double replication = 0.0;  ///< (triangle, piece) pairs over the scene's triangles
  double buffer_kb = 0.0;    ///< of all vertex and index buffers
};

/// Draws the renderer's stage at `poses` equally spaced times of [0, duration) seconds, each once to warm
/// caches and then `repeats` times. Wall clock around draw() and glFinish: timers of software drivers
/// under-report.
[[nodiscard]] Timing time_frames(frame::Renderer& renderer, double duration, int poses, int repeats);

/// The least time of `repeats` frames at `time` seconds, to glFinish: on a busy machine the figure that
/// others disturb least.
[[nodiscard]] double quickest_frame(frame::Renderer& renderer, int repeats, double time);

/// To a multiple of `step`, as figures are reported.
[[nodiscard]] double rounded(double value, double step);

/// The driver's name and version.
[[nodiscard]] std::string device_line(const frame::Renderer& renderer);

} // namespace cupola::cli
