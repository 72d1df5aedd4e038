#include "server/state/live_state.h"

#include <condition_variable>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "tests/server/small_show.h"

using namespace cupola;
using namespace cupola::test;
using model::Code;
using model::Cost;
using model::Json;
using state::Answer;
using state::Snapshot;

namespace {

/// A loader of resources that counts, can be held up, and can be told to fail.
struct Loads {
  std::mutex mutex;
  std::condition_variable moved;
  int started = 0, finished = 0;
  bool hold = false, fail = false;

  state::Options options() {
    state::Options made;
    made.load_resources = [this](const model::Show&) -> model::Result<state::Resources> {
      std::unique_lock lock(mutex);
      const int number = ++started;
      moved.notify_all();
      moved.wait(lock, [this] { return !hold; });
      ++finished;
      if (fail)
        return model::failure({Code::scene_unreadable, "/scene/content/file", "a scene", "nothing", {}, {}});
      return state::Resources(std::make_shared<const FakeScene>(FakeScene{number}));
    };
    return made;
  }
  void set_hold(bool held) {
    const std::lock_guard lock(mutex);
    hold = held;
    moved.notify_all();
  }
  void wait_started(int count) {
    std::unique_lock lock(mutex);
    moved.wait(lock, [&] { return started >= count; });
  }
};

int scene_number(const Snapshot& snapshot) {
  return static_cast<const FakeScene*>(snapshot.resources.get())->number;
}

bool has(const Answer& answer, Code code, const std::string& pointer) {
  if (answer) return false;
  for (const model::Problem& problem : answer.error())
    if (problem.code == code && problem.pointer == pointer) return true;
  return false;
}

} // namespace

TEST_CASE("the first revision is whole") {
  Loads loads;
  const auto live = small_state(loads.options());
  const auto now = live->current();
  CHECK(now->revision == 1);
  CHECK(*now->document == model::to_json(*now->show));
  CHECK(now->plan->outputs.size() == 2);
  CHECK(scene_number(*now) == 1);
}

TEST_CASE("a change is published whole, with its cost, and the old snapshot stays as it was") {
  const auto live = small_state();
  const auto before = live->current();
  const Answer answer = set(*live, "/projections/wall/horizontal_fov", 120);
  REQUIRE(answer);
  CHECK(answer->revision == 2);
  CHECK(answer->cost == Cost::rebuild);
  REQUIRE(answer->differences.size() == 1);
  CHECK(answer->differences[0].pointer == "/projections/wall/horizontal_fov");
  const auto after = live->current();
  CHECK(after->revision == 2);
  CHECK(state::value_at(*after, "/projections/wall/horizontal_fov") == Json(120.0));
  CHECK(std::get<model::Cylinder>(after->show->projections.at("wall").shape).horizontal_fov.degrees == 120.0);
  CHECK(state::value_at(*before, "/projections/wall/horizontal_fov") == Json(180.0));
}

TEST_CASE("the answer comes after publication") {
  const auto live = small_state();
  std::promise<model::Revision> seen;
  live->submit({"test", {}, {{"/scene/fog/density", 0.25}}},
               [&](const Answer&) { seen.set_value(live->current()->revision); });
  CHECK(seen.get_future().get() == 2);
}

TEST_CASE("a change that alters nothing keeps the revision") {
  const auto live = small_state();
  const auto before = live->current();
  const Answer answer = set(*live, "/projections/wall/horizontal_fov", 180);
  REQUIRE(answer);
  CHECK(answer->revision == 1);
  CHECK(answer->differences.empty());
  CHECK(live->current() == before);
}

TEST_CASE("one bad edit refuses the whole change, with every problem") {
  const auto live = small_state();
  const auto before = live->current();
  const Answer answer = change(*live, {"test",
                                       {},
                                       {{"/scene/fog/density", 0.5},
                                        {"/projections/wall/horizontal_fov", 400},
                                        {"/outputs/main/viewports/all/method", "magic"}}});
  CHECK(has(answer, Code::out_of_range, "/projections/wall/horizontal_fov"));
  CHECK(has(answer, Code::unknown_choice, "/outputs/main/viewports/all/method"));
  CHECK(live->current() == before);
}

