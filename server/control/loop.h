// The thread "control": one event loop for all sockets.
#pragma once

#include <functional>
#include <memory>

namespace boost::asio {
class io_context;
}

namespace cupola::control {

/// Must outlive the servers that use it, and whoever may still answer them (the live state, the source of
/// pictures).
class Loop {
public:
  Loop();  ///< starts the thread
  ~Loop(); ///< what still waits is dropped, not run
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] boost::asio::io_context& context();

  /// Runs `work` on the thread and returns when it has run. Not from the thread itself.
  void run_and_wait(const std::function<void()>& work);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cupola::control
