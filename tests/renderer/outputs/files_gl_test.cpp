#include "renderer/outputs/files.h"

#include <doctest/doctest.h>
#include <epoxy/gl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "renderer/outputs/image_file.h"
#include "tests/renderer/outputs/picture.h"

using namespace cupola;
namespace fs = std::filesystem;

namespace {

struct Fixture {
  Fixture() {
    auto made = outputs::Context::make_headless({});
    REQUIRE(made);
    context = std::move(*made);
    REQUIRE(context->make_current());
    fs::remove_all(folder);
  }
  ~Fixture() {
    context->release();
    fs::remove_all(folder);
  }

  std::unique_ptr<outputs::Output> open(const outputs::FilesOptions& options) {
    auto output = outputs::open_files(options);
    if (!output) FAIL(model::to_text(output.error().front()));
    return std::move(*output);
  }

  /// Presents frames until `done`; false when that takes too long.
  template <class Done>
  bool present_until(outputs::Output& output, const outputs::Frame& frame, Done done) {
    for (int i = 0; i < 5000 && !done(); ++i) {
      output.draw(frame);
      output.present();
      glFinish();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return done();
  }

  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  std::unique_ptr<outputs::Context> context;
  fs::path folder = fs::temp_directory_path() / ("cupola-files-" + std::to_string(getpid()));
};

} // namespace

TEST_CASE_FIXTURE(Fixture, "frames become numbered pictures without a gap, and stop at the limit") {
  const tests::TestPicture picture(40, 24);
  const auto output = open({"wall", 40, 24, folder / "deep", "png", 3});
  CHECK(output->describe().find("files 40x24") == 0);
  REQUIRE(present_until(*output, picture.frame, [&] { return output->counters().presented == 3; }));
  for (int i = 0; i < 20; ++i) {
    output->draw(picture.frame);
    glFinish();
  }
  CHECK(output->counters().presented == 3);
  CHECK(output->take_problems().empty());
  folder /= "deep";
  CHECK(files() == 3);
  const auto image = outputs::read_image(folder / "wall-000002.png");
  REQUIRE(image);
  REQUIRE(image->width == 40);
  const std::size_t at = (5 * 40 + 11) * 4; // x 11, y 5 from the top
  CHECK(tests::Rgb{image->rgba[at], image->rgba[at + 1], image->rgba[at + 2]} == tests::pattern(11, 5));
}

TEST_CASE_FIXTURE(Fixture, "a full disk costs pictures and one line, and heals") {
  const tests::TestPicture picture(200, 200);
  const auto output = open({"wall", 200, 200, folder, "png", 0});
  // No file may grow beyond this: what a full disk looks like to a writer.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  rlimit tiny = before;
  tiny.rlim_cur = 512;
  REQUIRE(setrlimit(RLIMIT_FSIZE, &tiny) == 0);
  const bool failed = present_until(*output, picture.frame, [&] { return output->counters().dropped >= 5; });
  setrlimit(RLIMIT_FSIZE, &before);
  REQUIRE(failed);
  const auto problems = output->take_problems();
  std::size_t unwritable = 0;
  for (const auto& problem : problems)
    if (problem.severity == model::Severity::error) ++unwritable;
  CHECK(unwritable == 1);
  CHECK(output->counters().presented == 0);
  REQUIRE(present_until(*output, picture.frame, [&] { return output->counters().presented >= 2; }));
  CHECK(fs::exists(folder / "wall-000000.png"));
  CHECK(outputs::read_image(folder / "wall-000001.png").has_value());
}

TEST_CASE_FIXTURE(Fixture, "a file in place of the folder is a problem, not a surprise later") {
  std::ofstream(folder) << "a file";
  const auto output = outputs::open_files({"wall", 8, 8, folder, "png", 0});
  REQUIRE_FALSE(output);
  CHECK(output.error().front().code == model::Code::image_unwritable);
  CHECK(output.error().front().pointer == "/outputs/wall/directory");
  CHECK(outputs::test_files({"wall", 8, 8, folder, "png", 0}).size() == 1);
  CHECK(outputs::test_files({"wall", 8, 8, folder / "below", "png", 0}).size() == 1);
  fs::remove(folder);
  CHECK(outputs::test_files({"wall", 8, 8, folder / "below", "png", 0}).empty());
  CHECK_FALSE(fs::exists(folder)); // a test makes nothing
}

TEST_CASE_FIXTURE(Fixture, "closing does not wait for a long queue") {
  const tests::TestPicture picture(1600, 1200);
  auto output = open({"wall", 1600, 1200, folder, "png", 0});
  for (int i = 0; i < 6; ++i) {
    output->draw(picture.frame);
    glFinish();
  }
  output.reset();
  for (const auto& entry : fs::directory_iterator(folder)) // nothing half-written is left
    CHECK(outputs::read_image(entry.path()).has_value());
}
