// The reference manual's pages that follow from the tables, as Markdown.
#pragma once

#include <string>

namespace cupola::loader {

/// docs/reference/parameters.md: every parameter by its address.
[[nodiscard]] std::string parameters_page();

/// docs/reference/problems.md: every code with its explanation.
[[nodiscard]] std::string problems_page();

} // namespace cupola::loader
