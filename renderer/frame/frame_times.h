// How long the frames of the last seconds took. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "renderer/frame/pacer.h"

namespace cupola::frame {

class FrameTimes {
public:
  static constexpr Nanoseconds window = 5'000'000'000;

  /// A frame was presented at `end`, begun `duration` before.
  void add(Nanoseconds end, Nanoseconds duration) {
    if (ring_.size() < capacity)
      ring_.push_back({end, duration});
    else
      ring_[next_] = {end, duration};
    next_ = (next_ + 1) % capacity;
  }

  struct Summary {
    double fps = 0.0, mean_ms = 0.0, max_ms = 0.0;
  };
  /// Over the frames that ended within the window before `now`.
  [[nodiscard]] Summary summary(Nanoseconds now) const {
    Summary sum;
    std::size_t count = 0;
    Nanoseconds first = now, last = 0;
    for (const Entry& entry : ring_) {
      if (now - entry.end > window) continue;
      ++count;
      first = std::min(first, entry.end);
      last = std::max(last, entry.end);
      sum.mean_ms += static_cast<double>(entry.duration) * 1e-6;
      sum.max_ms = std::max(sum.max_ms, static_cast<double>(entry.duration) * 1e-6);
    }
    if (count > 0) sum.mean_ms /= static_cast<double>(count);
    if (count > 1 && last > first)
      sum.fps = static_cast<double>(count - 1) * 1e9 / static_cast<double>(last - first);
    return sum;
  }

private:
  static constexpr std::size_t capacity = 2400; ///< the window at 480 frames a second
  struct Entry {
    Nanoseconds end, duration;
  };
  std::vector<Entry> ring_;
  std::size_t next_ = 0;
};

} // namespace cupola::frame
