// A small show and a live state of it, for the tests of rooms in server/.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "configs/loader/loader.h"
#include "server/state/live_state.h"

namespace cupola::test {

using namespace std::chrono_literals;

inline const char* const small_show = R"({
  "version": 1,
  "name": "small",
  "scene": {"content": {"kind": "room"}},
  "projections": {
    "wall": {"kind": "cylinder", "horizontal_fov": 180, "vertical_fov": 60},
    "inset": {"kind": "perspective", "horizontal_fov": 70}
  },
  "outputs": {
    "main": {"kind": "headless", "width": 320, "height": 200,
             "viewports": {"all": {"projection": "wall", "method": "cubemap"}}},
    "side": {"kind": "headless", "width": 160, "height": 100,
             "viewports": {"all": {"projection": "inset", "method": "cubemap"}}}
  }
})";

/// What a loader of resources may give: told apart by its number.
struct FakeScene {
  int number = 0;
};

inline std::unique_ptr<state::LiveState> small_state(state::Options options = {},
                                                     const std::string& text = small_show) {
  auto loaded = loader::parse_show(text, "small.json");
  if (!loaded) throw std::runtime_error(model::to_text(loaded.error().front()));
  auto made = state::LiveState::make(std::move(*loaded), std::move(options));
  if (!made) throw std::runtime_error(model::to_text(made.error().front()));
  return std::move(*made);
}

/// Submits and waits for the answer.
inline state::Answer change(state::LiveState& live, model::Change asked) {
  std::promise<state::Answer> answered;
  live.submit(std::move(asked), [&](const state::Answer& answer) { answered.set_value(answer); });
  return answered.get_future().get();
}

inline state::Answer set(state::LiveState& live, const std::string& path, model::Json value) {
  return change(live, {"test", std::nullopt, {{path, std::move(value)}}});
}

} // namespace cupola::test
