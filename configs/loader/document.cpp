// nlohmann's SAX parser says what it reads but not where. Its callbacks come in the order of the text, so a
// cursor that steps over white space, comments and punctuation always lands on the token just reported.
#include "configs/loader/document.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "configs/loader/words.h"

namespace cupola::loader {

using model::Code;
using model::escaped;
using model::Position;
using model::Problem;

namespace {

constexpr std::size_t max_pointer_bytes = 64u << 20; ///< of all positions together
constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";

class Cursor {
public:
  Cursor(std::string_view text, const std::string& name)
      : text_(text)
      , name_(name) {
    if (text.starts_with(utf8_mark)) offset_ = line_start_ = utf8_mark.size();
  }

  /// Steps to the next token, but not beyond `limit`.
  Position next(std::size_t limit) {
    limit = std::min(limit, text_.size());
    while (offset_ < limit) {
      const char c = text_[offset_];
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == ':')
        step();
      else if (c == '/')
        comment(limit);
      else
        break;
    }
    return here();
  }
  Position next() { return next(text_.size()); }

  void pass_one() { step(); }
  void pass_string() {
    step();
    while (offset_ < text_.size() && text_[offset_] != '"') {
      if (text_[offset_] == '\\') step();
      step();
    }
    step();
  }
  void pass_word() {
    constexpr std::string_view ends = " \t\r\n,:]}/[{\"";
    while (offset_ < text_.size() && ends.find(text_[offset_]) == std::string_view::npos) step();
  }
  Position go(std::size_t offset) {
    while (offset_ < std::min(offset, text_.size())) step();
    return here();
  }
  [[nodiscard]] std::size_t offset() const { return offset_; }

private:
  [[nodiscard]] Position here() const { return {name_, line_, offset_ - line_start_ + 1}; }
  void step() {
    if (offset_ >= text_.size()) return;
    if (text_[offset_++] == '\n') {
      ++line_;
      line_start_ = offset_;
    }
  }
  void comment(std::size_t limit) {
    const bool block = offset_ + 1 < text_.size() && text_[offset_ + 1] == '*';
    const std::size_t end = block ? text_.find("*/", offset_ + 2) : text_.find('\n', offset_);
    const std::size_t past = end == std::string_view::npos ? text_.size() : end + (block ? 2 : 0);
    while (offset_ < std::min(past, limit)) step();
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t offset_ = 0, line_ = 1, line_start_ = 0;
};

/// Offset of the first byte that is not part of valid UTF-8, or npos.
std::size_t invalid_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[i])) : 0u;
  };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte(i);
    if (lead < 0x80) {
      ++i;
      continue;
    }
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4) return i;
    // The second byte's range excludes overlong forms, surrogates and what lies beyond U+10FFFF.
    const unsigned low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    if (byte(i + 1) < low || byte(i + 1) > high) return i;
    for (std::size_t k = 2; k < length; ++k)
      if (byte(i + k) < 0x80 || byte(i + k) > 0xBF) return i;
    i += length;
  }
  return std::string_view::npos;
}

/// The parser's own sentence, taken apart: "…while parsing CONTEXT - unexpected X; expected Y".
struct Sentence {
  std::string context, expected, found;
};
Sentence take_apart(std::string_view what) {
  const auto between = [&](std::string_view open, std::string_view close) -> std::string {
    const std::size_t start = what.find(open);
    if (start == std::string_view::npos) return {};
    const std::string_view rest = what.substr(start + open.size());
    return std::string(rest.substr(0, rest.find(close)));
  };
  Sentence out{between("while parsing ", " - "), between("; expected ", "\n"),
               between(" - unexpected ", ";")};
  if (out.found.empty()) out.found = between(" - ", ";");
  const auto say = [](std::string& text, const std::map<std::string_view, std::string_view>& words) {
    if (const auto word = words.find(text); word != words.end()) text = word->second;
  };
  say(out.expected, {{"string literal", out.context == "object key" ? "a key in double quotes" : "a text"},
                     {"'[', '{', or a literal", "a value"},
                     {"end of input", "the end of the text"}});
  say(out.found, {{"string literal", "a text"}, {"number literal", "a number"}});
  return out;
}

