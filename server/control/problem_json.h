// Problems as JSON, the same for every protocol.
#pragma once

#include "configs/model/change.h"
#include "configs/model/problem.h"

namespace cupola::control {

/// {"code", "title", "severity", "pointer", "expected", "found", "advice", "text"}, and "file", "line",
/// "column" where known.
[[nodiscard]] model::Json problem_json(const model::Problem& problem);

/// An array of them.
[[nodiscard]] model::Json problems_json(const model::Problems& problems);

} // namespace cupola::control
