#include "renderer/outputs/main_thread.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <future>
#include <system_error>
#include <utility>

namespace cupola::outputs {

MainThread::MainThread()
    : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

MainThread::~MainThread() {
  close();
  ::close(fd_);
}

bool MainThread::run(const std::function<void()>& task) {
  if (std::this_thread::get_id() == main_) {
    task();
    return true;
  }
  std::promise<void> done;
  if (!post([&] {
        task();
        done.set_value();
      }))
    return false;
  done.get_future().wait();
  return true;
}

bool MainThread::post(std::function<void()> task) {
  const std::lock_guard lock(mutex_);
  if (closed_) return false;
  waiting_.push_back(std::move(task));
  const std::uint64_t one = 1;
  // Fails only when the counter is full, and then the descriptor is readable anyway.
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof one);
  return true;
}

void MainThread::serve() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = read(fd_, &count, sizeof count);
  std::vector<std::function<void()>> now;
  {
    const std::lock_guard lock(mutex_);
    now.swap(waiting_);
  }
  for (const auto& task : now) task();
}

void MainThread::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  serve();
}

} // namespace cupola::outputs
