// cupolad: the render server. This file is its object graph; docs/ARCHITECTURE.md draws the threads.
#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <future>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "configs/loader/loader.h"
#include "renderer/frame/loop.h"
#include "renderer/outputs/context.h"
#include "renderer/outputs/desktop.h"
#include "renderer/outputs/main_thread.h"
#include "renderer/outputs/open.h"
#include "server/control/http/server.h"
#include "server/control/loop.h"
#include "server/control/osc/server.h"
#include "server/daemon/exit_code.h"
#include "server/daemon/faults.h"
#include "server/daemon/log.h"
#include "server/daemon/service.h"
#include "server/daemon/show_file.h"
#include "server/daemon/signals.h"
#include "server/daemon/stages.h"
#include "server/daemon/status.h"
#include "server/daemon/supervisor.h"
#include "server/state/live_state.h"

namespace cupola::daemon {

namespace {

/// A stop takes at most so long from the signal; what is not done by then is left undone.
constexpr int stop_within_ms = 800;

struct Options {
  std::string config;
  bool check = false;
  std::string log_format = "text";
  std::string log_level = "info";
};

using Live = std::unique_ptr<state::LiveState>;

/// Says on the thread "prepare" what would keep outputs from being opened; windows know on the main thread.
struct OutputTest {
  outputs::MainThread& main;
  std::atomic<outputs::Context*> context = nullptr; ///< from when there is one

  [[nodiscard]] model::Problems operator()(const model::Show& show) {
    model::Problems problems;
    outputs::Context* const here = context;
    if (here) main.run([&] { problems = outputs::test_outputs(show.outputs, *here); });
    return problems;
  }
};

/// The first load runs on a thread of its own, so that a signal ends even a long one. Nullopt: asked to stop.
std::optional<model::Result<Live>> load_unless_stopped(const Options& options, OutputTest& test,
                                                       Signals& signals) {
  std::packaged_task<model::Result<Live>()> task([&options, &test] {
    pthread_setname_np(pthread_self(), "prepare");
    state::Options wanted;
    wanted.load_resources = scene_loader(options.config);
    wanted.test_outputs = [&test](const model::Show& show) { return test(show); };
    return open_show(options.config, std::move(wanted));
  });
  auto loaded = task.get_future();
  std::thread thread(std::move(task));
  while (loaded.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready)
    if (const auto signal = signals.take(); signal && *signal != SIGHUP) {
      thread.detach();
      return std::nullopt;
    }
  thread.join();
  return loaded.get();
}

/// Without its display the process cannot go on: a new one is to be started.
void end_without_display() {
  spdlog::critical("the display is gone");
  std::_Exit(exit_context_lost);
}

/// With windows where the show wants some and there is a display; else headless.
model::Result<std::unique_ptr<outputs::Context>> open_context(const model::Show& show,
                                                              outputs::MainThread& main) {
  if (outputs::wants_windows(show.outputs)) {
    auto windowed = outputs::Context::make_windowed(main, messages_to_log());
    if (windowed) outputs::Desktop::when_lost(&end_without_display);
    if (windowed || outputs::needs_windows(show.outputs)) return windowed;
    spdlog::info("no windows ({}); the outputs are headless", model::to_text(windowed.error().front()));
  }
  return outputs::Context::make_headless(messages_to_log());
}

frame::LoopHooks hooks_of(state::LiveState& live, Stages& stages, Faults& faults, Supervisor& supervisor) {
  frame::LoopHooks hooks;
  hooks.stage = [&] { return stages.newest(); };
  hooks.shown = [&](std::uint64_t revision, std::uint64_t frame) {
    live.shown(revision, frame);
    faults.shown(revision);
    supervisor.shown();
  };
  hooks.failed = [&](std::uint64_t revision, const model::Problems& problems) {
    spdlog::error("revision {} cannot be shown; what was shown before goes on", revision);
    log_problems(problems);
    faults.add_failed(revision, problems);
    supervisor.failed(revision);
    live.failed(revision, problems);
  };
  hooks.problems = [&](const model::Problems& problems) {
    log_problems(problems);
    faults.add(problems);
  };
  hooks.ended = [&] { supervisor.ended(); };
  return hooks;
}

/// What the network sees of the frame loop.
control::Services services_of(frame::Loop& loop, const Faults& faults) {
  control::Services services;
  services.version = CUPOLA_VERSION;
  services.schema = loader::show_schema();
  services.status = [&] { return status_json(loop.status(), faults.now()); };
  services.snapshot = [&loop](const std::string& output,
                              std::function<void(model::Result<control::RgbPicture>)> deliver) {
    loop.snapshot(output, std::nullopt, [deliver = std::move(deliver)](model::Result<frame::Snapshot> got) {
      if (got)
        deliver(control::RgbPicture{got->width, got->height, std::move(got->rgb)});
      else
        deliver(tl::unexpected(std::move(got.error())));
    });
  };
  return services;
}

/// The doors that the show opens. Problems are logged; false when one could not be opened.
struct Doors {
  std::unique_ptr<control::HttpServer> http;
  std::unique_ptr<control::OscServer> osc;

