#include "server/control/http/body.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using cupola::control::parse_body;
using cupola::model::Code;
using cupola::model::Json;

TEST_CASE("a body is JSON, in its order") {
  const auto parsed = parse_body(R"({"b": 1, "a": [1.5, null, "x"]})");
  REQUIRE(parsed);
  CHECK(parsed->dump() == R"({"b":1,"a":[1.5,null,"x"]})");
  CHECK(parse_body("120") == Json(120));
  CHECK(parse_body(" \"word\" ") == Json("word"));
}

TEST_CASE("what is not JSON is refused with its place") {
  struct Case {
    std::string text;
    Code code;
    std::size_t line, column;
  };
  const std::string deep(100'000, '[');
  std::string many = "{";
  for (int i = 0; i < 10'001; ++i) many += (i ? ",\"" : "\"") + std::to_string(i) + "\":0";
  many += '}';
  for (const Case& one :
       {Case{"", Code::json_syntax, 1, 1}, Case{"{\"a\": 1,\n  }", Code::json_syntax, 2, 3},
        Case{"{\"a\": NaN}", Code::json_syntax, 1, 7}, Case{"1e400", Code::json_syntax, 0, 0},
        Case{"\"\xff\"", Code::json_syntax, 1, 2}, Case{"{} {}", Code::json_syntax, 1, 4},
        Case{"{\"a\": 1, \"a\": 2}", Code::json_duplicate_key, 0, 0},
        Case{"{\"x\": {\"a\": 1}, \"y\": {\"a\": 1, \"a\": 1}}", Code::json_duplicate_key, 0, 0},
        Case{deep, Code::json_too_deep, 0, 0}, Case{many, Code::too_many, 0, 0}}) {
    CAPTURE(one.text.substr(0, 60));
    const auto parsed = parse_body(one.text);
    REQUIRE_FALSE(parsed);
    REQUIRE(parsed.error().size() == 1);
    CHECK(parsed.error()[0].code == one.code);
    CHECK(parsed.error()[0].at.line == one.line);
    CHECK(parsed.error()[0].at.column == one.column);
    CHECK_FALSE(parsed.error()[0].expected.empty());
    CHECK_FALSE(parsed.error()[0].found.empty());
  }
}

TEST_CASE("the same key in different objects is no repetition") {
  CHECK(parse_body(R"({"a": {"a": {"a": 1}}, "b": [{"a": 1}, {"a": 2}]})"));
}
