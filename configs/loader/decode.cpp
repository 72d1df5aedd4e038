#include "configs/loader/decode.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "configs/loader/document.h"
#include "configs/loader/words.h"
#include "configs/model/parameters.h"

namespace cupola::loader {

using model::Code;
using model::escaped;
using model::Kind;
using model::Parameter;
using model::Type;

namespace {

const Parameter* row_named(const std::vector<Parameter>& rows, std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Parameter& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

class Decoder {
public:
  explicit Decoder(Report& report)
      : report_(report) {}

  void structure(const Type& type, void* self, const Json& value, const std::string& at);

private:
  /// The index of the alternative that "kind" names; nullopt when that is refused.
  std::optional<std::size_t> kind(const Type& type, const Json& value, const std::string& at);
  void unknown(const Type& type, std::optional<std::size_t> held, const std::string& key,
               const std::string& at);
  void missing(const std::vector<Parameter>& rows, const Json& value, const std::string& at);
  void value(const Parameter& row, void* owner, const Json& value, const std::string& at);
  void map(const Parameter& row, void* owner, const Json& value, const std::string& at);
  void list(const Parameter& row, void* owner, const Json& value, const std::string& at);
  bool leaf(const Parameter& row, const Json& value, const std::string& at);
  bool number(const Parameter& row, const Json& value, const std::string& at);
  bool grid(const Parameter& row, const Json& value, const std::string& at);
  bool text(const std::string& value, const std::string& at);

  bool refuse(Code code, const std::string& at, std::string expected, std::string found,
              std::string advice = "") {
    report_.add({code, at, std::move(expected), std::move(found), std::move(advice)});
    return false;
  }

  Report& report_;
};

void Decoder::structure(const Type& type, void* self, const Json& value, const std::string& at) {
  if (!value.is_object()) {
    refuse(Code::wrong_type, at, "an object (" + type.name + ")", shown(value));
    return;
  }
  const std::vector<Parameter>* own = nullptr; // rows of the alternative held
  void* held = nullptr;
  std::optional<std::size_t> index;
  if (!type.alternatives.empty()) {
    index = kind(type, value, at);
    if (index) {
      held = type.activate(self, *index);
      own = &type.alternatives[*index].type->rows;
    }
  }
  for (const auto& [key, member] : value.items()) {
    if (key == "kind" && !type.alternatives.empty()) continue;
    const std::string here = at + '/' + escaped(key);
    if (const Parameter* row = own ? row_named(*own, key) : nullptr)
      this->value(*row, held, member, here);
    else if (const Parameter* common = row_named(type.rows, key))
      this->value(*common, self, member, here);
    else
      unknown(type, index, key, here);
  }
  if (own) missing(*own, value, at);
  missing(type.rows, value, at);
}

std::optional<std::size_t> Decoder::kind(const Type& type, const Json& value, const std::string& at) {
  std::vector<std::string> names, quotes;
  for (const model::Alternative& alternative : type.alternatives) {
    names.push_back(alternative.name);
    quotes.push_back(in_quotes(alternative.name));
  }
  const auto given = value.find("kind");
  if (given == value.end()) {
    if (!type.kind_required) return 0;
    refuse(Code::missing_key, at + "/kind", "\"kind\": " + listed(quotes), "none");
    return std::nullopt;
  }
  if (!given->is_string()) {
    refuse(Code::wrong_type, at + "/kind", listed(quotes), shown(*given));
    return std::nullopt;
  }
  const auto& word = given->get_ref<const std::string&>();
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) {
    const std::string near = model::nearest(word, names);
    refuse(Code::unknown_choice, at + "/kind", listed(quotes), in_quotes(word),
           near.empty() ? "" : "Did you mean " + in_quotes(near) + "?");
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - names.begin());
}

void Decoder::unknown(const Type& type, std::optional<std::size_t> held, const std::string& key,
                      const std::string& at) {
  std::vector<std::string> known, elsewhere;
  for (std::size_t i = 0; i < type.alternatives.size(); ++i) {
    const model::Alternative& alternative = type.alternatives[i];
    if (held == i)
      for (const Parameter& row : alternative.type->rows) known.push_back(row.name);
    else if (row_named(alternative.type->rows, key))
      elsewhere.push_back(in_quotes(alternative.name));
  }
  if (!type.alternatives.empty() && !held && !elsewhere.empty()) return; // "kind" itself has been refused
  for (const Parameter& row : type.rows) known.push_back(row.name);
  if (!type.alternatives.empty()) known.emplace_back("kind");
  std::string expected = "a key of " + type.name;
  if (held) expected += " of kind " + in_quotes(type.alternatives[*held].name);
  std::string advice;
  if (!elsewhere.empty())
    advice = "It belongs to kind " + listed(elsewhere) + ".";
  else if (const std::string near = model::nearest(key, known); !near.empty())
    advice = "Did you mean " + in_quotes(near) + "?";
  else
    advice = "Known here: " + listed(known) + ".";
  report_.add_at_key({Code::unknown_key, at, std::move(expected), in_quotes(key), std::move(advice)});
}

void Decoder::missing(const std::vector<Parameter>& rows, const Json& value, const std::string& at) {
  for (const Parameter& row : rows) {
    if (value.contains(row.name)) continue;
    const bool needs_entries = row.kind == Kind::map && row.range && row.range->min > 0;
    if (needs_entries)
      refuse(Code::empty_show, at + '/' + row.name, "at least one entry in " + in_quotes(row.name), "none");
    else if (row.required)
      refuse(Code::missing_key, at + '/' + row.name, in_quotes(row.name) + ": " + expectation(row), "none",
             row.doc);
  }
}

void Decoder::value(const Parameter& row, void* owner, const Json& value, const std::string& at) {
  switch (row.kind) {
  case Kind::object:
    structure(*row.type, const_cast<void*>(row.nested(owner)), value, at); // the owner is not const
    return;
  case Kind::map:
    map(row, owner, value, at);
    return;
  case Kind::list:
    list(row, owner, value, at);
    return;
  default:
    if (leaf(row, value, at))
      row.write(owner, row.kind == Kind::integer_or_auto && value.is_string() ? Json() : value);
  }
}

void Decoder::map(const Parameter& row, void* owner, const Json& value, const std::string& at) {
  if (!value.is_object()) {
    refuse(Code::wrong_type, at, expectation(row), shown(value));
    return;
  }
  if (static_cast<double>(value.size()) < row.range->min)
    refuse(Code::empty_show, at, "at least one entry in " + in_quotes(row.name), "none");
  if (static_cast<double>(value.size()) > row.range->max) {
    refuse(Code::too_many, at, "at most " + plain(row.range->max) + " entries", std::to_string(value.size()));
    return;
  }
  row.clear(owner);
  for (const auto& [name, member] : value.items()) {
    const std::string here = at + '/' + escaped(name);
    if (!usable_name(name))
      report_.add_at_key(
          {Code::bad_name, here,
           "a name of at most 64 letters, digits, '_', '-' and '.', the first a letter or digit",
           in_quotes(name), ""});
    structure(*row.type, row.add(owner, name), member, here);
  }
}

void Decoder::list(const Parameter& row, void* owner, const Json& value, const std::string& at) {
  if (!value.is_array()) {
    refuse(Code::wrong_type, at, expectation(row), shown(value));
    return;
  }
  if (static_cast<double>(value.size()) > row.range->max) {
    refuse(Code::too_many, at, "at most " + plain(row.range->max) + " entries", std::to_string(value.size()));
    return;
  }
  row.clear(owner);
  for (std::size_t i = 0; i < value.size(); ++i)
    structure(*row.type, row.add(owner, ""), value[i], at + '/' + std::to_string(i));
}

/// True when the value may be written.
bool Decoder::leaf(const Parameter& row, const Json& value, const std::string& at) {
  const auto wrong_type = [&] { return refuse(Code::wrong_type, at, expectation(row), shown(value)); };
  switch (row.kind) {
  case Kind::boolean:
    return value.is_boolean() || wrong_type();
  case Kind::integer_or_auto:
    if (value.is_string() && value == "auto") return true;
    [[fallthrough]];
  case Kind::integer:
  case Kind::number:
    return number(row, value, at);
  case Kind::text:
    return value.is_string() ? text(value.get_ref<const std::string&>(), at) : wrong_type();
  case Kind::choice: {
    if (!value.is_string()) return wrong_type();
    const auto& word = value.get_ref<const std::string&>();
    if (std::find(row.choices.begin(), row.choices.end(), word) != row.choices.end()) return true;
    const std::string near = model::nearest(word, row.choices);
    return refuse(Code::unknown_choice, at, expectation(row), in_quotes(word),
                  near.empty() ? "" : "Did you mean " + in_quotes(near) + "?");
  }
  case Kind::vector3: {
    if (!value.is_array() || value.size() != 3) return wrong_type();
    bool good = true;
    for (std::size_t i = 0; i < 3; ++i) good &= number(row, value[i], at + '/' + std::to_string(i));
    return good;
  }
  case Kind::grid:
    return value.is_array() ? grid(row, value, at) : wrong_type();
  default:
    return false;
  }
}

/// Explains the first pair that is wrong, and no more: a grid that is wrong is so everywhere.
bool Decoder::grid(const Parameter& row, const Json& value, const std::string& at) {
  for (std::size_t y = 0; y < value.size(); ++y) {
    const std::string line = at + '/' + std::to_string(y);
    if (!value[y].is_array()) return refuse(Code::wrong_type, line, "an array of pairs", shown(value[y]));
    for (std::size_t x = 0; x < value[y].size(); ++x) {
      const Json& pair = value[y][x];
      const auto good = [&](const Json& one) {
        return one.is_number() && one.get<double>() >= row.range->min && one.get<double>() <= row.range->max;
      };
      if (pair.is_array() && pair.size() == 2 && good(pair[0]) && good(pair[1])) continue;
      const std::string here = line + '/' + std::to_string(x);
      if (!pair.is_array() || pair.size() != 2)
        return refuse(Code::wrong_type, here, "a pair of numbers", shown(pair));
      return number(row, pair[0], here + "/0") && number(row, pair[1], here + "/1");
    }
  }
  return true;
}

bool Decoder::number(const Parameter& row, const Json& value, const std::string& at) {
  Parameter one = row; // of a vector or grid: one of its numbers
  if (row.kind == Kind::vector3 || row.kind == Kind::grid) one.kind = Kind::number;
  if (!value.is_number()) return refuse(Code::wrong_type, at, expectation(one), shown(value));
  const double number = value.get<double>();
  if (!std::isfinite(number)) return refuse(Code::out_of_range, at, expectation(one), shown(value));
  if (one.kind != Kind::number && number != std::trunc(number))
    return refuse(Code::wrong_type, at, expectation(one), shown(value));
  if (!row.range) return true;
  const model::Range& range = *row.range;
  const bool below = range.min_exclusive ? number <= range.min : number < range.min;
  if (!below && number <= range.max) return true;
  const bool pixels = row.unit == model::Unit::fraction && number > 1;
  return refuse(Code::out_of_range, at, expectation(one), shown(value),
                pixels ? "Is it meant in pixels? Divide by the size of the output." : "");
}

bool Decoder::text(const std::string& value, const std::string& at) {
  const bool control =
      std::any_of(value.begin(), value.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  const auto characters = static_cast<std::size_t>(
      std::count_if(value.begin(), value.end(), [](unsigned char c) { return (c & 0xC0u) != 0x80u; }));
  if (!control && characters <= max_text_length) return true;
  return refuse(Code::bad_text, at,
                "a text of at most " + std::to_string(max_text_length) +
                    " characters, none of them a control character",
                control ? in_quotes(value) : std::to_string(characters) + " characters");
}

/// A show of another version is not judged by the rules of this one.
bool other_version(const Json& document, Report& report) {
  const auto given = document.is_object() ? document.find("version") : document.end();
  if (!document.is_object() || given == document.end() || !given->is_number() || *given == newest_version)
    return false;
  report.add({Code::version_unsupported, "/version", "version " + std::to_string(newest_version),
              shown(*given),
              "This build reads version " + std::to_string(newest_version) + " of the show format."});
  return true;
}

} // namespace

bool usable_name(std::string_view name) {
  const auto alphanumeric = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  return !name.empty() && name.size() <= 64 && alphanumeric(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return alphanumeric(c) || c == '_' || c == '-' || c == '.'; });
}

model::Show decode(const Json& document, Report& report) {
  model::Show show;
  if (!other_version(document, report)) Decoder(report).structure(model::show_type(), &show, document, "");
  return show;
}

} // namespace cupola::loader