  bool open(control::Loop& sockets, state::LiveState& live, control::Services services) {
    const model::Control where = live.current()->show->control;
    if (where.http.enabled) {
      auto opened = control::HttpServer::open(sockets, live, where.http, std::move(services));
      if (!opened) return refused(opened.error());
      http = std::move(*opened);
      spdlog::info("live pictures: http://{}:{}/", where.http.address, http->port());
    }
    if (where.osc.enabled) {
      auto opened = control::OscServer::open(sockets, live, where.osc);
      if (!opened) return refused(opened.error());
      osc = std::move(*opened);
    }
    return true;
  }

private:
  static bool refused(const model::Problems& problems) {
    log_problems(problems);
    return false;
  }
};

ExitCode run(const Options& options) {
  Signals signals;
  outputs::MainThread main;
  spdlog::info("cupolad {} with {}", CUPOLA_VERSION, options.config);

  control::Loop sockets; // outlives whoever may still answer through it
  OutputTest output_test{main};
  auto loaded = load_unless_stopped(options, output_test, signals);
  if (!loaded) { // the loading thread still runs: nothing may be torn down under it
    service::stopping();
    std::_Exit(exit_done);
  }
  if (!*loaded) {
    log_problems(loaded->error());
    return exit_code_of(loaded->error());
  }
  const Live live = std::move(**loaded);
  log_problems(live->current()->warnings);

  auto context = open_context(*live->current()->show, main);
  if (!context) {
    log_problems(context.error());
    return exit_start;
  }
  output_test.context = context->get();
  spdlog::info("rendering with {}", (*context)->describe());

  Stages stages(*live);
  Faults faults;
  Supervisor supervisor(options.config, *live, main, signals);
  ExitCode exit_code = exit_start;
  {
    frame::Loop loop(**context, main, hooks_of(*live, stages, faults, supervisor));
    Doors doors;
    if (doors.open(sockets, *live, services_of(loop, faults)))
      exit_code = supervisor.serve(loop, (*context)->desktop());
    service::stopping();
    Signals::end_within(stop_within_ms, exit_code);
  }
  main.close(); // nobody waits for this thread any more
  return exit_code;
}

} // namespace

} // namespace cupola::daemon

int main(int argc, char** argv) {
  using namespace cupola::daemon;
  Options options;
  CLI::App app("The render server of Cupola: shows for domes and cylinder walls.\n"
               "SIGHUP reloads the show file; SIGTERM and SIGINT end.",
               "cupolad");
  app.set_version_flag("--version", "cupolad " CUPOLA_VERSION);
  app.add_option("--config", options.config, "Show file")->required()->type_name("FILE");
  app.add_flag("--check", options.check,
               "Checks the show and opens nothing: 0 valid, 1 problems, 2 unreadable");
  app.add_option("--log-format", options.log_format, "How log lines look")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  app.add_option("--log-level", options.log_level, "What is logged")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  app.footer(
      "Exit codes: 0 ended as asked · 1 the show has problems · 2 wrong arguments or unreadable file ·\n"
      "3 an output, OpenGL or a listener could not be opened · 4 the GPU was reset or the display is gone");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version arrive here too, with code 0.
    return app.exit(error) == 0 ? exit_done : exit_usage;
  }
  if (options.check) return check(options.config);
  set_up_log(options.log_format == "json", options.log_level);
  return run(options);
}
