#include "server/control/osc/values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace cupola::control {

using model::Code;
using model::Json;
using model::Kind;

namespace {

using Arguments = std::vector<OscArgument>;

bool is_number(const OscArgument& argument) {
  return argument.type == 'i' || argument.type == 'h' || argument.type == 'f' || argument.type == 'd';
}
bool is_text(const OscArgument& argument) { return argument.type == 's' || argument.type == 'S'; }

bool is_utf8(const std::string& text) {
  // The library's own check: what it can write strictly is UTF-8.
  try {
    [[maybe_unused]] const std::string written = Json(text).dump();
    return true;
  } catch (const Json::exception&) { return false; }
}

std::string types_of(const Arguments& arguments) {
  std::string out = "arguments ,";
  for (const OscArgument& argument : arguments) out += argument.type;
  return out.substr(0, 80);
}

tl::unexpected<model::Problems> wrong(const OscMessage& message, std::string expected,
                                      std::string found = {}) {
  return model::failure({Code::wrong_type,
                         message.address,
                         std::move(expected),
                         found.empty() ? types_of(message.arguments) : std::move(found),
                         {},
                         {}});
}

model::Result<Json> number(const OscMessage& message, const OscArgument& argument) {
  if (!is_number(argument)) return wrong(message, "a number (i, h, f or d)");
  if (argument.type == 'i' || argument.type == 'h') return Json(argument.integer);
  if (!std::isfinite(argument.number))
    return wrong(message, "a finite number", std::isnan(argument.number) ? "NaN" : "infinity");
  return Json(argument.number);
}

model::Result<Json> integer(const OscMessage& message, const OscArgument& argument) {
  auto value = number(message, argument);
  if (!value || value->is_number_integer()) return value;
  const double given = argument.number;
  if (given != std::floor(given) || std::abs(given) > 9e15)
    return wrong(message, "a whole number", value->dump());
  return Json(static_cast<std::int64_t>(given));
}

model::Result<Json> boolean(const OscMessage& message, const OscArgument& argument) {
  if (argument.type == 'T') return Json(true);
  if (argument.type == 'F') return Json(false);
  if (is_number(argument) && (argument.number == 0.0 || argument.number == 1.0))
    return Json(argument.number == 1.0);
  return wrong(message, "T, F, 0 or 1");
}

model::Result<Json> text(const OscMessage& message, const OscArgument& argument) {
  if (!is_text(argument)) return wrong(message, "a text (s)");
  if (!is_utf8(argument.text)) return wrong(message, "a text in UTF-8", "other bytes");
  return Json(argument.text);
}

model::Result<Json> vector3(const OscMessage& message) {
  if (message.arguments.size() != 3) return wrong(message, "three numbers");
  Json out = Json::array();
  for (const OscArgument& argument : message.arguments) {
    auto one = number(message, argument);
    if (!one) return one;
    out.push_back(std::move(*one));
  }
  return out;
}

/// For an address that the show does not know: by what the arguments are.
model::Result<Json> by_shape(const OscMessage& message) {
  if (message.arguments.size() == 3) return vector3(message);
  if (message.arguments.size() != 1) return wrong(message, "one value, or three numbers");
  const OscArgument& only = message.arguments.front();
  if (only.type == 'N') return Json();
  if (is_text(only)) return text(message, only);
  return is_number(only) ? number(message, only) : boolean(message, only);
}

model::Result<Json> by_kind(Kind kind, const OscMessage& message) {
  if (kind == Kind::object || kind == Kind::map || kind == Kind::list)
    return wrong(message, "the address of a single parameter", "the address of several");
  if (message.arguments.size() == 1 && message.arguments.front().type == 'N') return Json();
  if (kind == Kind::vector3) return vector3(message);
  if (kind == Kind::grid) return wrong(message, "a parameter that fits a message", "a grid");
  if (message.arguments.size() != 1) return wrong(message, "one value");
  const OscArgument& only = message.arguments.front();
  switch (kind) {
  case Kind::boolean:
    return boolean(message, only);
  case Kind::integer:
    return integer(message, only);
  case Kind::integer_or_auto:
    return is_text(only) ? text(message, only) : integer(message, only);
  case Kind::number:
    return number(message, only);
  default:
    return text(message, only);
  }
}

} // namespace

model::Result<model::Edit> to_edit(const state::Snapshot& now, const OscMessage& message) {
  if (!is_utf8(message.address))
    return model::failure({Code::unknown_path, "", "an address in UTF-8", "other bytes", {}, {}});
  const auto found = model::find(*now.show, message.address);
  model::Result<Json> value = Json();
  if (!found)
    value = by_shape(message);
  else if (found->is_entry)
    value = by_kind(Kind::object, message);
  else
    value = by_kind(found->is_kind ? Kind::choice : found->row->kind, message);
  if (!value) return tl::unexpected(std::move(value.error()));
  return model::Edit{message.address, std::move(*value)};
}

model::Result<OscMessage> to_reply(const state::Snapshot& now, const std::string& address) {
  if (!is_utf8(address))
    return model::failure({Code::unknown_path, "", "an address in UTF-8", "other bytes", {}, {}});
  const auto value = state::value_at(now, address);
  if (!value) return tl::unexpected(value.error());
  OscMessage reply{address, {}};
  const auto add_number = [&](const Json& one) {
    const bool whole = one.is_number_integer();
    const auto integer = whole ? one.get<std::int64_t>() : 0;
    if (whole && integer >= INT32_MIN && integer <= INT32_MAX)
      reply.arguments.push_back({'i', 0.0, integer, {}});
    else
      reply.arguments.push_back({whole ? 'd' : 'f', one.get<double>(), 0, {}});
  };
  if (value->is_null())
    reply.arguments.push_back({'N', 0.0, 0, {}});
  else if (value->is_boolean())
    reply.arguments.push_back({value->get<bool>() ? 'T' : 'F', 0.0, 0, {}});
  else if (value->is_string())
    reply.arguments.push_back({'s', 0.0, 0, value->get<std::string>()});
  else if (value->is_number())
    add_number(*value);
  else if (value->is_array() && value->size() == 3 &&
           std::all_of(value->begin(), value->end(), [](const Json& one) { return one.is_number(); }))
    for (const Json& one : *value) reply.arguments.push_back({'f', one.get<double>(), 0, {}});
  else
    return model::failure(
        {Code::wrong_type, address, "the address of a single parameter", "the address of several", {}, {}});
  return reply;
}

} // namespace cupola::control
