// cupola schema: the published JSON Schema of show files.
#include <CLI/App.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "configs/loader/loader.h"
#include "server/cli/commands.h"

namespace cupola::cli {

void add_schema(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("schema", "Prints the JSON Schema (draft 2020-12) of show files.");
  command->callback([&exit_code] {
    std::printf("%s\n", loader::show_schema().dump(2).c_str());
    exit_code = exit_done;
  });
}

} // namespace cupola::cli
