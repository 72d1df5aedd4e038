// A show file, from text to loaded scene: what starting, reloading and --check have in common.
#pragma once

#include <filesystem>

#include "configs/model/problem.h"
#include "server/daemon/exit_code.h"
#include "server/state/live_state.h"

namespace cupola::daemon {

/// Loads what a show's content names, for LiveState. Warnings go to the log.
[[nodiscard]] std::function<model::Result<state::Resources>(const model::Show&)>
scene_loader(const std::filesystem::path& show_file);

/// The live show's first revision; takes as long as the scene takes to load.
[[nodiscard]] model::Result<std::unique_ptr<state::LiveState>> open_show(const std::filesystem::path& file,
                                                                         state::Options options);

/// Problems found, as an exit code: the file cannot be read, or the show is wrong.
[[nodiscard]] ExitCode exit_code_of(const model::Problems& problems);

/// Loads, plans and loads the scene, prints every problem to standard error, opens nothing.
[[nodiscard]] ExitCode check(const std::filesystem::path& file);

} // namespace cupola::daemon
