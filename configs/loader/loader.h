// JSON text → Show, with every problem and where it stands; and back.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "configs/model/problem.h"
#include "configs/model/show.h"

namespace cupola::loader {

/// A parsed text: the values, and where each stands.
struct Document;

/// Where every value (and key) of a document stands, by JSON pointer.
using Positions = std::map<std::string, model::Position, std::less<>>;

struct Loaded {
  model::Show show;
  model::Problems warnings;
  Positions positions; ///< of the values given in the text
};

/// Reads and checks a show file: syntax, types, ranges, references. Collects all problems. Refuses
/// directories, FIFOs and files beyond the size limit without reading them.
[[nodiscard]] model::Result<Loaded> load_show(const std::filesystem::path& file);

/// The same for text; `name` stands for the file in positions.
[[nodiscard]] model::Result<Loaded> parse_show(std::string_view text, const std::string& name);

/// The same rules for a document that did not come from a text: a changed live show.
[[nodiscard]] model::Result<Loaded> decode_show(const nlohmann::ordered_json& document);

/// Gives problems found later (planning) the place of their pointer, or of its nearest parent that has one.
/// Those that name a place or another file already are left alone.
void locate(model::Problems& problems, const Positions& positions);

/// The JSON Schema (draft 2020-12) of a show file, generated from the parameter table.
[[nodiscard]] nlohmann::ordered_json show_schema();

} // namespace cupola::loader
