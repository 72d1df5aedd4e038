// cupola docs: the reference manual's pages that follow from the tables. For developers (`./dev docs`).
#include <CLI/App.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "configs/loader/pages.h"
#include "server/cli/commands.h"

namespace cupola::cli {

void add_docs(CLI::App& app, ExitCode& exit_code) {
  auto page = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("docs", "Prints a generated page of the reference manual.");
  command->group(""); // not in the help
  command->add_option("page", *page, "Which page")
      ->required()
      ->check(CLI::IsMember({"parameters", "problems"}));
  command->callback([page, &exit_code] {
    std::fputs((*page == "parameters" ? loader::parameters_page() : loader::problems_page()).c_str(), stdout);
    exit_code = exit_done;
  });
}

} // namespace cupola::cli
