#include "server/daemon/show_file.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "renderer/content/scene.h"
#include "server/daemon/log.h"

namespace cupola::daemon {

std::function<model::Result<state::Resources>(const model::Show&)>
scene_loader(const std::filesystem::path& show_file) {
  return [folder = show_file.parent_path()](const model::Show& show) -> model::Result<state::Resources> {
    auto loaded = content::load_scene(show.scene.content, folder);
    if (!loaded) return tl::unexpected(std::move(loaded.error()));
    log_problems(loaded->warnings);
    return state::Resources(std::move(loaded->scene));
  };
}

model::Result<std::unique_ptr<state::LiveState>> open_show(const std::filesystem::path& file,
                                                           state::Options options) {
  auto loaded = loader::load_show(file);
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  return state::LiveState::make(std::move(*loaded), std::move(options));
}

ExitCode exit_code_of(const model::Problems& problems) {
  const bool unread = std::any_of(problems.begin(), problems.end(), [](const model::Problem& problem) {
    return problem.code == model::Code::file_unreadable || problem.code == model::Code::file_too_large;
  });
  return unread ? exit_usage : exit_show;
}

ExitCode check(const std::filesystem::path& file) {
  const auto print = [](const model::Problems& problems) {
    for (const model::Problem& problem : problems)
      std::fprintf(stderr, "%s\n", model::to_text(problem).c_str());
  };
  state::Options options;
  options.load_resources = [&](const model::Show& show) -> model::Result<state::Resources> {
    auto loaded = content::load_scene(show.scene.content, file.parent_path());
    if (!loaded) return tl::unexpected(std::move(loaded.error()));
    print(loaded->warnings);
    return state::Resources(std::move(loaded->scene));
  };
  const auto opened = open_show(file, std::move(options));
  if (!opened) {
    print(opened.error());
    return exit_code_of(opened.error());
  }
  print((*opened)->current()->warnings);
  std::printf("%s: valid\n", file.c_str());
  return exit_done;
}

} // namespace cupola::daemon