TEST_CASE("references are checked: a projection in use cannot be removed, another can be put in its place") {
  const auto live = small_state();
  CHECK_FALSE(set(*live, "/projections/wall", nullptr));
  CHECK(live->current()->revision == 1);
  const Answer moved = change(
      *live,
      {"test", {}, {{"/projections/wall", nullptr}, {"/outputs/main/viewports/all/projection", "inset"}}});
  CHECK(moved);
}

TEST_CASE("null brings a parameter back to its default") {
  const auto live = small_state();
  REQUIRE(set(*live, "/projections/wall/zoom", 2.0));
  REQUIRE(set(*live, "/projections/wall/zoom", nullptr));
  CHECK(state::value_at(*live->current(), "/projections/wall/zoom") == Json(1.0));
  REQUIRE(set(*live, "/camera/look_to", Json::array({0, 0, -1})));
  REQUIRE(set(*live, "/camera/look_to", nullptr));
  CHECK(state::value_at(*live->current(), "/camera/look_to") == Json());
}

TEST_CASE("the kind of a projection can be changed live") {
  const auto live = small_state();
  REQUIRE(set(*live, "/projections/wall/kind", "fisheye"));
  CHECK(state::value_at(*live->current(), "/projections/wall/fov") == Json(180.0));
  CHECK_FALSE(state::value_at(*live->current(), "/projections/wall/vertical_fov"));
}

TEST_CASE("what only a restart can change is refused") {
  const auto live = small_state();
  const Answer answer = set(*live, "/control/http/port", 9000);
  CHECK(has(answer, Code::needs_restart, "/control/http/port"));
  CHECK(live->current()->revision == 1);
}

TEST_CASE("a change that expects another revision is refused") {
  const auto live = small_state();
  REQUIRE(set(*live, "/scene/fog/density", 0.1));
  const Answer late = change(*live, {"test", 1, {{"/scene/fog/density", 0.2}}});
  CHECK(has(late, Code::revision_moved, ""));
  CHECK(change(*live, {"test", 2, {{"/scene/fog/density", 0.2}}}));
}

TEST_CASE("resources are loaded only when the content changes, and shared otherwise") {
  Loads loads;
  const auto live = small_state(loads.options());
  REQUIRE(set(*live, "/scene/fog/density", 0.1));
  CHECK(scene_number(*live->current()) == 1);
  REQUIRE(set(*live, "/scene/content/size", 20));
  CHECK(scene_number(*live->current()) == 2);
}

TEST_CASE("content that cannot be loaded refuses the change") {
  Loads loads;
  const auto live = small_state(loads.options());
  const auto before = live->current();
  loads.fail = true;
  const Answer answer = set(*live, "/scene/content/size", 20);
  CHECK(has(answer, Code::scene_unreadable, "/scene/content/file"));
  CHECK(live->current() == before);
}

TEST_CASE("changes that wait for a load get revisions of their own and one more load for all") {
  Loads loads;
  const auto live = small_state(loads.options());
  loads.set_hold(true);
  std::promise<Answer> first;
  live->submit({"test", {}, {{"/scene/content/size", 11}}}, [&](const Answer& a) { first.set_value(a); });
  loads.wait_started(2);
  std::vector<std::promise<Answer>> later(50);
  for (int i = 0; i < 50; ++i)
    live->submit({"test", {}, {{"/scene/content/size", i == 20 ? -1 : 20 + i}}},
                 [&later, i](const Answer& a) { later[static_cast<std::size_t>(i)].set_value(a); });
  loads.set_hold(false);
  CHECK(first.get_future().get()->revision == 2); // the load in progress was not starved by newer changes
  model::Revision expected = 3;
  for (int i = 0; i < 50; ++i) {
    const Answer answer = later[static_cast<std::size_t>(i)].get_future().get();
    CAPTURE(i);
    if (i == 20)
      CHECK(has(answer, Code::out_of_range, "/scene/content/size"));
    else
      CHECK(answer.value().revision == expected++);
  }
  CHECK(live->current()->revision == 51);
  CHECK(state::value_at(*live->current(), "/scene/content/size") == Json(69.0));
  CHECK(loads.started == 3);
}

