// The frame loop on a real context and real outputs, with a stand-in for the renderer.
#include "renderer/frame/loop.h"

#include <doctest/doctest.h>
#include <poll.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <mutex>

#include "renderer/outputs/image_file.h"
#include "renderer/outputs/main_thread.h"
#include "tests/renderer/frame/stand_in.h"

using namespace cupola;
using namespace std::chrono_literals;

namespace {

/// A show of headless outputs, 16x9 pixels each, painted in linear (red, 0, 0).
std::shared_ptr<frame::Stage> stage(std::uint64_t revision, double red,
                                    const std::vector<std::string>& outputs = {"main"}) {
  model::Show show;
  show.frame_rate = 200.0;
  show.background = {red, 0.0, 0.0};
  for (const std::string& name : outputs) {
    model::Output output;
    output.sink = model::HeadlessOutput{};
    output.width = 16;
    output.height = 9;
    show.outputs[name] = output;
  }
  auto made = std::make_shared<frame::Stage>();
  made->revision = revision;
  made->show = std::make_shared<const model::Show>(show);
  return made;
}

struct Running {
  explicit Running(std::shared_ptr<const frame::Stage> first)
      : newest(std::move(first)) {
    tests::stand_in().frames_to_realise = 0;
    tests::stand_in().fails_at = 0;
    tests::stand_in().milliseconds_a_frame = 0;
    auto made = outputs::Context::make_headless({});
    REQUIRE(made);
    context = std::move(*made);
    frame::LoopHooks hooks;
    hooks.stage = [this] {
      const std::lock_guard lock(mutex);
      return newest;
    };
    hooks.shown = [this](std::uint64_t revision, std::uint64_t frame) {
      const std::lock_guard lock(mutex);
      if (shown.empty() || shown.back().first != revision) shown.emplace_back(revision, frame);
    };
    hooks.failed = [this](std::uint64_t revision, const model::Problems& problems) {
      const std::lock_guard lock(mutex);
      failed.emplace_back(revision, problems);
    };
    hooks.problems = [this](const model::Problems& problems) {
      const std::lock_guard lock(mutex);
      reported.insert(reported.end(), problems.begin(), problems.end());
    };
    hooks.ended = [] {};
    loop = std::make_unique<frame::Loop>(*context, main, std::move(hooks));
  }

  void offer(std::shared_ptr<const frame::Stage> next) {
    const std::lock_guard lock(mutex);
    newest = std::move(next);
  }

  /// Serves the main thread until `done` holds.
  template <class Done>
  void until(Done done) {
    const auto give_up = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < give_up) {
      {
        const std::lock_guard lock(mutex);
        if (done()) return;
      }
      pollfd entry{main.fd(), POLLIN, 0};
      poll(&entry, 1, 2);
      main.serve();
    }
    FAIL("waited in vain");
  }
  void until_shown(std::uint64_t revision) {
    until([&] { return !shown.empty() && shown.back().first == revision; });
  }

  model::Result<frame::Snapshot> picture(const std::string& output, std::optional<int> width = {}) {
    auto promise = std::make_shared<std::promise<model::Result<frame::Snapshot>>>();
    auto future = promise->get_future();
    loop->snapshot(output, width,
                   [promise](model::Result<frame::Snapshot> got) { promise->set_value(std::move(got)); });
    until([&] { return future.wait_for(0s) == std::future_status::ready; });
    return future.get();
  }

  std::mutex mutex;
  std::shared_ptr<const frame::Stage> newest;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> shown;
  std::vector<std::pair<std::uint64_t, model::Problems>> failed;
  model::Problems reported;
  outputs::MainThread main;
  std::unique_ptr<outputs::Context> context;
  std::unique_ptr<frame::Loop> loop;
};

} // namespace

TEST_CASE("frames are shown, counted and can be looked at") {
  Running run(stage(1, 1.0, {"left", "right"}));
  run.until_shown(1);
  CHECK(run.shown.front().second == 1); // the first frame says so
  const auto picture = run.picture("right");
  REQUIRE(picture);
  CHECK(picture->output == "right");
  CHECK(picture->revision == 1);
  CHECK(picture->width == 16);
  CHECK(picture->height == 9);
  REQUIRE(picture->rgb.size() == 16 * 9 * 3);
  CHECK(picture->rgb[0] == 255);
  CHECK(picture->rgb[1] == 0);
  run.until([&] { return run.loop->status().frames > 20; });
  const frame::LoopStatus status = run.loop->status();
  CHECK(status.device.name == "stand-in");
  CHECK(status.last.revision == 1);
  REQUIRE(status.outputs.size() == 2);
  CHECK(status.outputs[0].name == "left");
  CHECK(status.outputs[0].presented + 1 >= status.frames);
  CHECK(status.fps > 0.0);
  CHECK_FALSE(run.loop->end().has_value());
}

TEST_CASE("what a frame takes beside drawing is told apart from drawing and from waiting") {
  Running run(stage(1, 1.0));
  tests::stand_in().milliseconds_a_frame = 50;
  tests::stand_in().beside_ms = -1.0;
  run.until([&] { return run.loop->status().frames > 5; });
  const double slow = tests::stand_in().beside_ms;
  CHECK(slow >= 0.0);
  const double mean = run.loop->status().frame_mean_ms;
  CHECK(slow < mean - 20.0); // most of a frame is drawing
}

