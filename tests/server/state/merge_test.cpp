#include "server/state/merge.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "configs/model/parameters.h"

using cupola::model::Code;
using cupola::model::Json;
using cupola::state::apply_edit;

namespace {

Json document() {
  cupola::model::Show show;
  show.projections["wall"].shape = cupola::model::Cylinder{};
  show.outputs["main"].viewports["all"].projection = "wall";
  show.camera.path.resize(3);
  for (int i = 0; i < 3; ++i) show.camera.path[static_cast<std::size_t>(i)].time = i;
  return cupola::model::to_json(show);
}

} // namespace

TEST_CASE("a value is set by its path, and nothing else changes") {
  Json got = document(), wanted = document();
  CHECK_FALSE(apply_edit(got, {"/projections/wall/horizontal_fov", 120}));
  wanted["projections"]["wall"]["horizontal_fov"] = 120;
  CHECK(got == wanted);
}

TEST_CASE("objects merge, null removes, as RFC 7396 says") {
  Json got = document();
  CHECK_FALSE(apply_edit(got, {"", Json::parse(R"({"scene": {"fog": {"density": 0.1}, "sun": null},
      "projections": {"new": {"kind": "fisheye"}, "wall": null}})")}));
  CHECK(got["scene"]["fog"]["density"] == 0.1);
  CHECK(got["scene"]["fog"].contains("color"));
  CHECK_FALSE(got["scene"].contains("sun"));
  CHECK(got["projections"].size() == 1);
  CHECK(got["projections"]["new"]["kind"] == "fisheye");
  CHECK_FALSE(apply_edit(got, {"/outputs/main", nullptr}));
  CHECK(got["outputs"].empty());
}

TEST_CASE("an array replaces an array") {
  Json got = document();
  CHECK_FALSE(apply_edit(got, {"/camera/position", Json::array({1, 2, 3})}));
  CHECK(got["camera"]["position"] == Json::array({1, 2, 3}));
}

TEST_CASE("the entries of a list have their index as address") {
  Json got = document();
  CHECK_FALSE(apply_edit(got, {"/camera/path/1/time", 1.5}));
  CHECK(got["camera"]["path"][1]["time"] == 1.5);
  CHECK_FALSE(apply_edit(got, {"/camera/path/0", nullptr}));
  CHECK(got["camera"]["path"].size() == 2);
  const auto beyond = apply_edit(got, {"/camera/path/2/time", 3});
  REQUIRE(beyond);
  CHECK(beyond->code == Code::unknown_path);
  CHECK(beyond->expected == "an index from 0 to 1");
}

TEST_CASE("the parameters of the former kind leave with it") {
  for (const cupola::model::Edit& edit :
       {cupola::model::Edit{"/projections/wall/kind", "fisheye"},
        cupola::model::Edit{"/projections/wall", Json::parse(R"({"kind": "fisheye"})")},
        cupola::model::Edit{"", Json::parse(R"({"projections": {"wall": {"kind": "fisheye"}}})")}}) {
    CAPTURE(edit.path);
    Json got = document();
    CHECK_FALSE(apply_edit(got, edit));
    CHECK(got["projections"]["wall"]["kind"] == "fisheye");
    CHECK_FALSE(got["projections"]["wall"].contains("horizontal_fov"));
    CHECK(got["projections"]["wall"].contains("zoom"));
  }
}

TEST_CASE("the same kind again keeps the parameters") {
  Json got = document();
  CHECK_FALSE(apply_edit(got, {"/projections/wall/kind", "cylinder"}));
  CHECK(got == document());
}

TEST_CASE("a new kind takes the parameters that come with it") {
  Json got = document();
  CHECK_FALSE(apply_edit(got, {"/projections/wall", Json::parse(R"({"kind": "perspective",
      "horizontal_fov": 50})")}));
  CHECK(got["projections"]["wall"]["horizontal_fov"] == 50);
  CHECK_FALSE(got["projections"]["wall"].contains("vertical_fov"));
}

TEST_CASE("an unknown address names the nearest key and alters nothing") {
  struct Case {
    const char* path;
    const char* advice;
  };
  for (const Case& one : {Case{"/projections/wall/horizontal_fow", "Did you mean \"horizontal_fov\"?"},
                          Case{"/projections/wal/zoom", "Did you mean \"wall\"?"},
                          Case{"/projection/wall/zoom", "Did you mean \"projections\"?"},
                          Case{"/projections/wall/zoom/x", "The address goes on beyond a value."},
                          Case{"projections/wall/zoom", "For example /quality/samples."},
                          Case{"/outputs/nothing_like_it/width", "Known here: main."}}) {
    CAPTURE(one.path);
    Json got = document();
    const auto problem = apply_edit(got, {one.path, 1});
    REQUIRE(problem);
    CHECK(problem->code == Code::unknown_path);
    CHECK(problem->advice == one.advice);
    CHECK(got == document());
  }
}
