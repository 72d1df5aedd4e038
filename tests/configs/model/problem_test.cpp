#include "configs/model/problem.h"

#include <doctest/doctest.h>
#include <set>

using namespace cupola::model;

TEST_CASE("every code has an id of its own, a title and an explanation") {
  std::set<std::string_view> ids;
  for (const CodeText& text : code_texts()) {
    CAPTURE(text.id);
    CHECK(ids.insert(text.id).second);
    CHECK(code_id(text.code) == text.id);
    CHECK(text.id.size() == 7);
    CHECK_FALSE(text.title.empty());
    CHECK(text.title.back() != '.');
    REQUIRE_FALSE(text.explanation.empty());
    CHECK(text.explanation.back() == '.');
  }
  CHECK(ids.size() > 40);
}

TEST_CASE("a problem in words: place, severity, pointer, sentence, advice, code") {
  Problem problem{Code::out_of_range, "/outputs/left/width", "an integer from 1 to 16384 px", "0",
                  "Use 1.",           {"show.json", 41, 17}};
  CHECK(to_text(problem) ==
        "show.json:41:17: error: /outputs/left/width: expected an integer from 1 to 16384 px, "
        "found 0. Use 1. [CFG-104]");
  problem.severity = Severity::warning;
  problem.at.line = 0;
  problem.advice.clear();
  CHECK(to_text(problem) ==
        "show.json: warning: /outputs/left/width: expected an integer from 1 to 16384 px, found "
        "0. [CFG-104]");
  problem.at = {};
  problem.pointer.clear();
  problem.expected.clear();
  CHECK(to_text(problem) == "warning: found 0. [CFG-104]");
  problem.found.clear();
  CHECK(to_text(problem) == "warning: The number is outside its range. [CFG-104]");
}

TEST_CASE("warnings are no errors") {
  Problem problem{Code::unused, "/projections/a"};
  problem.severity = Severity::warning;
  CHECK_FALSE(has_errors({}));
  CHECK_FALSE(has_errors({problem}));
  CHECK(has_errors({problem, Problem{Code::conflict}}));
}

TEST_CASE("the nearest known word, or none") {
  const std::vector<std::string> keys{"width", "height", "horizontal_fov", "vertical_fov", "x", "y", "fov"};
  CHECK(nearest("widht", keys) == "width");
  CHECK(nearest("Width", keys) == "width");
  CHECK(nearest("horizontal-fov", keys) == "horizontal_fov");
  CHECK(nearest("horizontalFov", keys) == "horizontal_fov");
  CHECK(nearest("FOV", keys) == "fov");
  CHECK(nearest("fow", keys) == "fov");
  CHECK(nearest("brightness", keys).empty());
  CHECK(nearest("abc", keys).empty());
  CHECK(nearest("", {}).empty());
  CHECK(nearest(std::string(100'000, 'a'), keys).empty());
}
