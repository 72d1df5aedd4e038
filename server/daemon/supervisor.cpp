#include "server/daemon/supervisor.h"

#include <poll.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <utility>

#include "server/daemon/service.h"
#include "server/daemon/status.h"

namespace cupola::daemon {

namespace {

using namespace std::chrono_literals;

constexpr auto status_interval = 1s;
constexpr int window_poll_ms = 10; ///< how long events of windows may wait
constexpr int idle_poll_ms = 250;
constexpr auto reload_patience = 60s; ///< for a reloaded show to be seen

} // namespace

Supervisor::Supervisor(std::filesystem::path show_file, state::LiveState& live, outputs::MainThread& main,
                       Signals& signals)
    : show_file_(std::move(show_file))
    , live_(live)
    , main_(main)
    , signals_(signals) {}

void Supervisor::shown() {
  if (first_frame_shown_.exchange(true)) return;
  main_.post([this] {
    ready_ = true;
    spdlog::info("ready: the first frame has been presented on all outputs");
    service::ready("running");
  });
}

void Supervisor::failed(model::Revision revision) {
  main_.post([this, revision] {
    for (std::size_t ended = not_shown_.erase(revision); ended > 0; --ended)
      reload_over("the reloaded show cannot be shown; the old one goes on");
  });
}

void Supervisor::ended() {
  main_.post([this] { loop_ended_ = true; });
}

void Supervisor::reload() {
  spdlog::info("reloading {}", show_file_.string());
  service::reloading();
  ++reloads_;
  live_.reload(show_file_,
               [this](const state::Answer& answer) { main_.post([this, answer] { reloaded(answer); }); });
}

void Supervisor::reloaded(const state::Answer& answer) {
  if (!answer) {
    const std::string first = answer.error().empty() ? "" : model::to_text(answer.error().front());
    spdlog::error("reload refused, the old show goes on: {} problem{}", answer.error().size(),
                  answer.error().size() == 1 ? "" : "s");
    reload_over("reload refused: " + first);
    return;
  }
  for (const model::Problem& warning : answer->warnings) spdlog::warn("{}", model::to_text(warning));
  const model::Revision revision = answer->revision;
  not_shown_.insert(revision);
  live_.when_shown(revision, reload_patience,
                   [this, revision](std::optional<std::uint64_t> frame, const model::Problems&) {
                     main_.post([this, revision, frame] {
                       const auto waiting = not_shown_.find(revision);
                       if (waiting == not_shown_.end()) return; // has failed already
                       not_shown_.erase(waiting);
                       if (frame) spdlog::info("reloaded: revision {} shown in frame {}", revision, *frame);
                       reload_over(frame ? "running" : "the reloaded show is not shown yet");
                     });
                   });
}

void Supervisor::reload_over(const std::string& status) {
  if (--reloads_ == 0) service::ready(status);
  next_status_ = Clock::now() + 5 * status_interval; // let it be read
}

void Supervisor::tick(const frame::Loop& loop) {
  const auto now = Clock::now();
  if (const auto interval = service::beat_interval(); interval && now >= next_beat_) {
    const std::uint64_t frames = loop.status().frames;
    // Only frames that reached the outputs count: a loop that turns without them is to be killed.
    if (frames != frames_at_beat_) {
      service::beat();
      frames_at_beat_ = frames;
      next_beat_ = now + *interval;
    }
  }
  if (ready_ && reloads_ == 0 && now >= next_status_) {
    service::status(status_line(loop.status()));
    next_status_ = now + status_interval;
  }
}

ExitCode Supervisor::serve(const frame::Loop& loop, outputs::Desktop* desktop) {
  while (!loop_ended_) {
    std::array<pollfd, 2> waiting{pollfd{signals_.fd(), POLLIN, 0}, pollfd{main_.fd(), POLLIN, 0}};
    int timeout = desktop ? window_poll_ms : idle_poll_ms;
    if (const auto interval = service::beat_interval())
      timeout = std::min(timeout, std::max(1, static_cast<int>(interval->count() / 4)));
    poll(waiting.data(), waiting.size(), timeout);
    while (const auto signal = signals_.take()) {
      if (*signal == SIGHUP) {
        reload();
        continue;
      }
      spdlog::info("{}: ending", *signal == SIGTERM ? "SIGTERM" : "SIGINT");
      return exit_done;
    }
    main_.serve();
    if (desktop) desktop->listen();
    tick(loop);
  }
  return loop.end() == frame::LoopEnd::context_lost ? exit_context_lost : exit_start;
}

} // namespace cupola::daemon
