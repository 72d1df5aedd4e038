// The doors of cupolad with a live state behind them and no renderer: what the tests of HTTP, OSC, the
// command line and the page talk to. Prints {"http": PORT, "osc": PORT}, runs until standard input ends, and
// leaves through its destructors, so that sanitizers see everything.
//
//   fake_daemon [--tight]      --tight: limits of tenths of a second and 8 connections
//
// The show's name is a switch: "broken" has pictures fail, "silent" has none come, "still" has no frame
// shown. Pictures: red is twice the field of view of the projection "wall", green rises to the right, blue
// downwards.
#include <atomic>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <thread>
#include <unistd.h>

#include "configs/loader/loader.h"
#include "server/control/http/server.h"
#include "server/control/loop.h"
#include "server/control/osc/server.h"
#include "tests/server/small_show.h"

using namespace cupola;
using control::RgbPicture;

namespace {

RgbPicture picture_of(const model::Show& show, const std::string& name) {
  const model::Output& output = show.outputs.at(name);
  RgbPicture picture{output.width, output.height, {}};
  const auto* wall = std::get_if<model::Cylinder>(&show.projections.at("wall").shape);
  const double fov = wall ? wall->horizontal_fov.degrees : 0.0;
  for (int y = 0; y < output.height; ++y)
    for (int x = 0; x < output.width; ++x) {
      picture.rgb.push_back(static_cast<std::uint8_t>(fov * 0.5));
      picture.rgb.push_back(static_cast<std::uint8_t>(255 * x / output.width));
      picture.rgb.push_back(static_cast<std::uint8_t>(255 * y / output.height));
    }
  return picture;
}

control::SnapshotSource source_of(state::LiveState& live) {
  return [&live](const std::string& name, const std::function<void(model::Result<RgbPicture>)>& deliver) {
    // A picture comes from another thread, a moment later.
    std::thread([&live, name, deliver] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      const auto show = live.current()->show;
      if (show->name == "silent") return;
      if (show->name == "broken" || !show->outputs.contains(name))
        return deliver(model::failure(
            {model::Code::no_picture, "/outputs/" + name, "a picture", "a broken output", {}, {}}));
      deliver(picture_of(*show, name));
    }).detach();
  };
}

control::Limits limits_of(bool tight) {
  using std::chrono::milliseconds;
  if (!tight) return {};
  return {8, 4096, 64 * 1024, milliseconds(1500), milliseconds(300), milliseconds(300), milliseconds(2000)};
}

} // namespace

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("fake"));
  const bool tight = argc > 1 && std::strcmp(argv[1], "--tight") == 0;
  control::Loop loop;
  const auto live = test::small_state();
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> frames{0};
  std::thread renderer([&] {
    while (!done) {
      const auto now = live->current();
      if (now->show->name != "still") live->shown(now->revision, ++frames);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });

  control::Services services;
  services.version = "test";
  services.schema = loader::show_schema();
  services.snapshot = source_of(*live);
  services.picture_patience = std::chrono::milliseconds(1000);
  services.status = [&] {
    model::Json status = {{"device", "no device"}, {"fps", 59.9}, {"late_frames", 0}};
    status["outputs"] = {{"main", {{"frames", frames.load()}}}};
    status["problems"] = model::Json::array();
    if (live->current()->show->name == "broken")
      status["problems"].push_back({{"code", "OUT-101"},
                                    {"title", "The output cannot be opened"},
                                    {"severity", "error"},
                                    {"pointer", "/outputs/main"},
                                    {"expected", "a monitor named LEFT"},
                                    {"found", "HDMI-1, HDMI-2"},
                                    {"advice", "Name one of those."}});
    return status;
  };
  auto http = control::HttpServer::open(loop, *live, {true, "127.0.0.1", 0}, services, limits_of(tight));
  auto osc = control::OscServer::open(loop, *live, {true, "127.0.0.1", 0});
  if (!http || !osc) return 1;
  std::cout << model::Json{{"http", (*http)->port()}, {"osc", (*osc)->port()}}.dump() << std::endl;
  while (std::cin.get() != std::char_traits<char>::eof()) {}
  http->reset();
  osc->reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(20)); // snapshots under way still look at the state
  done = true;
  renderer.join();
}
