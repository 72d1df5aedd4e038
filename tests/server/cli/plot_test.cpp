#include "server/cli/plot.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <regex>
#include <string>
#include <vector>

using namespace cupola::cli;

namespace {

/// Centres of all points, in the order of the curves.
std::vector<glm::dvec2> points(const std::string& svg) {
  static const std::regex circle(R"re(<circle cx="([0-9.]+)" cy="([0-9.]+)")re");
  std::vector<glm::dvec2> all;
  for (auto i = std::sregex_iterator(svg.begin(), svg.end(), circle); i != std::sregex_iterator(); ++i)
    all.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  return all;
}

} // namespace

TEST_CASE("axes are logarithmic: equal factors are equal distances, upwards is more") {
  const std::string svg =
      log_log_chart({{"things", {{"one", "#00f", false, {{10, 1}, {100, 10}, {1000, 100}}}}}}, "ms");
  const auto at = points(svg);
  REQUIRE(at.size() == 3);
  CHECK(at[1].x - at[0].x == doctest::Approx(at[2].x - at[1].x).epsilon(0.01));
  CHECK(at[0].y - at[1].y == doctest::Approx(at[1].y - at[2].y).epsilon(0.01));
  CHECK(at[2].y < at[0].y);
  CHECK(svg.find(">things</text>") != std::string::npos);
  CHECK(svg.find(">ms</text>") != std::string::npos);
}

TEST_CASE("every panel has its own room and range") {
  const Curve small{"small", "#00f", false, {{1, 2}, {2, 3}}},
      large{"large", "#f00", true, {{1e6, 5e4}, {2e6, 8e4}}};
  const std::string svg = log_log_chart({{"a", {small}}, {"b", {large}}, {"c", {small, large}}}, "ms");
  const auto at = points(svg);
  REQUIRE(at.size() == 8);
  CHECK(std::max(at[0].x, at[1].x) < std::min(at[2].x, at[3].x)); // side by side
  CHECK(std::max(at[0].y, at[2].y) < std::min(at[4].y, at[6].y)); // and below
  CHECK(svg.find(">1 M</text>") != std::string::npos);
}

TEST_CASE("a single value has a range all the same") {
  const auto at = points(log_log_chart({{"a", {{"one", "#00f", false, {{1, 1}}}}}}, "ms"));
  REQUIRE(at.size() == 1);
  CHECK(at[0].x > 0.0);
}
