// Work for the main thread. Window systems insist that windows are made, destroyed and listened to on the
// thread that main() runs on; other threads hand such work over here, and the main loop serves it.
#pragma once

#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace cupola::outputs {

class MainThread {
public:
  /// The constructing thread is the main thread.
  MainThread();
  ~MainThread();
  MainThread(const MainThread&) = delete;
  MainThread& operator=(const MainThread&) = delete;

  /// Any thread. Runs `task` on the main thread and returns when it is done; on the main thread itself at
  /// once. False, and not run, after close().
  bool run(const std::function<void()>& task);

  /// Any thread. Hands `task` over and returns; on the main thread too it runs at the next serve(). False
  /// after close().
  bool post(std::function<void()> task);

  /// Main thread. Readable while something waits to be served: for poll().
  [[nodiscard]] int fd() const { return fd_; }

  /// Main thread. Runs everything that waits.
  void serve();

  /// Main thread. Runs what still waits; from then on nothing is taken.
  void close();

private:
  std::thread::id main_ = std::this_thread::get_id();
  int fd_ = -1;
  std::mutex mutex_; ///< held to push and to swap, never while a task runs
  std::vector<std::function<void()>> waiting_;
  bool closed_ = false;
};

} // namespace cupola::outputs
