// JSON document → Show by the parameter table: types, ranges, choices, names, unknown and missing keys.
// Private to the room.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "configs/loader/report.h"
#include "configs/model/show.h"

namespace cupola::loader {

/// Values that are refused keep their defaults in the show returned.
[[nodiscard]] model::Show decode(const nlohmann::ordered_json& document, Report& report);

/// Letters, digits, '_', '-', '.', at most 64, the first a letter or digit: fit for a network address.
[[nodiscard]] bool usable_name(std::string_view name);
inline constexpr const char* name_pattern = "^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$";

/// Texts are at most so long (in bytes), and hold no control characters.
inline constexpr std::size_t max_text_length = 4096;

/// Formats of show files that this build reads.
inline constexpr int newest_version = 1;

} // namespace cupola::loader
