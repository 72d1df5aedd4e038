#include "configs/loader/words.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace cupola::loader {

using model::Kind;
using model::Parameter;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t longest_quote = 60;

std::string range_text(const Parameter& row) {
  if (!row.range) return {};
  const model::Range& range = *row.range;
  if (range.min == range.max) return "that is " + plain(range.min);
  std::string text = range.min_exclusive ? "above " + plain(range.min) + " and at most "
                                         : "from " + plain(range.min) + " to ";
  text += plain(range.max);
  if (row.unit != model::Unit::none && row.unit != model::Unit::factor)
    text += ' ' + std::string(model::unit_symbol(row.unit));
  return text;
}

} // namespace

std::string in_quotes(std::string_view text) {
  std::string cut(text.substr(0, longest_quote));
  if (cut.size() < text.size()) {
    while (!cut.empty() && (static_cast<unsigned char>(text[cut.size()]) & 0xC0u) == 0x80u) cut.pop_back();
    cut += "…";
  }
  return Json(cut).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string shown(const Json& value) {
  if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
  if (value.is_object()) return "an object";
  if (value.is_array()) {
    if (value.empty()) return "an empty array";
    return "an array of " + std::to_string(value.size()) + (value.size() == 1 ? " value" : " values");
  }
  if (value.is_number_float())
    return std::isfinite(value.get<double>()) ? plain(value.get<double>()) : "a number that is not finite";
  return value.dump();
}

std::string plain(double value) {
  if (std::abs(value) < 1e15 && value == std::trunc(value))
    return std::to_string(static_cast<long long>(value));
  std::array<char, 64> buffer{};
  char* const last = buffer.data() + buffer.size();
  const bool everyday = std::abs(value) > 1e-7 && std::abs(value) < 1e15;
  const auto [end, error] = everyday ? std::to_chars(buffer.data(), last, value, std::chars_format::fixed)
                                     : std::to_chars(buffer.data(), last, value);
  return {buffer.data(), end};
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

std::string expectation(const Parameter& row) {
  const std::string range = range_text(row);
  const std::string within = range.empty() ? range : ' ' + range;
  switch (row.kind) {
  case Kind::boolean:
    return "true or false";
  case Kind::integer:
    return "an integer" + within;
  case Kind::integer_or_auto:
    return "an integer" + within + ", or \"auto\"";
  case Kind::number:
    return "a number" + within;
  case Kind::text:
    return "a text in double quotes";
  case Kind::choice: {
    std::vector<std::string> words;
    for (const std::string& choice : row.choices) words.push_back(in_quotes(choice));
    return listed(words);
  }
  case Kind::vector3:
    return "an array of three numbers" + (range.empty() ? range : ", each " + range);
  case Kind::grid:
    return "an array of rows, each an array of pairs of numbers" +
           (range.empty() ? range : ", each " + range);
  case Kind::object:
    return "an object";
  case Kind::map:
    return "an object of named entries";
  case Kind::list:
    return "an array of objects";
  }
  return {};
}

} // namespace cupola::loader