TEST_CASE("a picture of an output that does not exist names the nearest one") {
  Running run(stage(1, 1.0));
  run.until_shown(1);
  const auto picture = run.picture("mian");
  REQUIRE_FALSE(picture);
  CHECK(picture.error().front().code == model::Code::unknown_resource);
  CHECK(picture.error().front().advice.find("main") != std::string::npos);
}

TEST_CASE("pictures are scaled down on request, never up") {
  Running run(stage(1, 0.5));
  run.until_shown(1);
  const auto small = run.picture("main", 8);
  REQUIRE(small);
  CHECK(small->width == 8);
  CHECK(small->height == 4);
  CHECK(small->rgb[0] == doctest::Approx(188).epsilon(0.01)); // linear 0.5 in sRGB
  const auto large = run.picture("main", 800);
  REQUIRE(large);
  CHECK(large->width == 16);
}

TEST_CASE("a newer stage takes over between two frames, and the old one shows until it is ready") {
  Running run(stage(1, 1.0));
  run.until_shown(1);
  tests::stand_in().frames_to_realise = 10;
  run.offer(stage(2, 0.0));
  run.until_shown(2);
  REQUIRE(run.shown.size() == 2);
  CHECK(run.shown[0].first == 1);
  CHECK(run.shown[1].first == 2);
  CHECK(run.picture("main")->rgb[0] == 0);
}

TEST_CASE("outputs come and go with the show") {
  Running run(stage(1, 1.0));
  run.until_shown(1);
  run.offer(stage(2, 1.0, {"main", "second"}));
  run.until_shown(2);
  CHECK(run.picture("second").has_value());
  run.until([&] { return run.loop->status().outputs.size() == 2; });
  run.offer(stage(3, 1.0, {"second"}));
  run.until_shown(3);
  CHECK_FALSE(run.picture("main").has_value());
  run.until([&] { return run.loop->status().outputs.size() == 1; });
}

TEST_CASE("outputs that cannot be opened leave the running ones alone") {
  Running run(stage(1, 1.0));
  run.until_shown(1);
  auto windowed = stage(2, 0.0);
  model::Show show = *windowed->show;
  show.outputs["wall"].sink = model::WindowOutput{};
  windowed->show = std::make_shared<const model::Show>(show);
  run.offer(windowed);
  run.until([&] { return !run.failed.empty(); });
  CHECK(run.failed.front().first == 2);
  CHECK(run.failed.front().second.front().code == model::Code::output_unavailable);
  CHECK(run.failed.front().second.front().pointer == "/outputs/wall");
  CHECK(run.picture("main")->revision == 1);
  run.offer(stage(3, 0.0)); // the next one is taken as if nothing had been
  run.until_shown(3);
  CHECK(run.failed.size() == 1);
}

TEST_CASE("a stage that cannot be realised is reported, and the old picture stays") {
  Running run(stage(1, 1.0));
  run.until_shown(1);
  tests::stand_in().fails_at = 2;
  run.offer(stage(2, 0.0, {"main", "more"}));
  run.until([&] { return !run.failed.empty(); });
  CHECK(run.failed.front().first == 2);
  const auto picture = run.picture("main");
  REQUIRE(picture);
  CHECK(picture->revision == 1);
  CHECK(picture->rgb[0] == 255);
  CHECK(run.loop->status().outputs.size() == 1);
}

TEST_CASE("late frames are counted") {
  Running run(stage(1, 1.0));
  tests::stand_in().milliseconds_a_frame = 12; // at 200 frames a second
  run.until([&] { return run.loop->status().late >= 5; });
  CHECK(run.loop->status().frame_mean_ms >= 5.0);
}

TEST_CASE("image files are written by the same loop") {
  const auto folder = std::filesystem::temp_directory_path() / ("cupola-loop-" + std::to_string(getpid()));
  auto first = stage(1, 1.0);
  model::Show show = *first->show;
  show.outputs["main"].sink = model::FilesOutput{folder.string(), "png", 4};
  first->show = std::make_shared<const model::Show>(show);
  {
    Running run(first);
    run.until([&] {
      const auto status = run.loop->status();
      return !status.outputs.empty() && status.outputs[0].presented == 4;
    });
  }
  const auto picture = outputs::read_image(folder / "main-000003.png");
  REQUIRE(picture);
  CHECK(picture->width == 16);
  CHECK(picture->rgba[0] == 255);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a first show whose outputs cannot be opened ends the loop") {
  auto first = stage(1, 1.0);
  model::Show show = *first->show;
  show.outputs["main"].sink = model::FilesOutput{"/proc/nowhere", "png", 0};
  first->show = std::make_shared<const model::Show>(show);
  Running run(first);
  run.until([&] { return run.loop->end().has_value(); });
  CHECK(run.loop->end() == frame::LoopEnd::failed);
  REQUIRE(run.failed.size() == 1);
  CHECK(run.failed.front().second.front().code == model::Code::image_unwritable);
}

TEST_CASE("ending answers everybody and leaves nothing behind") {
  std::atomic<int> answers = 0;
  {
    Running run(stage(1, 1.0));
    run.until_shown(1);
    for (int i = 0; i < 400; ++i)
      run.loop->snapshot("main", {}, [&](const model::Result<frame::Snapshot>&) { ++answers; });
    run.loop->stop();
    run.until([&] { return run.loop->end().has_value(); });
    CHECK(run.loop->end() == frame::LoopEnd::stopped);
    CHECK_FALSE(run.picture("main").has_value());
  }
  CHECK(answers == 400);
  CHECK(tests::stand_in().alive == 0);
}
