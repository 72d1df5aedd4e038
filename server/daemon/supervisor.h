// What the main thread does while the show runs: signals, windows' events, and what systemd is to hear.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <set>
#include <string>

#include "renderer/frame/loop.h"
#include "renderer/outputs/desktop.h"
#include "renderer/outputs/main_thread.h"
#include "server/daemon/exit_code.h"
#include "server/daemon/signals.h"
#include "server/state/live_state.h"

namespace cupola::daemon {

class Supervisor {
public:
  Supervisor(std::filesystem::path show_file, state::LiveState& live, outputs::MainThread& main,
             Signals& signals);

  /// Render thread: a frame has been presented on all outputs.
  void shown();
  /// Render thread: `revision` cannot be shown.
  void failed(model::Revision revision);
  /// Any thread: the frame loop has ended.
  void ended();

  /// Main thread. Serves until a signal asks to stop or the loop ends by itself; the loop still runs then, or
  /// has ended. `desktop`: whose events are handled, or nullptr.
  [[nodiscard]] ExitCode serve(const frame::Loop& loop, outputs::Desktop* desktop);

private:
  using Clock = std::chrono::steady_clock;
  void reload();
  void reloaded(const state::Answer& answer);
  void reload_over(const std::string& status);
  void tick(const frame::Loop& loop);

  std::filesystem::path show_file_;
  state::LiveState& live_;
  outputs::MainThread& main_;
  Signals& signals_;
  std::atomic<bool> first_frame_shown_ = false;

  // Main thread only.
  bool loop_ended_ = false;
  bool ready_ = false;
  int reloads_ = 0;                          ///< under way
  std::multiset<model::Revision> not_shown_; ///< reloaded and accepted, not seen yet
  std::uint64_t frames_at_beat_ = 0;
  Clock::time_point next_status_{}, next_beat_{};
};

} // namespace cupola::daemon
