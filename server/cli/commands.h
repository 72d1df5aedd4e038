// The subcommands of `cupola`: one file each, added to the command line by one line in main.cpp.
#pragma once

namespace CLI {
class App;
}

namespace cupola::cli {

/// What a subcommand leaves behind for the shell: 0 done, 1 the answer is no, 2 usage or unreadable input.
/// CLI11 runs the callback of the subcommand that was named; it sets `exit_code`.
using ExitCode = int;
inline constexpr ExitCode exit_done = 0, exit_no = 1, exit_unusable = 2;

void add_validate(CLI::App& app, ExitCode& exit_code);
void add_compare(CLI::App& app, ExitCode& exit_code);
void add_render(CLI::App& app, ExitCode& exit_code);
void add_pieces(CLI::App& app, ExitCode& exit_code);
void add_bench(CLI::App& app, ExitCode& exit_code);
void add_schema(CLI::App& app, ExitCode& exit_code);
void add_docs(CLI::App& app, ExitCode& exit_code);
void add_get(CLI::App& app, ExitCode& exit_code);
void add_set(CLI::App& app, ExitCode& exit_code);

} // namespace cupola::cli
