// Edits of a show's document. Pure, any thread.
#pragma once

#include <optional>

#include "configs/model/change.h"
#include "configs/model/problem.h"

namespace cupola::state {

/// Merges one edit into a whole document (model::to_json) as RFC 7396 says, guided by the parameter table:
/// - all but the last part of the path must exist, and the last must be a known key, a name of a map's entry,
///   or the index of a list's entry; otherwise CTL-102, naming the nearest key, and nothing is altered;
/// - where an edit changes the "kind" of a struct, the parameters of the former kind leave with it, so that
///   those of the new kind stand at their defaults unless the edit gives them;
/// - null removes: an entry, or a value, which is then absent or at its default again.
/// Values are not checked here: the loader does that for the document as a whole.
[[nodiscard]] std::optional<model::Problem> apply_edit(model::Json& document, const model::Edit& edit);

/// The problem that an unknown address is: names the nearest key at the place where the address goes wrong.
[[nodiscard]] model::Problem unknown_path(const model::Json& document, std::string_view pointer);

} // namespace cupola::state
