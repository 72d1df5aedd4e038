// A change: what any door (file reload, HTTP, OSC, command line) asks of the live show.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cupola::model {

using Json = nlohmann::ordered_json;
using Revision = std::uint64_t;

/// `value` is merged into the show's document at `path` as RFC 7396 says: objects merge, null removes
/// (an optional value becomes absent, any other returns to its default), everything else replaces.
struct Edit {
  std::string path; ///< JSON pointer, "" for the whole document
  Json value;
};

/// Valid as a whole or refused as a whole.
struct Change {
  std::string origin;              ///< who asks, for the log: "http 127.0.0.1:4711", "osc", "reload"
  std::optional<Revision> expects; ///< refused when the show is at another revision by then
  std::vector<Edit> edits;
};

} // namespace cupola::model
