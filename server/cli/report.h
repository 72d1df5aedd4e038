// Problems in the formats that `cupola validate` prints.
#pragma once

#include <string>

#include "configs/model/problem.h"

namespace cupola::cli {

/// A JSON array of objects: code, severity, file, line, column, pointer, expected, found, advice, text.
[[nodiscard]] std::string as_json(const model::Problems& problems);

/// SARIF 2.1.0, one run.
[[nodiscard]] std::string as_sarif(const model::Problems& problems);

} // namespace cupola::cli
