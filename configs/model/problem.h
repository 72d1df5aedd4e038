// What can be wrong, as a value with an address. Every room reports through these types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace cupola::model {

/// Stable identity of a kind of problem; codes.inc holds the one list with its texts.
enum class Code : std::uint16_t {
#define CUPOLA_CODE(name, id, title, explanation) name,
#include "configs/model/codes.inc"
#undef CUPOLA_CODE
};

/// What the documentation says about a code.
struct CodeText {
  Code code;
  std::string_view id;          ///< as printed, for example "CFG-113"
  std::string_view title;       ///< one line
  std::string_view explanation; ///< a paragraph: what it means and what to do
};

[[nodiscard]] const std::vector<CodeText>& code_texts();
[[nodiscard]] std::string_view code_id(Code code);

enum class Severity : std::uint8_t { error, warning };

/// A place in a text file. Lines and columns count from 1 (columns in bytes); 0 means "not known".
struct Position {
  std::string file;
  std::size_t line = 0;
  std::size_t column = 0;
  bool operator==(const Position&) const = default;
};

struct Problem {
  Code code{};
  std::string pointer{};  ///< JSON pointer of the value (RFC 6901), "" for the whole document
  std::string expected{}; ///< what would have been right
  std::string found{};    ///< what was there instead
  std::string advice{};   ///< what to do about it; may be empty
  Position at{};
  Severity severity = Severity::error;
  bool operator==(const Problem&) const = default;
};

using Problems = std::vector<Problem>;

/// A value, or everything that is wrong with it.
template <class T>
using Result = tl::expected<T, Problems>;

[[nodiscard]] bool has_errors(const Problems& problems);

/// "show.json:41:17: error: /outputs/left/width: expected …, found …. Advice. [CFG-113]"
[[nodiscard]] std::string to_text(const Problem& problem);

/// One problem as a failed result.
[[nodiscard]] inline tl::unexpected<Problems> failure(Problem problem) {
  return tl::unexpected<Problems>(Problems{std::move(problem)});
}

/// The candidate nearest to `word` in edit distance, or "" when none is near enough to be meant.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

} // namespace cupola::model
