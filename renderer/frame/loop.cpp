#include "renderer/frame/loop.h"

#include <poll.h>
#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "renderer/frame/frame_times.h"
#include "renderer/frame/pacer.h"
#include "renderer/frame/snapshots.h"
#include "renderer/outputs/main_thread.h"
#include "renderer/outputs/open.h"

namespace cupola::frame {

namespace {

constexpr Nanoseconds second = 1'000'000'000;

Nanoseconds monotonic() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * second + now.tv_nsec;
}

void sleep_until(Nanoseconds time) {
  const timespec until{time / second, time % second};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

/// Outputs on their way: opened on the main thread for a stage that waits for them.
struct Opening {
  std::shared_ptr<const Stage> stage;
  outputs::RunningOutputs base; ///< what runs; emptied on the main thread before `done`
  model::Result<outputs::RunningOutputs> result;
  std::atomic<bool> done = false;
};

/// Outputs that take over when the renderer shows their stage.
struct Next {
  std::uint64_t revision = 0;
  outputs::RunningOutputs outputs;
};

bool all_alike(const outputs::RunningOutputs& running, const outputs::WantedOutputs& wanted) {
  return running.size() == wanted.size() &&
         std::equal(running.begin(), running.end(), wanted.begin(), [](const auto& a, const auto& b) {
           return a.first == b.first && outputs::opens_alike(a.second.wanted, b.second);
         });
}

} // namespace

struct Loop::Impl {
  outputs::Context& context;
  outputs::MainThread& main;
  LoopHooks hooks;

  std::atomic<bool> stopping = false;
  std::atomic<int> end{-1}; ///< a LoopEnd, or -1 while running
  std::mutex status_mutex;  ///< held to copy or swap the pointer, for nothing else
  std::shared_ptr<const LoopStatus> status = std::make_shared<const LoopStatus>();
  Snapshots snapshots;

  // Render thread only.
  std::unique_ptr<Renderer> renderer;
  std::shared_ptr<const Stage> offered; ///< the newest seen
  std::shared_ptr<const Stage> waiting; ///< not yet given to the renderer
  std::shared_ptr<const Stage> given;   ///< given to the renderer last
  std::shared_ptr<Opening> opening;
  std::optional<Next> next;
  outputs::RunningOutputs running;
  Pacer pacer;
  FrameTimes times;
  std::uint64_t frames = 0, late = 0;
  Nanoseconds started = 0;
  Nanoseconds waited = 0; ///< at most: in the frame in progress, for a monitor

  std::thread thread;

  Impl(outputs::Context& context_, outputs::MainThread& main_, LoopHooks hooks_)
      : context(context_)
      , main(main_)
      , hooks(std::move(hooks_)) {}

  void work() {
    pthread_setname_np(pthread_self(), "render");
    LoopEnd how = LoopEnd::failed;
    const auto current = context.make_current();
    if (current) {
      how = run();
      close();
      context.release();
    } else {
      hooks.problems(current.error());
    }
    end = static_cast<int>(how);
    hooks.ended();
  }

  LoopEnd run() {
    auto made = Renderer::make();
    if (!made) {
      hooks.problems(made.error());
      return LoopEnd::failed;
    }
    renderer = std::move(*made);
    started = monotonic();
    pacer.restart(started);
    while (!stopping) {
      snapshots.accept();
      take_stage();
      if (running.empty() && !next) {
        if (!opening && !waiting) return LoopEnd::failed; // the first outputs could not be opened
        sleep_until(monotonic() + second / 500);
        continue;
      }
      if (!frame()) return LoopEnd::context_lost;
    }
    return LoopEnd::stopped;
  }

  /// Looks for a newer stage; outputs that it needs are opened beside the running ones before it is drawn.
  void take_stage() {
    if (auto newest = hooks.stage(); newest != offered) {
      offered = newest;
      waiting = std::move(newest);
    }
    if (opening) {
      if (!opening->done) return;
      finish_opening();
    }
    if (!waiting) return;
    const outputs::RunningOutputs& base = next ? next->outputs : running;
    if (all_alike(base, waiting->show->outputs))
      give(std::exchange(waiting, nullptr));
    else
      begin_opening(std::exchange(waiting, nullptr), base);
  }

  void begin_opening(std::shared_ptr<const Stage> stage, const outputs::RunningOutputs& base) {
    opening = std::make_shared<Opening>();
    opening->stage = std::move(stage);
    opening->base = base;
    const bool posted = main.post([this, work = opening] {
      work->result = outputs::open_outputs(work->stage->show->outputs, work->base, main, context);
      work->base.clear();
      work->done = true;
    });
    if (!posted) opening.reset(); // the main thread has ended; so will this one
  }

  void finish_opening() {
    const auto finished = std::exchange(opening, nullptr);
    if (!finished->result) {
      hooks.failed(finished->stage->revision, finished->result.error());
      return;
    }
    next = Next{finished->stage->revision, std::move(*finished->result)};
    give(finished->stage);
  }

  void give(std::shared_ptr<const Stage> stage) {
    given = std::move(stage);
    renderer->set_stage(given);
  }

