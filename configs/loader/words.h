// How problems speak of values and rows. Private to the room.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "configs/model/parameters.h"

namespace cupola::loader {

/// In double quotes, control characters escaped, long texts cut.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// A value in few words: a number or a short text as it is, "an object", "an array of 4 values".
[[nodiscard]] std::string shown(const nlohmann::ordered_json& value);

/// A number without superfluous digits: 5000000, 0.25.
[[nodiscard]] std::string plain(double value);

/// "a", "a or b", "a, b or c".
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

/// What the row accepts: "a number from 0.1 to 175 °".
[[nodiscard]] std::string expectation(const model::Parameter& row);

} // namespace cupola::loader
