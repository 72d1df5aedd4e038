// What is wrong with the running show, for the status. Any thread.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>

#include "configs/model/problem.h"

namespace cupola::daemon {

class Faults {
public:
  /// Beside the show: the latest few are kept.
  void add(const model::Problems& problems) {
    const std::lock_guard lock(mutex_);
    for (const model::Problem& problem : problems) lately_.push_back(problem);
    while (lately_.size() > kept) lately_.pop_front();
  }

  /// `revision` was accepted but cannot be shown; holds until a newer one is.
  void add_failed(std::uint64_t revision, model::Problems problems) {
    const std::lock_guard lock(mutex_);
    failed_ = {revision, std::move(problems)};
  }

  void shown(std::uint64_t revision) {
    if (revision == shown_) return;
    shown_ = revision;
    const std::lock_guard lock(mutex_);
    if (revision > failed_.first) failed_ = {};
  }

  [[nodiscard]] model::Problems now() const {
    const std::lock_guard lock(mutex_);
    model::Problems all = failed_.second;
    all.insert(all.end(), lately_.begin(), lately_.end());
    return all;
  }

private:
  static constexpr std::size_t kept = 8;
  mutable std::mutex mutex_; ///< never held during work
  std::deque<model::Problem> lately_;
  std::pair<std::uint64_t, model::Problems> failed_;
  std::uint64_t shown_ = 0; ///< render thread only
};

} // namespace cupola::daemon
