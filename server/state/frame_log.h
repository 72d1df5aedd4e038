// Which frame first showed which revision: filled by the render thread without ever waiting, asked by others.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "server/state/live_state.h"

namespace cupola::state {

/// Owns the thread "shown", which answers those who wait and frees snapshots that no frame needs any more.
class FrameLog {
public:
  FrameLog();
  ~FrameLog(); ///< answers those who still wait with nullopt
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;

  /// One thread only (render). Two atomics and, for a new revision, a write to an eventfd: never blocks.
  void shown(model::Revision revision, std::uint64_t frame) noexcept;

  /// `revision` cannot be shown: who waits for it or an older one that no frame has shown is answered with
  /// nullopt now instead of after the timeout. Any thread; a short lock.
  void failed(model::Revision revision, model::Problems why);

  void when_shown(model::Revision revision, std::chrono::milliseconds timeout, ShownCallback callback);

  /// Holds a replaced snapshot until a newer one has been shown, so that it is not the render thread that
  /// frees it.
  void keep(std::shared_ptr<const Snapshot> snapshot);

private:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    model::Revision revision = 0;
    std::uint64_t frame = 0;
  };
  struct Waiting {
    model::Revision revision = 0;
    Clock::time_point deadline;
    ShownCallback callback;
  };

  void run();
  void wake() const noexcept;
  void collect();
  [[nodiscard]] std::optional<std::uint64_t> first_frame(model::Revision revision) const;

  static constexpr std::size_t ring_size = 256;
  std::array<Entry, ring_size> ring_{};
  std::atomic<std::size_t> written_{0}, read_{0};
  model::Revision last_written_ = 0; ///< render thread only

  std::mutex mutex_; ///< guards what follows
  std::deque<Entry> history_;
  std::vector<Waiting> waiting_;
  std::deque<std::shared_ptr<const Snapshot>> kept_;
  model::Revision failed_ = 0; ///< the newest
  model::Problems why_;        ///< it failed
  bool stop_ = false;

  int event_ = -1;
  std::thread thread_;
};

} // namespace cupola::state
