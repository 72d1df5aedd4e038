#include "renderer/frame/pacer.h"

#include <doctest/doctest.h>

#include "renderer/frame/frame_times.h"

using namespace cupola::frame;

namespace {
constexpr Nanoseconds ms = 1'000'000;
}

TEST_CASE("frames begin on an absolute grid: lateness of a call does not add up") {
  Pacer pacer;
  pacer.restart(1000 * ms);
  Nanoseconds now = 1000 * ms;
  bool late = false;
  for (int i = 1; i <= 600; ++i) {
    now += 3 * ms + i % 5; // the frame itself
    now = pacer.next(now, 50.0, 0.0, late);
    CHECK_FALSE(late);
    CHECK(now == 1000 * ms + i * 20 * ms);
    now += ms / 10; // woken up a little late
  }
}

TEST_CASE("a late frame is followed at once, and what it missed is skipped") {
  Pacer pacer;
  pacer.restart(0);
  bool late = false;
  CHECK(pacer.next(47 * ms, 50.0, 0.0, late) == 47 * ms); // due at 20
  CHECK(late);
  CHECK(pacer.start() == 40 * ms); // show time is that of the grid point last passed
  CHECK(pacer.next(50 * ms, 50.0, 0.0, late) == 60 * ms);
  CHECK_FALSE(late);
}

TEST_CASE("a monitor of the same rate paces: its clock counts, not ours") {
  Pacer pacer;
  pacer.restart(0);
  bool late = false;
  Nanoseconds now = 0;
  const Nanoseconds refresh = 16'683'350; // 59.94 Hz, where the show says 60
  for (int i = 1; i <= 1000; ++i) {
    now = i * refresh; // presenting returned at the monitor's refresh
    CHECK(pacer.next(now, 60.0, 60.0, late) == now);
    CHECK_FALSE(late);
  }
  CHECK(pacer.next(now + 2 * refresh, 60.0, 60.0, late) == now + 2 * refresh);
  CHECK(late); // a refresh was missed
}

TEST_CASE("a monitor that does not wait is kept from running away") {
  Pacer pacer;
  pacer.restart(0);
  bool late = false;
  CHECK(pacer.next(1 * ms, 60.0, 60.0, late) == 14'999'999);
}

TEST_CASE("frame times cover the last seconds only") {
  FrameTimes times;
  CHECK(times.summary(0).fps == 0.0);
  for (int i = 0; i < 100; ++i) times.add(i * 100 * ms, 4 * ms); // ten a second
  times.add(9950 * ms, 14 * ms);
  const auto summary = times.summary(9950 * ms);
  CHECK(summary.fps == doctest::Approx(10.2).epsilon(0.01));
  CHECK(summary.mean_ms == doctest::Approx(4.2).epsilon(0.01));
  CHECK(summary.max_ms == doctest::Approx(14.0));
  for (int i = 0; i < 3000; ++i) times.add(20'000 * ms + i * ms, 1 * ms);
  CHECK(times.summary(23'000 * ms).max_ms == doctest::Approx(1.0));
}
