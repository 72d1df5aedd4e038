#include "renderer/frame/quality_choice.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <functional>

using cupola::frame::quality_ladder;
using cupola::frame::QualityChoice;
using cupola::frame::QualityLevel;

namespace {

constexpr double period = 1000.0 / 60.0;

/// Costs of the six levels of a driver with eight samples, times a load.
double cost(const QualityLevel& level, double load) {
  double all = load * level.supersampling * level.supersampling;
  if (level.anisotropy > 1) all *= 2.0;
  if (level.samples > 1) all *= 1.4;
  if (level.samples > 4) all *= 1.2;
  return all;
}

struct Run {
  int changes = 0, late = 0;
};

/// Draws for so many seconds of show time.
Run draw(QualityChoice& choice, double seconds, const std::function<double(const QualityLevel&, int)>& time) {
  Run run;
  double passed = 0.0;
  for (int frame = 0; passed < seconds * 1000.0; ++frame) {
    const double taken = time(choice.level(), frame);
    passed += std::max(taken, period);
    if (taken > period) ++run.late;
    if (choice.record(taken, period)) ++run.changes;
  }
  return run;
}

QualityChoice fresh() { return QualityChoice(quality_ladder(16, 8, 3, false)); }

} // namespace

TEST_CASE("the ladder rises, and keeps to what the driver has") {
  const auto all = quality_ladder(16, 8, 3, false);
  CHECK(all.size() == 6);
  CHECK(all.front() == QualityLevel{1, 1, 1});
  CHECK(all.back() == QualityLevel{16, 4, 3});
  CHECK(quality_ladder(16, 4, 2, false).back() == QualityLevel{16, 4, 2});
  CHECK(quality_ladder(16, 4, 3, false).size() == 5); // the step from four to eight samples is none
  CHECK(quality_ladder(1, 1, 1, false).size() == 1);
  const auto software = quality_ladder(16, 4, 3, true);
  REQUIRE(software.size() == 5);
  CHECK(software[1] == QualityLevel{1, 4, 1});
  CHECK(software[2] == QualityLevel{16, 4, 1});
  CHECK(quality_ladder(16, 1, 1, true) == quality_ladder(16, 1, 1, false)); // without multisampling
}

TEST_CASE("light work climbs to the top and stays") {
  QualityChoice choice = fresh();
  const Run run = draw(choice, 600.0, [](const QualityLevel& level, int) { return cost(level, 0.2); });
  CHECK(choice.level() == QualityLevel{16, 4, 3});
  CHECK(run.changes == 5);
  CHECK(run.late == 0);
}

TEST_CASE("the best that holds the rate is found, and what does not hold is tried once more only") {
  QualityChoice choice = fresh();
  // 1.8, 3.6, 5.0, 6.0 ms; drawn 2 x 2: 20.2 ms.
  const auto time = [](const QualityLevel& level, int) { return cost(level, 1.8); };
  const Run first = draw(choice, 10.0, time);
  CHECK(choice.level() == QualityLevel{16, 8, 1});
  CHECK(first.changes == 5); // three up, the trial, and back
  CHECK(first.late <= 22);   // two to warm up, and a window of 400 ms
  const Run later = draw(choice, 3600.0, time);
  CHECK(choice.level() == QualityLevel{16, 8, 1});
  CHECK(later.changes == 2); // the first measure could have been a bad moment; now it is known
  CHECK(later.late <= 22);
}

TEST_CASE("at one frame a second a level is judged by four frames") {
  QualityChoice choice = fresh();
  for (int frame = 0; frame < 5 * (QualityChoice::warming_frames + 4); ++frame) choice.record(20.0, 1000.0);
  CHECK(choice.level() == QualityLevel{16, 4, 3});
  int changes = 0; // one slow frame is none that needs less
  for (int frame = 0; frame < 200; ++frame) changes += choice.record(frame % 7 == 0 ? 1200.0 : 20.0, 1000.0);
  CHECK(changes == 0);
}

TEST_CASE("more work steps down at once, less work climbs again") {
  QualityChoice choice = fresh();
  draw(choice, 60.0, [](const QualityLevel& level, int) { return cost(level, 0.9); });
  CHECK(choice.level() == QualityLevel{16, 4, 2}); // 10.1 ms
  const Run heavy = draw(choice, 60.0, [](const QualityLevel& level, int) { return cost(level, 5.0); });
  CHECK(choice.level() == QualityLevel{16, 4, 1}); // 14 ms
  CHECK(heavy.late < 30);
  draw(choice, 120.0, [](const QualityLevel& level, int) { return cost(level, 0.9); });
  CHECK(choice.level() == QualityLevel{16, 4, 2});
}

