#include "renderer/outputs/layout.h"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace cupola::outputs;

TEST_CASE("a picture is letterboxed into a window of another shape") {
  CHECK(letterbox({640, 360}, {640, 360}) == Rect{0, 0, 640, 360});
  CHECK(letterbox({640, 360}, {1280, 720}) == Rect{0, 0, 1280, 720});
  CHECK(letterbox({400, 400}, {1000, 500}) == Rect{250, 0, 500, 500}); // bars left and right
  CHECK(letterbox({1000, 500}, {500, 500}) == Rect{0, 125, 500, 250}); // bars above and below
  CHECK(letterbox({16384, 1}, {100, 100}) == Rect{0, 49, 100, 1});     // never vanishes
  CHECK(letterbox({640, 360}, {0, 0}) == Rect{});                      // an iconified window
}

TEST_CASE("windows stand side by side and do not overlap") {
  const std::vector<Size> pictures{{640, 360}, {640, 360}, {360, 360}, {640, 320}};
  const auto placed = tile(pictures, {1920, 1080}, 10);
  REQUIRE(placed.size() == 4);
  CHECK(placed[0] == Rect{0, 0, 640, 360});
  CHECK(placed[1] == Rect{650, 0, 640, 360});
  CHECK(placed[2] == Rect{1300, 0, 360, 360});
  CHECK(placed[3] == Rect{0, 370, 640, 320});
}

TEST_CASE("windows shrink together until they fit") {
  const std::vector<Size> pictures(4, Size{1600, 1200});
  const auto placed = tile(pictures, {1920, 1080}, 0);
  REQUIRE(placed.size() == 4);
  for (const Rect& rect : placed) {
    CHECK(rect.x + rect.width <= 1920);
    CHECK(rect.y + rect.height <= 1080);
    CHECK(std::abs(rect.width * 3 - rect.height * 4) <= 3); // rounded to whole pixels
  }
  CHECK(placed[0].width == 533); // a third: at a half, two rows of 600 do not fit 1080
}