TEST_CASE("when the last of several loads fails, the others still hold") {
  Loads loads;
  state::Options options;
  std::atomic<bool> hold{true};
  std::atomic<int> started{0};
  options.load_resources = [&](const model::Show& show) -> model::Result<state::Resources> {
    if (++started == 2)
      while (hold) std::this_thread::yield();
    if (std::get<model::Room>(show.scene.content).size == 13.0)
      return model::failure({Code::scene_unreadable, "/scene/content", "a scene", "nothing", {}, {}});
    return state::Resources(std::make_shared<const FakeScene>());
  };
  const auto live = small_state(options);
  std::vector<std::promise<Answer>> answers(4);
  const auto send = [&](std::size_t i, const char* path, Json value) {
    live->submit({"test", {}, {{path, std::move(value)}}},
                 [&answers, i](const Answer& a) { answers[i].set_value(a); });
  };
  send(0, "/scene/content/size", 11);
  while (started < 2) std::this_thread::yield();
  send(1, "/scene/content/size", 12);
  send(2, "/scene/fog/density", 0.5);
  send(3, "/scene/content/size", 13);
  hold = false;
  CHECK(answers[0].get_future().get()->revision == 2);
  CHECK(answers[1].get_future().get()->revision == 3);
  CHECK(answers[2].get_future().get()->revision == 4);
  CHECK(has(answers[3].get_future().get(), Code::scene_unreadable, "/scene/content"));
  CHECK(live->current()->revision == 4);
  CHECK(state::value_at(*live->current(), "/scene/content/size") == Json(12.0));
}

TEST_CASE("a full queue refuses at once") {
  Loads loads;
  state::Options options = loads.options();
  options.max_waiting = 3;
  const auto live = small_state(options);
  loads.set_hold(true);
  std::promise<Answer> first;
  live->submit({"test", {}, {{"/scene/content/size", 11}}}, [&](const Answer& a) { first.set_value(a); });
  loads.wait_started(2);
  std::atomic<int> accepted{0}, refused{0};
  for (int i = 0; i < 5; ++i)
    live->submit({"test", {}, {{"/scene/fog/density", 0.1 * (i + 1)}}}, [&](const Answer& a) {
      if (a)
        ++accepted;
      else if (a.error()[0].code == Code::overloaded)
        ++refused;
    });
  CHECK(refused == 2);
  loads.set_hold(false);
  CHECK(first.get_future().get());
  while (accepted < 3) std::this_thread::yield();
  CHECK(live->current()->revision == 5);
}

TEST_CASE("at the end what waits is refused") {
  Loads loads;
  auto live = small_state(loads.options());
  loads.set_hold(true);
  std::promise<Answer> first, second;
  live->submit({"test", {}, {{"/scene/content/size", 11}}}, [&](const Answer& a) { first.set_value(a); });
  loads.wait_started(2);
  live->submit({"test", {}, {{"/scene/content/size", 12}}}, [&](const Answer& a) { second.set_value(a); });
  std::thread ending([&] { live.reset(); });
  // The end waits for the load in progress; let it come first as often as not.
  std::this_thread::sleep_for(20ms);
  loads.set_hold(false);
  ending.join();
  CHECK(first.get_future().get());
  CHECK(has(second.get_future().get(), Code::stopping, ""));
}

