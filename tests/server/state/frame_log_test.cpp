#include "server/state/frame_log.h"

#include <doctest/doctest.h>
#include <future>

using cupola::state::FrameLog;
using cupola::state::Snapshot;
using namespace std::chrono_literals;

namespace {

std::future<std::optional<std::uint64_t>> ask(FrameLog& log, cupola::model::Revision revision,
                                              std::chrono::milliseconds timeout = 60s) {
  auto promise = std::make_shared<std::promise<std::optional<std::uint64_t>>>();
  log.when_shown(revision, timeout, [promise](auto frame, const auto&) { promise->set_value(frame); });
  return promise->get_future();
}

} // namespace

TEST_CASE("the first frame of a revision is told, asked before or after") {
  FrameLog log;
  auto before = ask(log, 2);
  log.shown(1, 10);
  log.shown(2, 11);
  log.shown(2, 12);
  CHECK(before.get() == 11);
  CHECK(ask(log, 2).get() == 11);
  CHECK(ask(log, 1).get() == 10);
}

TEST_CASE("a revision that was coalesced counts as shown with the next one") {
  FrameLog log;
  auto waiting = ask(log, 3);
  log.shown(1, 1);
  log.shown(7, 2);
  log.shown(8, 3);
  CHECK(waiting.get() == 2);
}

TEST_CASE("who waits in vain is told so") {
  FrameLog log;
  log.shown(1, 1);
  CHECK(ask(log, 2, 1ms).get() == std::nullopt);
}

TEST_CASE("who waits for what cannot be shown is told why at once; a newer revision is waited for") {
  FrameLog log;
  std::promise<cupola::model::Problems> why;
  log.when_shown(2, 60s, [&](auto, const auto& problems) { why.set_value(problems); });
  auto newer = ask(log, 4);
  log.failed(3, {{cupola::model::Code::image_unwritable, "/outputs/a", "a disk", "a full one", "", {}, {}}});
  REQUIRE(why.get_future().get().size() == 1);
  CHECK(ask(log, 3).get() == std::nullopt);
  log.shown(4, 9);
  CHECK(newer.get() == 9);
  CHECK(ask(log, 3).get() == 9);
}

TEST_CASE("who still waits at the end is told so") {
  std::future<std::optional<std::uint64_t>> waiting;
  {
    FrameLog log;
    waiting = ask(log, 2);
  }
  CHECK(waiting.get() == std::nullopt);
}

TEST_CASE("more revisions than the ring holds: none is lost for ever") {
  FrameLog log;
  auto waiting = ask(log, 5000);
  // As a render loop does: every frame tells what it showed.
  for (std::uint64_t frame = 1; frame <= 5000; ++frame) log.shown(frame, frame);
  while (waiting.wait_for(1ms) != std::future_status::ready) log.shown(5000, 5001);
  const auto got = waiting.get();
  REQUIRE(got);
  CHECK(*got >= 5000);
}

TEST_CASE("a replaced snapshot is freed when a newer one was shown, not before") {
  FrameLog log;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->revision = 1;
  const std::weak_ptr<const Snapshot> watch = snapshot;
  log.shown(1, 1);
  log.keep(std::move(snapshot));
  CHECK(ask(log, 1).get() == 1);
  CHECK_FALSE(watch.expired());
  log.shown(2, 2);
  CHECK(ask(log, 2).get() == 2);
  while (!watch.expired()) std::this_thread::yield(); // freed on the other thread, in a moment
}

TEST_CASE("snapshots do not pile up when nothing is shown") {
  FrameLog log;
  std::vector<std::weak_ptr<const Snapshot>> watched;
  for (int i = 1; i <= 200; ++i) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->revision = static_cast<cupola::model::Revision>(i);
    watched.push_back(snapshot);
    log.keep(std::move(snapshot));
  }
  const auto alive =
      std::count_if(watched.begin(), watched.end(), [](const auto& w) { return !w.expired(); });
  CHECK(alive == 64);
}
