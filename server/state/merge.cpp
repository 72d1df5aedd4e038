#include "server/state/merge.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <vector>

#include "configs/model/parameters.h"

namespace cupola::state {

using model::Json;
using model::Kind;
using model::Parameter;
using model::Type;

namespace {

/// What a value of the document is, as far as the table knows.
struct Node {
  enum class Is : std::uint8_t { structure, entries, leaf } is = Is::leaf;
  const Type* type = nullptr; ///< of the struct, or of each entry
};

Node node_of(const Parameter& row) {
  if (row.kind == Kind::object) return {Node::Is::structure, row.type};
  if (row.kind == Kind::map || row.kind == Kind::list) return {Node::Is::entries, row.type};
  return {};
}

const model::Alternative* held_alternative(const Type& type, const Json& value) {
  if (!value.is_object()) return nullptr;
  const auto kind = value.find("kind");
  for (const model::Alternative& alternative : type.alternatives)
    if (kind == value.end() ? !type.kind_required : *kind == alternative.name) return &alternative;
  return nullptr;
}

/// The node of a key, nullopt where the table knows no such key.
std::optional<Node> child(const Node& node, const Json& value, const std::string& key) {
  if (node.is == Node::Is::entries) return Node{Node::Is::structure, node.type};
  if (node.is == Node::Is::leaf) return std::nullopt;
  if (key == "kind" && !node.type->alternatives.empty()) return Node{};
  for (const Parameter& row : node.type->rows)
    if (row.name == key) return node_of(row);
  if (const model::Alternative* held = held_alternative(*node.type, value))
    for (const Parameter& row : held->type->rows)
      if (row.name == key) return node_of(row);
  return std::nullopt;
}

/// All keys that the struct or container may be asked for here.
std::vector<std::string> known_keys(const Node& node, const Json& value) {
  std::vector<std::string> keys;
  if (node.is == Node::Is::entries) {
    if (value.is_object())
      for (const auto& [key, entry] : value.items()) keys.push_back(key);
    return keys;
  }
  if (node.is == Node::Is::leaf) return keys;
  if (!node.type->alternatives.empty()) keys.emplace_back("kind");
  if (const model::Alternative* held = held_alternative(*node.type, value))
    for (const Parameter& row : held->type->rows) keys.push_back(row.name);
  for (const Parameter& row : node.type->rows) keys.push_back(row.name);
  return keys;
}

/// The parts of a JSON pointer, unescaped; nullopt where it does not begin with '/'.
std::optional<std::vector<std::string>> split(std::string_view pointer) {
  std::vector<std::string> parts;
  if (pointer.empty()) return parts;
  if (pointer.front() != '/') return std::nullopt;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      parts.emplace_back();
    } else if (pointer[i] == '~' && i + 1 < pointer.size() &&
               (pointer[i + 1] == '0' || pointer[i + 1] == '1')) {
      parts.back() += pointer[++i] == '0' ? '~' : '/';
    } else {
      parts.back() += pointer[i];
    }
  }
  return parts;
}

std::optional<std::size_t> index_of(const Json& list, const std::string& part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size() || part != std::to_string(index) ||
      index >= list.size())
    return std::nullopt;
  return index;
}

/// The value of an existing part, nullptr where there is none.
Json* part_of(Json& value, const std::string& part) {
  if (value.is_object()) {
    const auto it = value.find(part);
    return it == value.end() ? nullptr : &*it;
  }
  if (value.is_array())
    if (const auto index = index_of(value, part)) return &value[*index];
  return nullptr;
}

/// Parameters of the former kind leave when the patch brings another one.
void drop_former_kind(Json& target, const Node& node, const Json& patch) {
  if (node.is != Node::Is::structure || node.type->alternatives.empty()) return;
  const auto asked = patch.find("kind");
  if (asked == patch.end()) return;
  const model::Alternative* former = held_alternative(*node.type, target);
  if (!former || *asked == former->name) return;
  for (const Parameter& row : former->type->rows) target.erase(row.name);
  if (asked->is_null())
    target.erase("kind");
  else
    target["kind"] = *asked;
}

void merge(Json& target, const std::optional<Node>& node, const Json& patch) {
  if (!patch.is_object()) {
    target = patch;
    return;
  }
  if (!target.is_object()) target = Json::object();
  if (node) drop_former_kind(target, *node, patch);
  for (const auto& [key, value] : patch.items()) {
    if (value.is_null())
      target.erase(key);
    else
      merge(target[key], node ? child(*node, target, key) : std::nullopt, value);
  }
}

model::Problem lost(const Node& node, const Json& value, std::string_view pointer, const std::string& part) {
  model::Problem problem{model::Code::unknown_path, std::string(pointer), {}, '"' + part + '"', {}, {}};
  const std::vector<std::string> keys = known_keys(node, value);
  if (value.is_array()) {
    problem.expected = value.empty() || node.is == Node::Is::leaf
                           ? "the address of a whole value"
                           : "an index from 0 to " + std::to_string(value.size() - 1);
  } else if (keys.empty()) {
    problem.expected = "the address of a parameter";
    problem.advice = "The address goes on beyond a value.";
  } else {
    problem.expected = "an address of this show";
    if (const std::string near = model::nearest(part, keys); !near.empty())
      problem.advice = "Did you mean \"" + near + "\"?";
    else if (keys.size() <= 24) {
      problem.advice = "Known here:";
      for (const std::string& key : keys) problem.advice += (key == keys.front() ? " " : ", ") + key;
      problem.advice += '.';
    }
  }
  return problem;
}

} // namespace

std::optional<model::Problem> apply_edit(Json& document, const model::Edit& edit) {
  const auto parts = split(edit.path);
  if (!parts) return unknown_path(document, edit.path);
  Node node{Node::Is::structure, &model::show_type()};
  if (parts->empty()) {
    if (edit.value.is_null())
      document = Json::object();
    else
      merge(document, node, edit.value);
    return std::nullopt;
  }

  Json* parent = &document;
  for (std::size_t i = 0; i + 1 < parts->size(); ++i) {
    const std::optional<Node> next = child(node, *parent, (*parts)[i]);
    Json* value = part_of(*parent, (*parts)[i]);
    if (!next || !value) return lost(node, *parent, edit.path, (*parts)[i]);
    node = *next;
    parent = value;
  }
  const std::string& last = parts->back();
  const std::optional<Node> next = child(node, *parent, last);
  if (!next) return lost(node, *parent, edit.path, last);
  if (parent->is_array()) {
    const auto index = index_of(*parent, last);
    if (!index) return lost(node, *parent, edit.path, last);
    if (edit.value.is_null())
      parent->erase(*index);
    else
      merge((*parent)[*index], next, edit.value);
    return std::nullopt;
  }
  Json patch = Json::object();
  patch[last] = edit.value;
  merge(*parent, node, patch);
  return std::nullopt;
}

model::Problem unknown_path(const Json& document, std::string_view pointer) {
  const auto parts = split(pointer);
  if (!parts)
    return {model::Code::unknown_path,         std::string(pointer),
            "an address that begins with '/'", '"' + std::string(pointer) + '"',
            "For example /quality/samples.",   {}};
  Node node{Node::Is::structure, &model::show_type()};
  Json root = document;
  Json* value = &root;
  for (const std::string& part : *parts) {
    const std::optional<Node> next = child(node, *value, part);
    Json* deeper = part_of(*value, part);
    if (!next || !deeper) return lost(node, *value, pointer, part);
    node = *next;
    value = deeper;
  }
  return lost(node, *value, pointer, parts->empty() ? "" : parts->back());
}

} // namespace cupola::state
