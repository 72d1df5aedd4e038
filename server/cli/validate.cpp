// cupola validate: what the daemon would say about a show, without running it.
#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "configs/loader/loader.h"
#include "renderer/content/scene.h"
#include "renderer/plan/plan.h"
#include "server/cli/commands.h"
#include "server/cli/report.h"

namespace cupola::cli {

namespace {

struct Options {
  std::vector<std::string> files;
  std::string format = "text";
  bool strict = false;
};

void append(model::Problems& to, model::Problems from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// The scene file that the show names. Its problems stand at paths inside that file; one with the file as a
/// whole stands in the show. Scenes that are generated always exist.
model::Problems scene_problems(const model::Show& show, const std::filesystem::path& folder) {
  const auto* gltf = std::get_if<model::Gltf>(&show.scene.content);
  if (!gltf) return {};
  auto scene = content::load_scene(show.scene.content, folder);
  model::Problems problems = scene ? std::move(scene->warnings) : std::move(scene.error());
  for (model::Problem& problem : problems)
    if (problem.pointer.empty()) {
      problem.pointer = "/scene/content/file";
      if (!problem.at.file.empty()) problem.found = problem.at.file + ": " + problem.found;
      problem.at = {};
    }
  return problems;
}

/// Everything about one file: the loader's problems, or, where it has none, those of geometry and scene.
model::Problems problems_of(const std::string& file) {
  auto loaded = loader::load_show(file);
  if (!loaded) return std::move(loaded.error());
  model::Problems problems = std::move(loaded->warnings);
  auto planned = plan::make_plan(loaded->show);
  append(problems, planned ? std::move(planned->warnings) : std::move(planned.error()));
  append(problems, scene_problems(loaded->show, std::filesystem::path(file).parent_path()));
  loader::locate(problems, loaded->positions);
  std::stable_sort(problems.begin(), problems.end(), [](const model::Problem& a, const model::Problem& b) {
    return std::tie(a.at.line, a.at.column) < std::tie(b.at.line, b.at.column);
  });
  return problems;
}

ExitCode verdict(const model::Problems& problems, bool strict) {
  const auto unread = [](const model::Problem& problem) {
    return problem.code == model::Code::file_unreadable || problem.code == model::Code::file_too_large;
  };
  if (std::any_of(problems.begin(), problems.end(), unread)) return exit_unusable;
  return model::has_errors(problems) || (strict && !problems.empty()) ? exit_no : exit_done;
}

ExitCode run(const Options& options) {
  ExitCode exit_code = exit_done;
  model::Problems all;
  for (const std::string& file : options.files) {
    model::Problems problems = problems_of(file);
    exit_code = std::max(exit_code, verdict(problems, options.strict));
    if (options.format == "text") {
      for (const model::Problem& problem : problems) std::printf("%s\n", model::to_text(problem).c_str());
      if (!model::has_errors(problems)) std::printf("%s: valid\n", file.c_str());
    }
    append(all, std::move(problems));
  }
  if (options.format == "json") std::printf("%s\n", as_json(all).c_str());
  if (options.format == "sarif") std::printf("%s\n", as_sarif(all).c_str());
  return exit_code;
}

} // namespace

void add_validate(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("validate", "Checks show files and says what is wrong, and where.");
  command->add_option("files", options->files, "Show files")->required()->type_name("FILE");
  command->add_option("--format", options->format, "How problems are printed")
      ->check(CLI::IsMember({"text", "json", "sarif"}))
      ->capture_default_str();
  command->add_flag("--strict", options->strict, "Warnings count as problems");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace cupola::cli
