// Walks over the table: encode a show, find a row by its address, compare two shows.
#include "configs/model/parameters.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cupola::model {

using Json = nlohmann::ordered_json;

std::string_view unit_symbol(Unit unit) {
  switch (unit) {
  case Unit::none:
    return "";
  case Unit::metre:
    return "m";
  case Unit::degree:
    return "°";
  case Unit::second:
    return "s";
  case Unit::hertz:
    return "Hz";
  case Unit::pixel:
    return "px";
  case Unit::fraction:
    return "of the output";
  case Unit::factor:
    return "×";
  case Unit::per_metre:
    return "1/m";
  }
  return "";
}

std::string_view cost_name(Cost cost) {
  switch (cost) {
  case Cost::uniform:
    return "uniform";
  case Cost::rebuild:
    return "rebuild";
  case Cost::reopen:
    return "reopen";
  case Cost::restart:
    return "restart";
  }
  return "";
}

std::string escaped(std::string_view key) {
  std::string out;
  for (const char c : key) {
    if (c == '~')
      out += "~0";
    else if (c == '/')
      out += "~1";
    else
      out += c;
  }
  return out;
}

namespace {

std::string unescaped(std::string_view token) {
  std::string out;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] == '~' && i + 1 < token.size() && (token[i + 1] == '0' || token[i + 1] == '1'))
      out += token[++i] == '0' ? '~' : '/';
    else
      out += token[i];
  }
  return out;
}

/// Calls visit(row, owner) for every row that applies to this struct: the held alternative's, then its own.
template <class Visit>
void each_row(const Type& type, const void* self, const Visit& visit) {
  if (!type.alternatives.empty())
    for (const Parameter& row : type.alternatives[type.active(self)].type->rows) visit(row, type.held(self));
  for (const Parameter& row : type.rows) visit(row, self);
}

Json encode(const Type& type, const void* self) {
  Json out = Json::object();
  if (!type.alternatives.empty()) out["kind"] = type.alternatives[type.active(self)].name;
  each_row(type, self, [&](const Parameter& row, const void* owner) {
    switch (row.kind) {
    case Kind::object:
      out[row.name] = encode(*row.type, row.nested(owner));
      break;
    case Kind::map: {
      Json entries = Json::object();
      for (const std::string& key : row.keys(owner)) entries[key] = encode(*row.type, row.entry(owner, key));
      out[row.name] = std::move(entries);
      break;
    }
    case Kind::list: {
      Json entries = Json::array();
      for (const std::string& key : row.keys(owner))
        entries.push_back(encode(*row.type, row.entry(owner, key)));
      out[row.name] = std::move(entries);
      break;
    }
    case Kind::integer_or_auto: {
      Json value = row.read(owner);
      out[row.name] = value.is_null() ? Json("auto") : std::move(value);
      break;
    }
    default: {
      Json value = row.read(owner);
      if (!value.is_null()) out[row.name] = std::move(value);
    }
    }
  });
  return out;
}

void collect_leaves(const Type& type, const void* self, const std::string& prefix,
                    std::vector<std::string>& out) {
  if (!type.alternatives.empty()) out.push_back(prefix + "/kind");
  each_row(type, self, [&](const Parameter& row, const void* owner) {
    const std::string here = prefix + '/' + row.name;
    if (row.kind == Kind::object)
      collect_leaves(*row.type, row.nested(owner), here, out);
    else if (row.kind == Kind::map || row.kind == Kind::list)
      for (const std::string& key : row.keys(owner))
        collect_leaves(*row.type, row.entry(owner, key), here + '/' + escaped(key), out);
    else
      out.push_back(here);
  });
}

void compare(const Type& type, const void* a, const void* b, const std::string& prefix,
             std::vector<Difference>& out);

void compare_entries(const Parameter& row, const void* a, const void* b, const std::string& here,
                     std::vector<Difference>& out) {
  const std::vector<std::string> before = row.keys(a), after = row.keys(b);
  for (const std::string& key : before) {
    const std::string at = here + '/' + escaped(key);
    if (const void* entry = row.entry(b, key))
      compare(*row.type, row.entry(a, key), entry, at, out);
    else
      out.push_back({at, row.cost});
  }
  for (const std::string& key : after)
    if (!row.entry(a, key)) out.push_back({here + '/' + escaped(key), row.cost});
}

void compare(const Type& type, const void* a, const void* b, const std::string& prefix,
             std::vector<Difference>& out) {
  const auto compare_row = [&](const Parameter& row, const void* owner_a, const void* owner_b) {
    const std::string here = prefix + '/' + row.name;
    if (row.kind == Kind::object)
      compare(*row.type, row.nested(owner_a), row.nested(owner_b), here, out);
    else if (row.kind == Kind::map || row.kind == Kind::list)
      compare_entries(row, owner_a, owner_b, here, out);
    else if (row.read(owner_a) != row.read(owner_b))
      out.push_back({here, row.cost});
  };
  if (!type.alternatives.empty()) {
    if (type.active(a) != type.active(b))
      out.push_back({prefix + "/kind", type.kind_cost});
    else
      for (const Parameter& row : type.alternatives[type.active(a)].type->rows)
        compare_row(row, type.held(a), type.held(b));
  }
  for (const Parameter& row : type.rows) compare_row(row, a, b);
}

} // namespace

Json to_json(const Show& show) { return encode(show_type(), &show); }

std::vector<std::string> leaf_paths(const Show& show) {
  std::vector<std::string> out;
  collect_leaves(show_type(), &show, "", out);
  return out;
}

std::vector<Difference> differences(const Show& from, const Show& to) {
  std::vector<Difference> out;
  compare(show_type(), &from, &to, "", out);
  return out;
}

std::optional<Found> find(const Show& show, std::string_view pointer) {
  Found at{nullptr, nullptr, &show_type(), false, false};
  const void* self = &show;
  while (!pointer.empty()) {
    if (pointer.front() != '/' || !at.type || !self) return std::nullopt;
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    const std::string token = unescaped(pointer.substr(1, end - 1));
    pointer.remove_prefix(end);

    const bool in_entries =
        at.row && (at.row->kind == Kind::map || at.row->kind == Kind::list) && !at.is_entry;
    if (in_entries) {
      self = at.row->entry(at.owner, token);
      if (!self) return std::nullopt;
      at.is_entry = true;
      continue;
    }
    if (token == "kind" && !at.type->alternatives.empty()) {
      if (!pointer.empty()) return std::nullopt;
      return Found{nullptr, self, at.type, true, false};
    }
    const Parameter* next = nullptr;
    const void* owner = nullptr;
    each_row(*at.type, self, [&](const Parameter& row, const void* row_owner) {
      if (row.name == token) {
        next = &row;
        owner = row_owner;
      }
    });
    if (!next) return std::nullopt;
    at = Found{next, owner, next->type, false, false};
    self = next->kind == Kind::object ? next->nested(owner) : owner;
  }
  return at;
}

} // namespace cupola::model
