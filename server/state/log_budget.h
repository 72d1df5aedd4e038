// Keeps a flood of bad requests from flooding the log.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

namespace cupola::state {

/// Not thread-safe: one for each thread that logs.
class LogBudget {
public:
  using Clock = std::chrono::steady_clock;
  explicit LogBudget(std::size_t lines_per_second)
      : lines_(lines_per_second) {}

  /// The number of lines suppressed since the last one let through, or nullopt: suppress this one too.
  [[nodiscard]] std::optional<std::size_t> admit(Clock::time_point now) {
    if (now - window_ >= std::chrono::seconds(1)) {
      window_ = now;
      used_ = 0;
    }
    if (used_ == lines_) {
      ++suppressed_;
      return std::nullopt;
    }
    ++used_;
    const std::size_t missed = suppressed_;
    suppressed_ = 0;
    return missed;
  }

private:
  std::size_t lines_, used_ = 0, suppressed_ = 0;
  Clock::time_point window_{};
};

} // namespace cupola::state
