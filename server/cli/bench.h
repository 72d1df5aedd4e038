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

/// Table 2: a camera texture over a perspective, by pieces and by warping one picture.
int bench_table2(bool as_json, bool quick);

/// A fisheye of 180°, 2048² and 4096², cities of 35 thousand to 3.5 million triangles: pieces, cubemaps about
/// the matched size, and method auto.
int bench_fisheye(bool as_json, bool quick);

struct QualityOptions {
  bool json = false, quick = false;
  std::string pictures; ///< folder for close-ups; "": none
  std::string subject;  ///< as "cylinder-city", this one alone; "": all
};
/// Both methods against rays: at matched density, at equal time, against any cubemap. Progress on standard
/// error.
int bench_quality(const QualityOptions& options);

struct ScalingOptions {
  bool json = false, quick = false;
  std::string plot; ///< SVG file for the curves; "": none
};
/// How time grows with triangles, pieces, pixels and outputs. Progress on standard error.
int bench_scaling(const ScalingOptions& options);

} // namespace cupola::cli
