#include "server/control/http/picture.h"

#include <atomic>
#include <condition_variable>
#include <doctest/doctest.h>
#include <future>
#include <thread>

#include "server/control/http/pictures.h"

using namespace cupola;
using namespace cupola::control;
using namespace std::chrono_literals;

namespace {

RgbPicture flat(int width, int height, std::uint8_t value) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3,
                                    value)};
}

} // namespace

TEST_CASE("scaling averages by share") {
  RgbPicture picture = flat(3, 2, 0);
  for (std::size_t y = 0; y < 2; ++y)
    for (std::size_t c = 0; c < 3; ++c) {
      picture.rgb[(y * 3 + 0) * 3 + c] = 30;
      picture.rgb[(y * 3 + 1) * 3 + c] = 60;
      picture.rgb[(y * 3 + 2) * 3 + c] = 90;
    }
  const RgbPicture half = scaled(picture, 2); // 1.5 source pixels each: (30 + 60/2)/1.5, (60/2 + 90)/1.5
  CHECK(half.width == 2);
  CHECK(half.height == 1);
  CHECK(half.rgb == std::vector<std::uint8_t>{40, 40, 40, 80, 80, 80});
}

TEST_CASE("a flat picture stays flat at every width, and nothing is enlarged") {
  const RgbPicture picture = flat(101, 37, 173);
  for (const int width : {1, 2, 7, 50, 64, 99, 100}) {
    CAPTURE(width);
    const RgbPicture small = scaled(picture, width);
    CHECK(small.width == width);
    CHECK(small.rgb == flat(small.width, small.height, 173).rgb);
  }
  for (const int width : {0, 101, 5000}) CHECK(scaled(picture, width).width == 101);
}

TEST_CASE("both formats are encoded") {
  const auto png = encode(flat(64, 48, 99), PictureFormat::png);
  REQUIRE(png);
  CHECK(png->substr(0, 8) == "\x89PNG\r\n\x1a\n");
  const auto jpeg = encode(flat(64, 48, 99), PictureFormat::jpeg);
  REQUIRE(jpeg);
  CHECK(jpeg->substr(0, 3) == "\xff\xd8\xff");
}

TEST_CASE("who asks while a snapshot is under way shares the next one, never an older picture") {
  std::mutex mutex;
  std::condition_variable moved;
  std::vector<std::function<void(model::Result<RgbPicture>)>> asked;
  Pictures pictures(
      [&](const std::string&, auto deliver) {
        const std::lock_guard lock(mutex);
        asked.push_back(std::move(deliver));
        moved.notify_all();
      },
      60s);
  std::atomic<int> first{0}, later{0};
  const PictureKey key{"main", PictureFormat::jpeg, 0};
  pictures.request(key, [&](const auto& bytes) { first += bytes ? 1 : 100; });
  for (int i = 0; i < 10; ++i)
    pictures.request(key, [&](const auto& bytes) {
      later += bytes ? 1 : 100;
      moved.notify_all();
    });
  REQUIRE(asked.size() == 1);
  asked[0](flat(8, 8, 1));
  {
    std::unique_lock lock(mutex);
    moved.wait(lock, [&] { return asked.size() == 2; });
  }
  CHECK(later == 0);
  asked[1](flat(8, 8, 2));
  while (later < 10) std::this_thread::yield();
  CHECK(first == 1);
  CHECK(asked.size() == 2);
}

TEST_CASE("a source that fails, that never answers, or that answers too late") {
  std::function<void(model::Result<RgbPicture>)> kept;
  Pictures pictures(
      [&](const std::string& output, auto deliver) {
        if (output == "bad")
          deliver(model::failure({model::Code::output_unavailable, "", "a monitor", "none", {}, {}}));
        else
          kept = std::move(deliver);
      },
      20ms);
  const auto ask = [&](const char* output) {
    std::promise<model::Result<std::string>> answered;
    pictures.request({output, PictureFormat::png, 0}, [&](const auto& bytes) { answered.set_value(bytes); });
    return answered.get_future().get();
  };
  CHECK(ask("bad").error()[0].code == model::Code::output_unavailable);
  CHECK(ask("silent").error()[0].code == model::Code::no_picture);
  kept(flat(8, 8, 0)); // nobody waits any more
  CHECK(ask("silent").error()[0].code == model::Code::no_picture);
}

TEST_CASE("a picture that arrives after the end is nobody's") {
  std::function<void(model::Result<RgbPicture>)> kept;
  {
    Pictures pictures([&](const std::string&, auto deliver) { kept = std::move(deliver); }, 60s);
    pictures.request({"main", PictureFormat::png, 0}, [](const auto&) {});
  }
  REQUIRE(kept);
  kept(flat(8, 8, 0));
}
