#include "server/daemon/status.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "server/daemon/faults.h"
#include "server/daemon/show_file.h"

using namespace cupola;

namespace {

frame::LoopStatus running() {
  frame::LoopStatus status;
  status.frames = 120;
  status.late = 2;
  status.fps = 59.94;
  status.last.revision = 7;
  status.last.automatic_quality = true;
  status.last.quality = {16, 4, 2};
  status.outputs = {{"wall", "headless 640x380", 640, 380, 120, 0}, {"takes", "files", 64, 48, 100, 20}};
  return status;
}

model::Problem problem(const std::string& found) {
  return {model::Code::image_unwritable, "/outputs/takes", "a disk", found, ""};
}

} // namespace

TEST_CASE("the line that systemd shows") {
  CHECK(daemon::status_line(running()) == "revision 7, 59.9 frames a second, 2 late, 2 outputs");
  frame::LoopStatus one = running();
  one.outputs.resize(1);
  CHECK(daemon::status_line(one) == "revision 7, 59.9 frames a second, 2 late, 1 output");
}

TEST_CASE("the status on the network has outputs by name and problems as every answer has them") {
  const model::Json json = daemon::status_json(running(), {problem("a full one")});
  CHECK(json["shown_revision"] == 7);
  CHECK(json["late_frames"] == 2);
  CHECK(json["quality"] ==
        model::Json{{"automatic", true}, {"anisotropy", 16}, {"samples", 4}, {"supersampling", 2}});
  CHECK(json["outputs"]["takes"]["frames"] == 100);
  CHECK(json["outputs"]["takes"]["dropped"] == 20);
  REQUIRE(json["problems"].size() == 1);
  CHECK(json["problems"][0]["code"] == "OUT-102");
  CHECK(json["problems"][0]["pointer"] == "/outputs/takes");
  CHECK(json["problems"][0]["text"].get<std::string>().find("[OUT-102]") != std::string::npos);
}

TEST_CASE("a revision that cannot be shown is a fault until a newer one is shown") {
  daemon::Faults faults;
  faults.shown(1);
  faults.add_failed(2, {problem("two")});
  faults.shown(1); // the old one goes on
  REQUIRE(faults.now().size() == 1);
  faults.shown(3);
  CHECK(faults.now().empty());
}

TEST_CASE("of other faults the latest few are kept") {
  daemon::Faults faults;
  for (int i = 0; i < 100; ++i) faults.add({problem(std::to_string(i))});
  const model::Problems now = faults.now();
  REQUIRE_FALSE(now.empty());
  CHECK(now.size() < 20);
  CHECK(now.back().found == "99");
}

TEST_CASE("exit codes tell an unreadable file from a wrong show") {
  CHECK(daemon::exit_code_of({{model::Code::out_of_range, "/frame_rate", "", "", ""}}) == daemon::exit_show);
  CHECK(daemon::exit_code_of({{model::Code::file_unreadable, "", "", "", ""}}) == daemon::exit_usage);
}
