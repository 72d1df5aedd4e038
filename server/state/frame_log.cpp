#include "server/state/frame_log.h"

#include <algorithm>
#include <poll.h>
#include <pthread.h>
#include <stdexcept>
#include <sys/eventfd.h>
#include <unistd.h>
#include <utility>

namespace cupola::state {

namespace {
constexpr std::size_t history_size = 4096;
constexpr std::size_t kept_size = 64;
} // namespace

FrameLog::FrameLog()
    : event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (event_ < 0) throw std::runtime_error("eventfd: no descriptor left");
  thread_ = std::thread([this] { run(); });
}

FrameLog::~FrameLog() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake();
  thread_.join();
  for (Waiting& one : waiting_) one.callback(std::nullopt, {});
  close(event_);
}

void FrameLog::wake() const noexcept {
  const std::uint64_t one = 1;
  // Fails only when the counter is full: then the reader is awake anyway.
  [[maybe_unused]] const auto written = write(event_, &one, sizeof one);
}

void FrameLog::shown(model::Revision revision, std::uint64_t frame) noexcept {
  if (revision == last_written_) return;
  const std::size_t at = written_.load(std::memory_order_relaxed);
  if (at - read_.load(std::memory_order_acquire) == ring_size) return; // the next frame tries again
  ring_[at % ring_size] = {revision, frame};
  written_.store(at + 1, std::memory_order_release);
  last_written_ = revision;
  wake();
}

void FrameLog::collect() {
  std::size_t at = read_.load(std::memory_order_relaxed);
  const std::size_t end = written_.load(std::memory_order_acquire);
  for (; at != end; ++at) history_.push_back(ring_[at % ring_size]);
  read_.store(at, std::memory_order_release);
  while (history_.size() > history_size) history_.pop_front();
}

std::optional<std::uint64_t> FrameLog::first_frame(model::Revision revision) const {
  const auto it =
      std::lower_bound(history_.begin(), history_.end(), revision,
                       [](const Entry& entry, model::Revision wanted) { return entry.revision < wanted; });
  return it == history_.end() ? std::nullopt : std::optional(it->frame);
}

void FrameLog::failed(model::Revision revision, model::Problems why) {
  {
    const std::lock_guard lock(mutex_);
    if (revision < failed_) return;
    failed_ = revision;
    why_ = std::move(why);
  }
  wake();
}

void FrameLog::when_shown(model::Revision revision, std::chrono::milliseconds timeout,
                          ShownCallback callback) {
  std::optional<std::uint64_t> frame;
  {
    const std::lock_guard lock(mutex_);
    frame = first_frame(revision);
    if (!frame) waiting_.push_back({revision, Clock::now() + timeout, std::move(callback)});
  }
  if (frame)
    callback(frame, {}); // NOLINT(bugprone-use-after-move): moved only without a frame
  else
    wake();
}

void FrameLog::keep(std::shared_ptr<const Snapshot> snapshot) {
  std::shared_ptr<const Snapshot> oldest; // freed after the lock
  const std::lock_guard lock(mutex_);
  kept_.push_back(std::move(snapshot));
  if (kept_.size() <= kept_size) return;
  oldest = std::move(kept_.front());
  kept_.pop_front();
}

void FrameLog::run() {
  pthread_setname_np(pthread_self(), "shown");
  for (;;) {
    struct Due {
      ShownCallback callback;
      std::optional<std::uint64_t> frame;
      model::Problems why_not;
    };
    std::vector<Due> due;
    std::vector<std::shared_ptr<const Snapshot>> retired;
    int wait_ms = -1;
    {
      const std::lock_guard lock(mutex_);
      if (stop_) return;
      collect();
      const Clock::time_point now = Clock::now();
      std::erase_if(waiting_, [&](Waiting& one) {
        const auto frame = first_frame(one.revision);
        if (!frame && one.deadline > now && one.revision > failed_) {
          const auto left = std::chrono::ceil<std::chrono::milliseconds>(one.deadline - now).count();
          const int left_ms = static_cast<int>(std::min<std::int64_t>(left, 60'000));
          wait_ms = wait_ms < 0 ? left_ms : std::min(wait_ms, left_ms);
          return false;
        }
        due.push_back(
            {std::move(one.callback), frame, !frame && one.revision <= failed_ ? why_ : model::Problems{}});
        return true;
      });
      const model::Revision newest = history_.empty() ? 0 : history_.back().revision;
      while (!kept_.empty() && kept_.front()->revision < newest) {
        retired.push_back(std::move(kept_.front()));
        kept_.pop_front();
      }
    }
    for (const Due& one : due) one.callback(one.frame, one.why_not);
    due.clear();
    retired.clear();

    pollfd descriptor{event_, POLLIN, 0};
    poll(&descriptor, 1, wait_ms);
    std::uint64_t count = 0;
    [[maybe_unused]] const auto got = read(event_, &count, sizeof count);
  }
}

} // namespace cupola::state