TEST_CASE("times that waver and single slow frames change nothing for long") {
  QualityChoice choice = fresh();
  const auto time = [](const QualityLevel& level, int frame) {
    const double waver = 1.0 + 0.15 * ((frame * 7919) % 21 - 10) / 10.0;
    return cost(level, 2.2) * waver + (frame % 97 == 0 ? 30.0 : 0.0);
  };
  draw(choice, 30.0, time);
  const QualityLevel settled = choice.level();
  CHECK(settled.anisotropy == 16);
  CHECK(settled.supersampling == 1);
  const Run later = draw(choice, 3600.0, time);
  CHECK(choice.level() == settled);
  CHECK(later.changes <= 4);
}

TEST_CASE("a bad moment during a trial does not spoil a level for good") {
  QualityChoice choice = fresh();
  int frames_at_top = 0;
  const auto time = [&](const QualityLevel& level, int) {
    const bool top = level == QualityLevel{16, 4, 3};
    return cost(level, 0.2) + (top && ++frames_at_top < 8 ? 100.0 : 0.0);
  };
  draw(choice, 10.0, time);
  CHECK(choice.level() == QualityLevel{16, 4, 2});
  const Run later = draw(choice, 300.0, time);
  CHECK(choice.level() == QualityLevel{16, 4, 3});
  CHECK(later.changes == 1);
}

TEST_CASE("work that comes and goes is followed ever more seldom") {
  QualityChoice choice = fresh();
  double passed = 0.0;
  const auto time = [&](const QualityLevel& level, int) { // twenty seconds light, twenty heavy
    const double taken = cost(level, static_cast<long>(passed / 20'000.0) % 2 == 0 ? 1.0 : 4.5);
    passed += std::max(taken, period);
    return taken;
  };
  draw(choice, 600.0, time);
  const Run later = draw(choice, 3600.0, time);
  CHECK(later.changes < 40); // of 180 turns
}

TEST_CASE("the best at once, where no rate is to be held") {
  QualityChoice choice = fresh();
  choice.go_to_top();
  CHECK(choice.level() == QualityLevel{16, 4, 3});
  choice.refuse();
  CHECK(choice.level() == QualityLevel{16, 4, 2});
  choice.go_to_top();
  CHECK(choice.level() == QualityLevel{16, 4, 2});
}

TEST_CASE("work at the edge of what fits is tried ever more seldom") {
  QualityChoice choice = fresh();
  // Seen from below there is always room, but held it never is: a step that gets dearer while it lasts.
  int since = 0;
  QualityLevel last;
  const auto time = [&](const QualityLevel& level, int) {
    since = level == last ? since + 1 : 0;
    last = level;
    if (level == QualityLevel{16, 4, 1}) return since < 40 ? 8.0 : 40.0;
    return level.samples > 1 ? 40.0 : 6.0;
  };
  const Run run = draw(choice, 3600.0, time);
  CHECK(run.changes < 3 * 14); // waits double from 5 s to 10 min
}

TEST_CASE("a level that cannot be had is not asked for again until the work is another") {
  QualityChoice choice = fresh();
  draw(choice, 10.0, [](const QualityLevel& level, int) { return cost(level, 0.2); });
  REQUIRE(choice.level() == QualityLevel{16, 4, 3});
  choice.refuse();
  CHECK(choice.level() == QualityLevel{16, 4, 2});
  const Run run = draw(choice, 600.0, [](const QualityLevel& level, int) { return cost(level, 0.2); });
  CHECK(run.changes == 0);
  choice.restart(quality_ladder(16, 8, 3, false));
  CHECK(choice.level() == QualityLevel{16, 4, 2}); // goes on from where it was
  draw(choice, 10.0, [](const QualityLevel& level, int) { return cost(level, 0.2); });
  CHECK(choice.level() == QualityLevel{16, 4, 3});
}

TEST_CASE("a shorter ladder keeps the nearest level") {
  QualityChoice choice = fresh();
  draw(choice, 10.0, [](const QualityLevel& level, int) { return cost(level, 0.2); });
  choice.restart(quality_ladder(16, 8, 1, false));
  CHECK(choice.level() == QualityLevel{16, 8, 1});
}