  /// Draws, presents and paces one frame; false when the driver has reset the GPU.
  bool frame() {
    const Nanoseconds begin = monotonic();
    const FrameStatistics drawn = renderer->draw(static_cast<double>(pacer.start() - started) * 1e-9);
    const Nanoseconds done = monotonic();
    waited = 0;
    if (model::Problems problems = renderer->take_problems(); !problems.empty()) {
      next.reset();
      hooks.failed(given->revision, problems);
    }
    if (next && drawn.revision >= next->revision) swap_outputs();
    if (drawn.revision > 0) present();
    if (context.lost()) {
      hooks.problems({{model::Code::gl_unavailable, "", "a GPU that goes on", "the driver has reset it",
                       "The daemon ends, so that it can be started anew."}});
      return false;
    }
    const Nanoseconds presented = monotonic();
    if (drawn.revision == 0) { // nothing realised yet
      sleep_until(presented + second / 200);
      return true;
    }
    ++frames;
    times.add(presented, presented - begin);
    publish(drawn, presented); // before anybody hears of the frame and asks
    hooks.shown(drawn.revision, frames);
    snapshots.serve(renderer->pictures(), drawn.revision, frames);
    renderer->set_beside(static_cast<double>(monotonic() - done - waited) * 1e-6);
    pace(presented);
    return true;
  }

  void swap_outputs() {
    running = std::move(next->outputs); // what is no longer used closes here
    next.reset();
    bool taken = false;
    for (auto& [name, entry] : running) {
      const bool waits = !taken && entry.output->can_wait();
      entry.output->set_waiting(waits);
      taken = taken || waits;
    }
  }

  void present() {
    for (auto& [name, entry] : running)
      for (const Picture& picture : renderer->pictures())
        if (picture.output == name)
          entry.output->draw({picture.texture, picture.width, picture.height, frames + 1});
    for (auto& [name, entry] : running) {
      const Nanoseconds begin = monotonic();
      entry.output->present();
      if (entry.output->pace().refresh_hz > 0.0) waited += monotonic() - begin;
      model::Problems problems = entry.output->take_problems();
      if (problems.empty()) continue;
      for (model::Problem& problem : problems)
        if (problem.pointer.empty()) problem.pointer = "/outputs/" + name;
      hooks.problems(problems);
    }
  }

  void pace(Nanoseconds now) {
    double refresh = 0.0;
    for (const auto& [name, entry] : running) refresh = std::max(refresh, entry.output->pace().refresh_hz);
    if (frames == 1) { // the first frame compiled and uploaded everything: it sets no pace
      pacer.restart(now);
      return;
    }
    bool was_late = false;
    const Nanoseconds until = pacer.next(now, given->show->frame_rate, refresh, was_late);
    if (was_late) ++late;
    while (!stopping) {
      now = monotonic();
      if (now >= until) break;
      const bool busy = snapshots.collect();
      sleep_until(std::min(until, now + (busy ? second / 500 : second / 10)));
    }
  }

  void publish(const FrameStatistics& drawn, Nanoseconds now) {
    auto fresh = std::make_shared<LoopStatus>();
    const FrameTimes::Summary summary = times.summary(now);
    fresh->device = renderer->device();
    fresh->context = context.describe();
    fresh->frames = frames;
    fresh->late = late;
    fresh->fps = summary.fps;
    fresh->frame_mean_ms = summary.mean_ms;
    fresh->frame_max_ms = summary.max_ms;
    fresh->show_time = static_cast<double>(pacer.start() - started) * 1e-9;
    fresh->last = drawn;
    for (const auto& [name, entry] : running) {
      const outputs::Counters counters = entry.output->counters();
      fresh->outputs.push_back({name, entry.output->describe(), entry.wanted.width, entry.wanted.height,
                                counters.presented, counters.dropped});
    }
    std::shared_ptr<const LoopStatus> now_current = std::move(fresh);
    const std::lock_guard lock(status_mutex);
    status.swap(now_current); // the old one goes after the lock
  }

  /// With the context still current: everything that owns GL objects goes.
  void close() {
    while (opening && !opening->done) sleep_until(monotonic() + second / 1000);
    opening.reset();
    next.reset();
    running.clear();
    snapshots.end();
    renderer.reset();
  }
};

Loop::Loop(outputs::Context& context, outputs::MainThread& main, LoopHooks hooks)
    : impl_(std::make_unique<Impl>(context, main, std::move(hooks))) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->work(); });
}

Loop::~Loop() {
  stop();
  while (impl_->end < 0) {
    pollfd waiting{impl_->main.fd(), POLLIN, 0};
    poll(&waiting, 1, 5);
    impl_->main.serve();
  }
  impl_->thread.join();
  impl_->main.serve(); // windows that the render thread has let go
}

void Loop::stop() noexcept { impl_->stopping = true; }

std::optional<LoopEnd> Loop::end() const {
  const int how = impl_->end;
  return how < 0 ? std::nullopt : std::optional(static_cast<LoopEnd>(how));
}

LoopStatus Loop::status() const {
  std::shared_ptr<const LoopStatus> now;
  {
    const std::lock_guard lock(impl_->status_mutex);
    now = impl_->status;
  }
  return *now;
}

void Loop::snapshot(std::string output, std::optional<int> max_width, SnapshotCallback callback) {
  impl_->snapshots.request(std::move(output), max_width, std::move(callback));
}

} // namespace cupola::frame
