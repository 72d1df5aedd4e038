// Windows on a virtual X server: what stands on the screen is compared with the picture presented.
#include <doctest/doctest.h>

#include <thread>

#include "renderer/outputs/desktop.h"
#include "renderer/outputs/main_thread.h"
#include "renderer/outputs/open.h"
#include "tests/renderer/outputs/picture.h"
#include "tests/support/virtual_display.h"

using namespace cupola;
using namespace std::chrono_literals;

namespace {

struct Windows {
  Windows() {
    REQUIRE_MESSAGE(display.ready(), "Xvfb does not start");
    std::vector<std::string>* lines = &log;
    auto made = outputs::Context::make_windowed(
        main, [lines](outputs::MessageLevel, std::string_view text) { lines->emplace_back(text); });
    if (!made) FAIL(model::to_text(made.error().front()));
    context = std::move(*made);
    REQUIRE(context->make_current());
  }
  ~Windows() {
    running.clear();
    context->release();
    main.serve();
    context.reset();
  }

  void open(const outputs::WantedOutputs& wanted) {
    auto opened = outputs::open_outputs(wanted, running, main, *context);
    if (!opened) FAIL(model::to_text(opened.error().front()));
    running = std::move(*opened);
    main.serve();
  }

  /// Presents until `seen(screen)` holds: the X server takes the picture in its own time.
  template <class Seen>
  bool present_until(const std::vector<const outputs::Frame*>& frames, Seen seen) {
    for (int i = 0; i < 200; ++i) {
      std::size_t next = 0;
      for (auto& [name, entry] : running) entry.output->draw(*frames[next++ % frames.size()]);
      for (auto& [name, entry] : running) entry.output->present();
      context->desktop()->listen();
      if (seen(display.screen())) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  std::vector<std::string> log;
  tests::VirtualDisplay display;
  outputs::MainThread main;
  std::unique_ptr<outputs::Context> context;
  outputs::RunningOutputs running;
};

model::Output window(int width, int height, int x, int y) {
  model::Output output;
  model::WindowOutput sink;
  sink.x = x;
  sink.y = y;
  output.sink = sink;
  output.width = width;
  output.height = height;
  return output;
}

/// Pixels of the screen at (x, y) … that differ from the test picture.
int differences(const tests::Screen& screen, int x0, int y0, int width, int height, int seed) {
  int wrong = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* rgb = screen.at(x0 + x, y0 + y);
      if (tests::Rgb{rgb[0], rgb[1], rgb[2]} != tests::pattern(x, y, seed)) ++wrong;
    }
  return wrong;
}

} // namespace

TEST_CASE_FIXTURE(Windows, "several windows show their pictures, byte for byte") {
  const tests::TestPicture left(320, 200, 1), right(300, 240, 90);
  open({{"a", window(320, 200, 20, 30)}, {"b", window(300, 240, 500, 300)}});
  CHECK(running.at("a").output->describe().find("window, 320x200 on monitor") == 0);
  CHECK(present_until({&left.frame, &right.frame}, [&](const tests::Screen& screen) {
    return differences(screen, 20, 30, 320, 200, 1) == 0 && differences(screen, 500, 300, 300, 240, 90) == 0;
  }));
  CHECK(running.at("a").output->counters().presented > 0);
  CHECK(running.at("a").output->counters().presented == running.at("b").output->counters().presented);
}

TEST_CASE_FIXTURE(Windows, "a picture of another shape is letterboxed over a full screen") {
  const tests::TestPicture picture(320, 320);
  model::Output output;
  model::WindowOutput sink;
  sink.fullscreen = true;
  output.sink = sink;
  output.width = output.height = 320;
  open({{"wall", output}});
  // 1280x800: the square is 800 high and stands in the middle, 240 black to the left and right.
  CHECK(present_until({&picture.frame}, [&](const tests::Screen& screen) {
    const auto black = [&](int x, int y) {
      const std::uint8_t* rgb = screen.at(x, y);
      return rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0;
    };
    const std::uint8_t* middle = screen.at(240 + 100, 400); // blue of pattern() at (40, 160), magnified
    return black(0, 0) && black(239, 400) && black(1041, 799) &&
           std::abs(middle[2] - (40 + 160 * 3 + 40) % 256) < 4;
  }));
}

TEST_CASE_FIXTURE(Windows, "automatic outputs get windows beside one another; a changed one is opened anew") {
  const tests::TestPicture picture(320, 200, 7);
  model::Output automatic;
  automatic.width = 320;
  automatic.height = 200;
  open({{"a", automatic}, {"b", automatic}});
  CHECK(running.at("a").output->describe().find("window") == 0);
  const auto kept = running.at("a").output;
  automatic.width = 300;
  model::Output headless = automatic;
  headless.sink = model::HeadlessOutput{};
  auto wanted = outputs::WantedOutputs{{"a", running.at("a").wanted}, {"b", headless}};
  open(wanted);
  CHECK(running.at("a").output == kept); // untouched
  CHECK(running.at("b").output->describe() == "headless 300x200");
}

TEST_CASE_FIXTURE(Windows, "a monitor that does not exist is a problem that names those that do") {
  model::Output output = window(100, 100, 0, 0);
  std::get<model::WindowOutput>(output.sink).monitor = "HDMI-7";
  const auto opened = outputs::open_outputs({{"wall", output}}, {}, main, *context);
  REQUIRE_FALSE(opened);
  const model::Problem& problem = opened.error().front();
  CHECK(problem.code == model::Code::output_unavailable);
  CHECK(problem.pointer == "/outputs/wall/monitor");
  CHECK(problem.found == "\"HDMI-7\"");
  CHECK(problem.expected.find("0 (" + context->desktop()->monitors().front().name + ")") !=
        std::string::npos);
  std::get<model::WindowOutput>(output.sink).monitor = "0";
  CHECK(outputs::test_outputs({{"wall", output}}, *context).empty());
}

TEST_CASE_FIXTURE(Windows, "only one window waits for the monitor") {
  const tests::TestPicture picture(64, 64);
  open({{"a", window(64, 64, 0, 0)}, {"b", window(64, 64, 100, 0)}});
  CHECK(running.at("a").output->can_wait());
  running.at("a").output->set_waiting(true);
  CHECK(present_until({&picture.frame}, [&](const tests::Screen& screen) {
    return differences(screen, 0, 0, 64, 64, 0) == 0 && differences(screen, 100, 0, 64, 64, 0) == 0;
  }));
  CHECK(running.at("b").output->pace().refresh_hz == 0.0);
}

TEST_CASE("without a display there is a reason, not a crash") {
  unsetenv("DISPLAY");
  outputs::MainThread main;
  const auto context = outputs::Context::make_windowed(main, {});
  REQUIRE_FALSE(context);
  CHECK(context.error().front().code == model::Code::output_unavailable);
  setenv("DISPLAY", ":4711", 1); // nobody there
  const auto other = outputs::Context::make_windowed(main, {});
  REQUIRE_FALSE(other);
  CHECK(other.error().front().code == model::Code::output_unavailable);
  unsetenv("DISPLAY");
}
