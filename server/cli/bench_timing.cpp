#include "server/cli/bench_timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <epoxy/gl.h>
#include <vector>

namespace cupola::cli {

namespace {

using Clock = std::chrono::steady_clock;

} // namespace

Timing time_frames(frame::Renderer& renderer, double duration, int poses, int repeats) {
  Timing sum;
  for (int pose = 0; pose < poses; ++pose) {
    std::vector<double> times;
    frame::FrameStatistics statistics;
    for (int i = 0; i < repeats + 1; ++i) {
      glFinish();
      const auto start = Clock::now();
      statistics = renderer.draw(duration * pose / poses);
      glFinish();
      if (i > 0) times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    sum.milliseconds += *middle;
    sum.triangles += static_cast<double>(statistics.drawn);
    sum.replication += static_cast<double>(statistics.replicated) / static_cast<double>(statistics.triangles);
    sum.buffer_kb += static_cast<double>(statistics.vertex_bytes) / 1024.0;
  }
  return {sum.milliseconds / poses, sum.triangles / poses, sum.replication / poses, sum.buffer_kb / poses};
}

double quickest_frame(frame::Renderer& renderer, int repeats, double time) {
  double least = 1e9;
  for (int i = 0; i < repeats; ++i) {
    glFinish();
    const auto start = Clock::now();
    renderer.draw(time);
    glFinish();
    least = std::min(least, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return least;
}

double rounded(double value, double step) { return std::round(value / step) / (1.0 / step); }

std::string device_line(const frame::Renderer& renderer) {
  return renderer.device().name + ", OpenGL " + renderer.device().version;
}

} // namespace cupola::cli
