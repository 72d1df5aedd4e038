// SIGTERM, SIGINT and SIGHUP through a descriptor, so that nothing is interrupted by them.
#pragma once

#include <optional>

namespace cupola::daemon {

class Signals {
public:
  /// Main thread, before any other thread starts: they inherit that these signals are blocked.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Readable when a signal has come: for poll().
  [[nodiscard]] int fd() const { return fd_; }

  /// The next signal that has come, if any.
  [[nodiscard]] std::optional<int> take();

  /// Ends the process with `exit_code` when it has not ended by itself within this time: a stop that hangs is
  /// worse than an unclean one.
  static void end_within(int milliseconds, int exit_code);

private:
  int fd_ = -1;
};

} // namespace cupola::daemon
