// The parameter table as a JSON Schema. Defaults are read from a scratch show, which holds every alternative
// in turn.
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "configs/loader/decode.h"
#include "configs/loader/loader.h"
#include "configs/model/parameters.h"

namespace cupola::loader {

using model::Kind;
using model::Parameter;
using model::Type;
using Json = nlohmann::ordered_json;

namespace {

/// 35000, not 35000.0.
Json number(double value) {
  if (value == std::trunc(value)) return static_cast<std::int64_t>(value);
  return value;
}

class Generator {
public:
  /// Adds the definition of the type, once; `self` is a scratch struct of it.
  void define(const Type& type, void* self);

  Json definitions = Json::object();

private:
  Json value(const Parameter& row, void* owner);
  Json leaf(const Parameter& row, void* owner);
  void members(const std::vector<Parameter>& rows, void* owner, Json& schema);
  Json alternatives(const Type& type, void* self);
  static Json reference(const Type& type) { return {{"$ref", "#/$defs/" + type.name}}; }
};

void limit(const Parameter& row, Json& schema) {
  if (!row.range) return;
  schema[row.range->min_exclusive ? "exclusiveMinimum" : "minimum"] = number(row.range->min);
  schema["maximum"] = number(row.range->max);
}

std::string description(const Parameter& row) {
  const std::string_view unit = model::unit_symbol(row.unit);
  return unit.empty() ? row.doc : row.doc + " [" + std::string(unit) + ']';
}

Json Generator::leaf(const Parameter& row, void* owner) {
  Json schema = Json::object();
  switch (row.kind) {
  case Kind::boolean:
    schema["type"] = "boolean";
    break;
  case Kind::integer:
  case Kind::number:
    schema["type"] = row.kind == Kind::integer ? "integer" : "number";
    limit(row, schema);
    break;
  case Kind::integer_or_auto: {
    Json integer{{"type", "integer"}};
    limit(row, integer);
    schema["oneOf"] = Json::array({std::move(integer), Json{{"const", "auto"}}});
    break;
  }
  case Kind::text:
    schema["type"] = "string";
    schema["maxLength"] = max_text_length;
    schema["not"] = {{"pattern", "[\\u0000-\\u001f\\u007f]"}};
    break;
  case Kind::choice:
    schema["enum"] = row.choices;
    break;
  case Kind::grid: {
    Json item{{"type", "number"}};
    limit(row, item);
    const Json pair{{"type", "array"}, {"items", std::move(item)}, {"minItems", 2}, {"maxItems", 2}};
    schema = {{"type", "array"}, {"items", {{"type", "array"}, {"items", pair}}}};
    break;
  }
  default: {
    Json item{{"type", "number"}};
    limit(row, item);
    schema = {{"type", "array"}, {"items", std::move(item)}, {"minItems", 3}, {"maxItems", 3}};
  }
  }
  const Json standard = row.read(owner);
  if (row.kind == Kind::integer_or_auto && standard.is_null())
    schema["default"] = "auto";
  else if (!row.required && !standard.is_null())
    schema["default"] = standard;
  return schema;
}

Json Generator::value(const Parameter& row, void* owner) {
  Json schema;
  switch (row.kind) {
  case Kind::object:
    define(*row.type, const_cast<void*>(row.nested(owner))); // the scratch show is not const
    schema = reference(*row.type);
    break;
  case Kind::map:
    define(*row.type, row.add(owner, "scratch"));
    schema = {{"type", "object"},
              {"additionalProperties", reference(*row.type)},
              {"propertyNames",
               {{"pattern", "^[A-Za-z0-9]"}, {"not", {{"pattern", "[^A-Za-z0-9_.-]"}}}, {"maxLength", 64}}},
              {"minProperties", number(row.range->min)},
              {"maxProperties", number(row.range->max)}};
    break;
  case Kind::list:
    define(*row.type, row.add(owner, ""));
    schema = {{"type", "array"}, {"items", reference(*row.type)}, {"maxItems", number(row.range->max)}};
    break;
  default:
    schema = leaf(row, owner);
  }
  schema["description"] = description(row);
  if (row.kind != Kind::object) schema["x-cost"] = model::cost_name(row.cost);
  return schema;
}

/// Properties of the rows, and which of them must be there.
void Generator::members(const std::vector<Parameter>& rows, void* owner, Json& schema) {
  for (const Parameter& row : rows) {
    schema["properties"][row.name] = value(row, owner);
    if (row.required || (row.kind == Kind::map && row.range->min > 0)) schema["required"].push_back(row.name);
  }
}

Json Generator::alternatives(const Type& type, void* self) {
  Json list = Json::array();
  for (std::size_t i = 0; i < type.alternatives.size(); ++i) {
    const model::Alternative& alternative = type.alternatives[i];
    Json schema{{"title", alternative.name}, {"description", alternative.doc}};
    schema["properties"]["kind"] = {{"const", alternative.name}};
    if (type.kind_required || i > 0) schema["required"].push_back("kind");
    members(alternative.type->rows, type.activate(self, i), schema);
    list.push_back(std::move(schema));
  }
  return list;
}

void Generator::define(const Type& type, void* self) {
  if (definitions.contains(type.name)) return;
  definitions[type.name] = nullptr; // holds the place in the order
  Json schema{{"type", "object"}, {"description", type.doc}};
  schema["properties"] = Json::object();
  if (!type.alternatives.empty()) {
    schema["oneOf"] = alternatives(type, self);
    Json kind{{"description", "Which of the alternatives this is."},
              {"x-cost", model::cost_name(type.kind_cost)}};
    kind["enum"] = Json::array();
    for (const model::Alternative& alternative : type.alternatives) kind["enum"].push_back(alternative.name);
    if (!type.kind_required) kind["default"] = type.alternatives.front().name;
    schema["properties"]["kind"] = std::move(kind);
  }
  members(type.rows, self, schema);
  schema["unevaluatedProperties"] = false;
  definitions[type.name] = std::move(schema);
}

} // namespace

Json show_schema() {
  model::Show scratch;
  Generator generator;
  const Type& root = model::show_type();
  generator.define(root, &scratch);
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"$id", "urn:cupola:show:" + std::to_string(newest_version)},
          {"title", "Cupola show"},
          {"$ref", "#/$defs/" + root.name},
          {"$defs", std::move(generator.definitions)}};
}

} // namespace cupola::loader