/// Builds the document and notes positions. Returns false to stop the parser once `failed` is set.
class Builder {
public:
  Builder(std::string_view text, const std::string& name, Document& document)
      : text_(text)
      , cursor_(text, name)
      , document_(document) {}

  std::optional<Problem> failed;

  bool null() { return word(Json()); }
  bool boolean(bool value) { return word(Json(value)); }
  bool number_integer(std::int64_t value) { return word(Json(value)); }
  bool number_unsigned(std::uint64_t value) { return word(Json(value)); }
  bool number_float(double value, const std::string&) { return word(Json(value)); }
  bool string(std::string& value) {
    const bool going = put(Json(std::move(value)));
    cursor_.pass_string();
    if (going) leave();
    return going;
  }
  bool binary(Json::binary_t&) { return false; }

  bool start_object(std::size_t) { return open(Json::object()); }
  bool end_object() { return close(); }
  bool start_array(std::size_t) { return open(Json::array()); }
  bool end_array() { return close(); }

  bool key(std::string& key) {
    const Position at = cursor_.next();
    cursor_.pass_string();
    Frame& frame = frames_.back();
    const bool too_long = key.size() > max_key_bytes;
    frame.key = too_long ? key.substr(0, 16) : key;
    frame.drop_next = frame.dropped;
    if (frame.dropped) return true;
    const std::string pointer = pointer_ + '/' + escaped(frame.key);
    if (too_long) {
      frame.drop_next = true;
      document_.problems.push_back({Code::unknown_key, pointer_, "a known key",
                                    "a key of " + std::to_string(key.size()) + " bytes", "", at});
    } else if (!frame.seen.insert(key).second) {
      frame.drop_next = true;
      const auto first = document_.keys.find(pointer);
      std::string advice = "Remove one of them";
      if (first != document_.keys.end())
        advice += "; the first stands in line " + std::to_string(first->second.line);
      document_.problems.push_back({Code::json_duplicate_key, pointer, "each key once in an object",
                                    in_quotes(key) + " again", advice + '.', at});
    } else if (remember(pointer)) {
      document_.keys.emplace(pointer, at);
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) {
    const std::size_t last_read = position > 0 ? position - 1 : 0;
    const Sentence said = take_apart(error.what());
    Problem problem{Code::json_syntax, frames_.empty() ? "" : pointer_, said.expected, said.found, "", {}};
    problem.at = cursor_.next(last_read);
    const std::size_t start = cursor_.offset();
    const std::string_view rest = text_.substr(std::min(start, text_.size()));
    if (error.id == 406) {
      problem.expected = "a number within double precision (up to 1.8e308)";
      problem.found = in_quotes(rest.substr(0, rest.find_first_of(" \t\r\n,]}")));
    } else if (rest.empty()) {
      problem.found = text_.find_first_not_of(" \t\r\n") == std::string_view::npos ? "an empty text"
                                                                                   : "the end of the text";
      problem.advice = text_.empty() ? "" : "Is the file complete?";
      if (problem.expected.empty()) problem.expected = "more of the " + said.context;
    } else {
      explain(problem, rest, start);
    }
    failed = std::move(problem);
    return false;
  }

private:
  struct Frame {
    Json* value;
    std::unordered_set<std::string> seen; ///< an object's keys so far
    std::string key;                      ///< the key whose value comes next
    std::size_t pointer_length;           ///< of the frame's own pointer
    bool dropped = false, drop_next = false;
  };

  void explain(Problem& problem, std::string_view rest, std::size_t start) const {
    const std::size_t before = text_.substr(0, start).find_last_not_of(" \t\r\n");
    if (problem.expected.empty()) problem.expected = "JSON";
    if (problem.found == "invalid literal")
      problem.found = in_quotes(rest.substr(0, rest.find_first_of(" \t\r\n,:]}")));
    if ((rest[0] == '}' || rest[0] == ']') && before != std::string_view::npos && text_[before] == ',')
      problem.advice = "Remove the comma before it.";
    else if (rest.starts_with("NaN") || rest.starts_with("nan") || rest.starts_with("Inf") ||
             rest.starts_with("-I"))
      problem.advice = "JSON has neither NaN nor infinity.";
    else if (rest[0] == '\'')
      problem.advice = "Texts and keys stand in double quotes.";
    else if (rest[0] == '#')
      problem.advice = "Comments start with //.";
    else if (rest[0] == '"' && problem.found == "a text")
      problem.advice = "Is a comma or a colon missing before it?";
    else if (rest[0] == '"' && problem.found.ends_with("missing closing quote"))
      problem.advice = "Is the file complete?";
  }

  bool remember(const std::string& pointer) {
    pointer_bytes_ += pointer.size();
    return pointer_bytes_ <= max_pointer_bytes;
  }

  bool stop(Code code, const Position& at, std::string expected, std::string found) {
    failed = Problem{code, "", std::move(expected), std::move(found), "", at};
    return false;
  }

  /// Puts a value where it belongs and makes it the frame on top.
  bool put(Json&& value) {
    const Position at = cursor_.next();
    if (frames_.size() >= max_depth)
      return stop(Code::json_too_deep, at, "at most " + std::to_string(max_depth) + " levels of nesting",
                  "more");
    if (++count_ > max_values)
      return stop(Code::too_many, at, "at most " + std::to_string(max_values) + " values in a file", "more");
    bool dropped = false;
    Json* target = &document_.root;
    const std::size_t length = pointer_.size();
    if (!frames_.empty()) {
      Frame& parent = frames_.back();
      dropped = parent.dropped || parent.drop_next;
      if (dropped) {
        target = parent.value; // its own place is never seen: the document is refused
      } else if (parent.value->is_array()) {
        pointer_ += '/' + std::to_string(parent.value->size());
        parent.value->push_back(nullptr);
        target = &parent.value->back();
      } else {
        pointer_ += '/' + escaped(parent.key);
        target = &parent.value->get_ref<Json::object_t&>().emplace_back(parent.key, nullptr).second;
      }
    }
    if (!dropped) {
      *target = std::move(value);
      if (remember(pointer_)) document_.values.emplace(pointer_, at);
    }
    frames_.push_back({target, {}, {}, length, dropped});
    return true;
  }
  void leave() {
    pointer_.resize(frames_.back().pointer_length);
    frames_.pop_back();
  }

  bool word(Json&& value) {
    const bool going = put(std::move(value));
    cursor_.pass_word();
    if (going) leave();
    return going;
  }
  bool open(Json&& value) {
    const bool going = put(std::move(value));
    cursor_.pass_one();
    return going;
  }
  bool close() {
    cursor_.next();
    cursor_.pass_one();
    leave();
    return true;
  }

  std::string_view text_;
  Cursor cursor_;
  Document& document_;
  std::vector<Frame> frames_;
  std::string pointer_;
  std::size_t count_ = 0, pointer_bytes_ = 0;
};

std::optional<Problem> bad_bytes(std::string_view text, const std::string& name) {
  if (const std::size_t at = invalid_utf8(text); at != std::string_view::npos) {
    const bool wide = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
    constexpr std::string_view digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(text[at]);
    return Problem{Code::json_encoding,
                   "",
                   "UTF-8",
                   std::string("the byte 0x") + digits[byte >> 4] + digits[byte & 15],
                   wide ? "The text looks like UTF-16. Save it as UTF-8." : "Save the file as UTF-8.",
                   Cursor(text, name).go(at)};
  }
  // The parser takes a zero byte for the end of the text and would not see what follows it.
  if (const std::size_t at = text.find('\0'); at != std::string_view::npos)
    return Problem{Code::json_syntax, "", "JSON", "a zero byte", "", Cursor(text, name).go(at)};
  return std::nullopt;
}

} // namespace

model::Result<Document> read_document(std::string_view text, const std::string& name) {
  if (text.size() > max_text_bytes)
    return model::failure({Code::file_too_large,
                           "",
                           "at most " + std::to_string(max_text_bytes) + " bytes",
                           std::to_string(text.size()) + " bytes",
                           "",
                           {name, 0, 0}});
  if (auto problem = bad_bytes(text, name)) return model::failure(std::move(*problem));
  Document document;
  Builder builder(text, name, document);
  if (!Json::sax_parse(text, &builder, Json::input_format_t::json, true, true))
    return model::failure(
        builder.failed.value_or(Problem{Code::json_syntax, "", "JSON", "something else", "", {name, 1, 1}}));
  return document;
}

} // namespace cupola::loader
