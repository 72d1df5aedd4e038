// When the next frame begins. Pure: told the time, never asks for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cupola::frame {

/// Nanoseconds of a monotonic clock.
using Nanoseconds = std::int64_t;

/// Frames begin on a grid of absolute times, so that errors do not add up. A frame that took too long makes
/// the next one begin at once, on the grid point last passed: what was missed is skipped, not caught up.
class Pacer {
public:
  /// The time at which the frame in progress was due: it is the frame's show time.
  [[nodiscard]] Nanoseconds start() const { return start_; }

  /// Begins a new grid at `now`.
  void restart(Nanoseconds now) { start_ = now; }

  /// The frame in progress is presented at `now`; returns when the next one begins (now or later). True in
  /// `late` when that is after its time. `rate`: frames a second wanted. `refresh`: of the monitor whose
  /// refresh presenting waits for, or 0.
  Nanoseconds next(Nanoseconds now, double rate, double refresh, bool& late) {
    const auto period = static_cast<Nanoseconds>(1e9 / rate);
    if (refresh > 0.0 && std::abs(refresh / rate - 1.0) < same_rate) {
      // Two clocks that mean the same: the monitor's counts. Ours only keeps a driver that does not wait, or
      // a monitor that is off, from running away.
      late = now - start_ > period * 3 / 2;
      start_ = std::max(now, start_ + period * 9 / 10);
      return start_;
    }
    start_ += period;
    late = now > start_;
    if (late) start_ += (now - start_) / period * period;
    return std::max(now, start_);
  }

private:
  /// Rates within 2 % are meant to be equal: monitors say 60 Hz where they have 59.94.
  static constexpr double same_rate = 0.02;
  Nanoseconds start_ = 0;
};

} // namespace cupola::frame
