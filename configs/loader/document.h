// Text → JSON document that remembers where everything stands. Private to the room.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "configs/loader/loader.h"

namespace cupola::loader {

using Json = nlohmann::ordered_json;

/// Bounds that keep any file, however strange, within some hundred megabytes of memory.
inline constexpr std::size_t max_text_bytes = 16u << 20;
inline constexpr std::size_t max_depth = 64;
inline constexpr std::size_t max_values = 500'000;
inline constexpr std::size_t max_key_bytes = 128;

struct Document {
  Json root;
  Positions values;         ///< start of every value, by its pointer
  Positions keys;           ///< start of the key of every member of an object, by the same pointer
  model::Problems problems; ///< keys that stand twice or are beyond all reason; the text is JSON all the same
};

/// Fails with one located problem where the text is not JSON, not UTF-8, or beyond a bound.
[[nodiscard]] model::Result<Document> read_document(std::string_view text, const std::string& name);

} // namespace cupola::loader
