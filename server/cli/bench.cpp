// cupola bench: both sides of a comparison in one process, and their ratio.
#include "server/cli/bench.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>    // App.hpp declares these two,
#include <CLI/Formatter.hpp> // and wants them once in a program
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "server/cli/commands.h"

namespace cupola::cli {

namespace {

std::string cell(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "";
  if (value.is_number_float()) {
    char text[32];
    const double number = value.get<double>();
    std::snprintf(text, sizeof text, number >= 100.0 ? "%.0f" : "%.2f", number);
    return text;
  }
  return value.dump();
}

void print_table(const nlohmann::ordered_json& rows) {
  if (rows.empty()) return;
  std::vector<std::string> keys;
  for (const auto& [key, value] : rows.front().items()) keys.push_back(key);
  std::vector<std::size_t> widths;
  for (const std::string& key : keys) {
    std::size_t width = key.size();
    for (const auto& row : rows) width = std::max(width, cell(row.at(key)).size());
    widths.push_back(width);
  }
  const auto line = [&](const auto& text_of) {
    for (std::size_t i = 0; i < keys.size(); ++i)
      std::printf("%s%*s", i == 0 ? "" : "  ", static_cast<int>(widths[i]), text_of(i).c_str());
    std::printf("\n");
  };
  line([&](std::size_t i) { return keys[i]; });
  for (const auto& row : rows) line([&](std::size_t i) { return cell(row.at(keys[i])); });
}

} // namespace

void print_report(const BenchReport& report, bool as_json) {
  if (as_json) {
    const nlohmann::ordered_json out{
        {"device", report.device}, {"rows", report.rows}, {"ratios", report.ratios}, {"notes", report.notes}};
    std::printf("%s\n", out.dump(2).c_str());
    return;
  }
  std::printf("%s\n\n", report.device.c_str());
  print_table(report.rows);
  std::printf("\n");
  for (const auto& [name, value] : report.ratios.items())
    std::printf("%s %s\n", name.c_str(), cell(value).c_str());
  for (const std::string& note : report.notes) std::printf("%s\n", note.c_str());
}

void add_bench(CLI::App& app, ExitCode& exit_code) {
  CLI::App* bench = app.add_subcommand("bench", "Measures both sides of a comparison in one process.");
  bench->require_subcommand(1);
  struct Options {
    bool json = false, quick = false;
    std::string pictures, plot, subject;
  };
  auto options = std::make_shared<Options>();
  const auto add = [&](const char* name, const char* words, auto run) {
    CLI::App* command = bench->add_subcommand(name, words);
    command->add_flag("--json", options->json, "One JSON object on standard output");
    command->add_flag("--quick", options->quick, "Few frames, to see that it works; the figures mean little");
    command->callback([options, run, &exit_code] { exit_code = run(*options); });
    return command;
  };
  add("table1", "The 360° cylinder of Lorenz & Döllner, table 1.",
      [](const Options& o) { return bench_table1(o.json, o.quick); });
  add("table2", "Their camera textures over a perspective, table 2.",
      [](const Options& o) { return bench_table2(o.json, o.quick); });
  add("fisheye", "A dome of 180°: pieces, cubemap and auto, small and large cities.",
      [](const Options& o) { return bench_fisheye(o.json, o.quick); });
  CLI::App* quality =
      add("quality", "How near both methods come to the picture by rays.", [](const Options& o) {
        return bench_quality({o.json, o.quick, o.pictures, o.subject});
      });
  quality->add_option("--pictures", options->pictures, "Close-ups go to this folder")->type_name("DIR");
  quality
      ->add_option("--subject", options->subject, "One alone, as cylinder-city, without the overall ratios")
      ->check(CLI::IsMember(
          {"cylinder-city", "cylinder-text", "cylinder-wireframe", "cylinder-hatching", "fisheye-city"}));
  add("scaling", "How time grows with triangles, pieces, pixels and outputs.",
      [](const Options& o) {
        return bench_scaling({o.json, o.quick, o.plot});
      })
      ->add_option("--plot", options->plot, "The curves go to this SVG file")
      ->type_name("FILE");
}

} // namespace cupola::cli