TEST_CASE("reload takes a file under the same rules") {
  Loads loads;
  const auto live = small_state(loads.options());
  const auto file = std::filesystem::temp_directory_path() / ("cupola_reload_" + std::to_string(getpid()));
  const auto reload = [&](const std::string& text) {
    std::ofstream(file) << text;
    std::promise<Answer> answered;
    live->reload(file, [&](const Answer& a) { answered.set_value(a); });
    return answered.get_future().get();
  };
  std::string text = small_show;

  const Answer same = reload(text);
  REQUIRE(same);
  CHECK(same->revision == 1);

  text.replace(text.find("180"), 3, "200");
  const Answer changed = reload(text);
  REQUIRE(changed);
  CHECK(changed->revision == 2);
  CHECK(loads.started == 1);

  text.replace(text.find("200"), 3, "999");
  const Answer broken = reload(text);
  REQUIRE(has(broken, Code::out_of_range, "/projections/wall/horizontal_fov"));
  CHECK(broken.error()[0].at.file == file.string());
  CHECK(broken.error()[0].at.line == 6);
  CHECK(live->current()->revision == 2);

  text.replace(text.find("999"), 3, "200");
  text.insert(text.find("\"name\""), "\"control\": {\"osc\": {\"port\": 9999}},\n");
  const Answer restart = reload(text);
  REQUIRE(has(restart, Code::needs_restart, "/control/osc/port"));
  CHECK(restart.error()[0].at.line == 3);
  std::filesystem::remove(file);

  const Answer missing = reload("");
  CHECK_FALSE(missing);
  std::filesystem::remove(file);
}

TEST_CASE("every leaf of the show can be read, set to itself, and refuses nonsense") {
  const auto live = small_state();
  const auto paths = model::leaf_paths(*live->current()->show);
  CHECK(paths.size() > 60);
  for (const std::string& path : paths) {
    CAPTURE(path);
    const auto value = state::value_at(*live->current(), path);
    REQUIRE(value);
    const Answer same = set(*live, path, *value);
    REQUIRE(same);
    CHECK(same->revision == 1);
    CHECK_FALSE(set(*live, path, Json::object({{"nonsense", 1}})));
    CHECK(live->current()->revision == 1);
  }
}

TEST_CASE("an unknown address has no value") {
  const auto live = small_state();
  const auto value = state::value_at(*live->current(), "/projections/wall/zom");
  REQUIRE_FALSE(value);
  CHECK(value.error()[0].code == Code::unknown_path);
  CHECK(value.error()[0].advice == "Did you mean \"zoom\"?");
}

TEST_CASE("many writers, a reader that never waits, and a renderer: every snapshot is whole") {
  const auto live = small_state();
  std::atomic<bool> done{false};
  std::atomic<int> answered{0}, torn{0};
  std::thread renderer([&] {
    std::uint64_t frame = 0;
    model::Revision last = 0;
    while (!done) {
      const auto now = live->current();
      if (now->revision < last) ++torn;
      last = now->revision;
      const auto& wall = std::get<model::Cylinder>(now->show->projections.at("wall").shape);
      if ((*now->document)["projections"]["wall"]["horizontal_fov"] != wall.horizontal_fov.degrees) ++torn;
      // Both are always set together.
      if (now->show->projections.at("wall").zoom != 1.0 &&
          now->show->projections.at("wall").zoom != now->show->projections.at("inset").zoom)
        ++torn;
      live->shown(now->revision, ++frame);
      std::this_thread::yield();
    }
  });
  std::vector<std::thread> writers;
  for (int w = 0; w < 3; ++w)
    writers.emplace_back([&, w] {
      for (int i = 0; i < 60; ++i) {
        const double zoom = 1.0 + w + 0.01 * i;
        live->submit({"test",
                      {},
                      {{"/projections/wall/zoom", zoom},
                       {"/projections/inset/zoom", zoom},
                       {"/projections/wall/horizontal_fov", 100 + i}}},
                     [&](const Answer& a) { answered += a ? 1 : 1000; });
      }
    });
  for (std::thread& writer : writers) writer.join();
  std::promise<std::optional<std::uint64_t>> shown;
  const Answer last = set(*live, "/projections/wall/horizontal_fov", 77);
  REQUIRE(last);
  live->when_shown(last->revision, 60s, [&](auto frame, const auto&) { shown.set_value(frame); });
  CHECK(shown.get_future().get());
  done = true;
  renderer.join();
  CHECK(answered == 180);
  CHECK(torn == 0);
}
