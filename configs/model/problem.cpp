#include "configs/model/problem.h"

#include <algorithm>
#include <numeric>

namespace cupola::model {

const std::vector<CodeText>& code_texts() {
  static const std::vector<CodeText> texts{
#define CUPOLA_CODE(name, id, title, explanation) {Code::name, id, title, explanation},
#include "configs/model/codes.inc"
#undef CUPOLA_CODE
  };
  return texts;
}

std::string_view code_id(Code code) { return code_texts()[static_cast<std::size_t>(code)].id; }

bool has_errors(const Problems& problems) {
  return std::any_of(problems.begin(), problems.end(),
                     [](const Problem& problem) { return problem.severity == Severity::error; });
}

std::string to_text(const Problem& problem) {
  std::string text;
  if (!problem.at.file.empty()) {
    text += problem.at.file;
    if (problem.at.line > 0)
      text += ':' + std::to_string(problem.at.line) + ':' + std::to_string(problem.at.column);
    text += ": ";
  }
  text += problem.severity == Severity::warning ? "warning: " : "error: ";
  if (!problem.pointer.empty()) text += problem.pointer + ": ";
  if (problem.expected.empty() && problem.found.empty())
    text += code_texts()[static_cast<std::size_t>(problem.code)].title;
  if (!problem.expected.empty()) text += "expected " + problem.expected;
  if (!problem.found.empty()) text += (problem.expected.empty() ? "found " : ", found ") + problem.found;
  text += '.';
  if (!problem.advice.empty()) text += ' ' + problem.advice;
  text += " [" + std::string(code_id(problem.code)) + ']';
  return text;
}

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// Upper case and hyphens do not count as slips.
std::string plain_spelling(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-' || c == ' ') c = '_';
  }
  return out;
}

} // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > 256) return {};
  std::string best;
  // Two slips in a short word could mean anything.
  std::size_t best_distance = (word.size() <= 3 ? 1 : std::max<std::size_t>(2, word.size() / 3)) + 1;
  const std::string plain_word = plain_spelling(word);
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(plain_word, plain_spelling(candidate));
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

} // namespace cupola::model
