// The JSON of a request's body, with bounds.
#pragma once

#include <string_view>

#include "configs/model/change.h"
#include "configs/model/problem.h"

namespace cupola::control {

/// One problem with line and column where the text is not JSON, not UTF-8, has a number beyond double
/// precision, a key twice in one object, more than 10,000 keys in one object, or more than 64 levels.
[[nodiscard]] model::Result<model::Json> parse_body(std::string_view text);

} // namespace cupola::control
