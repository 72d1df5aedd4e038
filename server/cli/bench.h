// What every benchmark prints: a table for people, or one JSON object with `device`, `rows` and `ratios`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cupola::cli {

struct BenchReport {
  std::string device;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array(); ///< objects with the same keys
  nlohmann::ordered_json ratios = nlohmann::ordered_json::object();
  std::vector<std::string> notes;
};

void print_report(const BenchReport& report, bool as_json);

/// Table 1 of Lorenz & Döllner (2009): plain perspective, cubemap and piecewise on the 360° cylinder, in one
/// process. Returns an exit code.
int bench_table1(bool as_json, bool quick);
int bench_fisheye(bool as_json, bool quick);

struct QualityOptions {
  bool json = false, quick = false;
  std::string pictures; ///< folder for close-ups; "": none
};
/// Both methods against rays: at matched density, at equal time, against any cubemap. Progress on standard
/// error.
int bench_quality(const QualityOptions& options);

} // namespace cupola::cli
