// cupola: everything that is done from a terminal.
#include <CLI/App.hpp>

#include "server/cli/commands.h"

int main(int argc, char** argv) {
  using namespace cupola::cli;
  CLI::App app("Cupola: shows for domes and cylinder walls.", "cupola");
  app.set_version_flag("--version", "cupola " CUPOLA_VERSION);
  app.require_subcommand(1);
  ExitCode exit_code = exit_done;

  add_validate(app, exit_code);
  add_compare(app, exit_code);
  add_render(app, exit_code);
  add_pieces(app, exit_code);
  add_bench(app, exit_code);
  add_schema(app, exit_code);
  add_docs(app, exit_code);
  add_get(app, exit_code);
  add_set(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version arrive here too, with code 0.
    return app.exit(error) == 0 ? exit_done : exit_unusable;
  }
  return exit_code;
}
