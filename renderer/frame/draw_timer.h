// How long a frame takes to draw, without waiting for the GPU: results come some frames later. Software
// drivers, whose timers under-report, are waited for instead: they draw on the processor's own time anyway.
// Render thread only.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>

#include "renderer/gl/handle.h"

namespace cupola::frame {

class DrawTimer {
public:
  explicit DrawTimer(bool software);

  void begin();
  /// `beside_ms`: what the processor does in a frame beside drawing; counts as its time too.
  void end(double beside_ms);

  /// Milliseconds of a frame that has ended, the longer of the processor's time and the GPU's; each is given
  /// once.
  [[nodiscard]] std::optional<double> take();

  /// Frames begun so far are not given any more.
  void forget();

private:
  using Clock = std::chrono::steady_clock;
  struct Slot {
    gl::Query query;
    double processor_ms = 0.0;
    bool pending = false;
  };

  bool software_;
  Clock::time_point started_;
  std::array<Slot, 4> slots_; ///< frames on their way through the GPU
  std::size_t next_ = 0, oldest_ = 0;
  bool timing_ = false;
  std::optional<double> finished_; ///< of a software driver
};

} // namespace cupola::frame
