// Shows without a daemon: loaded, planned and drawn in this process, without a window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/frame/renderer.h"
#include "renderer/outputs/context.h"
#include "renderer/outputs/image_file.h"
#include "server/cli/commands.h"

namespace cupola::cli {

/// A renderer on a headless context. The context outlives the renderer.
struct OfflineRenderer {
  std::unique_ptr<outputs::Context> context;
  std::unique_ptr<frame::Renderer> renderer;
};

/// `options`: offline is set.
[[nodiscard]] model::Result<OfflineRenderer> make_offline_renderer(frame::RendererOptions options = {});

/// Whether make_stage() prints the warnings of the plan and the scene.
enum class Warnings : std::uint8_t { printed, dropped };

/// Plans the show and loads its scene, or takes `scene` over. `folder`: of relative paths in the show.
[[nodiscard]] model::Result<std::shared_ptr<const frame::Stage>>
make_stage(const model::Show& show, const std::filesystem::path& folder,
           std::shared_ptr<const content::Scene> scene = nullptr, Warnings warnings = Warnings::printed);

/// The picture as bytes, rows from the top. With the context current.
[[nodiscard]] outputs::ByteImage read_picture(const frame::Picture& picture);

/// Fails with image_unwritable.
[[nodiscard]] model::Result<void> write_text(const std::filesystem::path& file, const std::string& text);

/// "80x40" with `between` "x": 80 and 40.
[[nodiscard]] bool parse_pair(const std::string& text, const std::string& between, long& a, long& b);

[[nodiscard]] model::Problem bad_option(const char* option, const char* expected, const std::string& found);

/// `size`: as --size has it, WIDTHxHEIGHT, for all outputs.
[[nodiscard]] model::Problems resize(model::Show& show, const std::string& size);

[[nodiscard]] model::Problem unknown_name(const std::string& pointer, const char* expected,
                                          const std::string& found, const std::vector<std::string>& names);

/// Leaves the output named alone in the show.
[[nodiscard]] model::Problems keep_output(model::Show& show, const std::string& name);

/// After load_show() failed with these: exit_unusable where the file could not be read, else exit_no.
[[nodiscard]] ExitCode exit_of_unloaded(const model::Problems& problems);

/// Prints problems to standard error.
void print_problems(const model::Problems& problems);

} // namespace cupola::cli
