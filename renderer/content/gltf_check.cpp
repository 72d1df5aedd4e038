// The part of glTF's JSON schema that the reader relies on, as tables.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/content/gltf_document.h"

namespace cupola::content::gltf {
namespace {

using Json = nlohmann::json;

enum class Kind : std::uint8_t {
  stride,
  word,
  index,
  whole,
  number,
  text,
  flag,
  object,
  indices,
  numbers,
  texts,
  objects,
  index_map,
  index_maps
};

struct Rule {
  const char* name;
  Kind kind;
  bool required = false;
  const char* refers = nullptr;              ///< list that an index points into; null: any
  const std::vector<Rule>* inside = nullptr; ///< of an object, or of each object of a list
  std::size_t length = 0;                    ///< of a list of numbers; 0: any
  std::vector<std::string> words = {};       ///< of a word: those that there are
};
using Rules = std::vector<Rule>;

const Rules& texture_info_rules() {
  static const Rules transform{{"offset", Kind::numbers, false, nullptr, nullptr, 2},
                               {"scale", Kind::numbers, false, nullptr, nullptr, 2},
                               {"rotation", Kind::number},
                               {"texCoord", Kind::whole}};
  static const Rules extensions{{"KHR_texture_transform", Kind::object, false, nullptr, &transform}};
  static const Rules rules{{"index", Kind::index, true, "textures"},
                           {"texCoord", Kind::whole},
                           {"scale", Kind::number},
                           {"strength", Kind::number},
                           {"extensions", Kind::object, false, nullptr, &extensions}};
  return rules;
}

const Rules& material_rules() {
  static const Rules* info = &texture_info_rules();
  static const Rules pbr{{"baseColorFactor", Kind::numbers, false, nullptr, nullptr, 4},
                         {"baseColorTexture", Kind::object, false, nullptr, info},
                         {"metallicFactor", Kind::number},
                         {"roughnessFactor", Kind::number},
                         {"metallicRoughnessTexture", Kind::object, false, nullptr, info}};
  static const Rules strength{{"emissiveStrength", Kind::number}};
  static const Rules extensions{{"KHR_materials_unlit", Kind::object},
                                {"KHR_materials_emissive_strength", Kind::object, false, nullptr, &strength}};
  static const Rules rules{{"name", Kind::text},
                           {"pbrMetallicRoughness", Kind::object, false, nullptr, &pbr},
                           {"normalTexture", Kind::object, false, nullptr, info},
                           {"occlusionTexture", Kind::object, false, nullptr, info},
                           {"emissiveTexture", Kind::object, false, nullptr, info},
                           {"emissiveFactor", Kind::numbers, false, nullptr, nullptr, 3},
                           {"alphaMode", Kind::word, false, nullptr, nullptr, 0, {"OPAQUE", "MASK", "BLEND"}},
                           {"alphaCutoff", Kind::number},
                           {"doubleSided", Kind::flag},
                           {"extensions", Kind::object, false, nullptr, &extensions}};
  return rules;
}

const Rules& mesh_rules() {
  static const Rules primitive{
      {"attributes", Kind::index_map, true, "accessors"}, {"indices", Kind::index, false, "accessors"},
      {"material", Kind::index, false, "materials"},      {"mode", Kind::whole},
      {"targets", Kind::index_maps, false, "accessors"},  {"extensions", Kind::object}};
  static const Rules rules{{"primitives", Kind::objects, true, nullptr, &primitive},
                           {"weights", Kind::numbers}};
  return rules;
}

const Rules& accessor_rules() {
  static const Rules indices{{"bufferView", Kind::index, true, "bufferViews"},
                             {"byteOffset", Kind::whole},
                             {"componentType", Kind::whole, true}};
  static const Rules values{{"bufferView", Kind::index, true, "bufferViews"}, {"byteOffset", Kind::whole}};
  static const Rules sparse{{"count", Kind::whole, true},
                            {"indices", Kind::object, true, nullptr, &indices},
                            {"values", Kind::object, true, nullptr, &values}};
  static const Rules rules{{"bufferView", Kind::index, false, "bufferViews"},
                           {"byteOffset", Kind::whole},
                           {"componentType", Kind::whole, true},
                           {"normalized", Kind::flag},
                           {"count", Kind::whole, true},
                           {"type",
                            Kind::word,
                            true,
                            nullptr,
                            nullptr,
                            0,
                            {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}},
                           {"sparse", Kind::object, false, nullptr, &sparse},
                           {"min", Kind::numbers},
                           {"max", Kind::numbers}};
  return rules;
}

const Rules& node_rules() {
  static const Rules light{{"light", Kind::index, true, "extensions/KHR_lights_punctual/lights"}};
  static const Rules instancing{{"attributes", Kind::index_map, true, "accessors"}};
  static const Rules extensions{{"KHR_lights_punctual", Kind::object, false, nullptr, &light},
                                {"EXT_mesh_gpu_instancing", Kind::object, false, nullptr, &instancing}};
  static const Rules rules{{"name", Kind::text},
                           {"children", Kind::indices, false, "nodes"},
                           {"mesh", Kind::index, false, "meshes"},
                           {"skin", Kind::index, false, "skins"},
                           {"matrix", Kind::numbers, false, nullptr, nullptr, 16},
                           {"rotation", Kind::numbers, false, nullptr, nullptr, 4},
                           {"scale", Kind::numbers, false, nullptr, nullptr, 3},
                           {"translation", Kind::numbers, false, nullptr, nullptr, 3},
                           {"weights", Kind::numbers},
                           {"extensions", Kind::object, false, nullptr, &extensions}};
  return rules;
}

const Rules& animation_rules() {
  static const Rules target{{"node", Kind::index, false, "nodes"}, {"path", Kind::text, true}};
  static const Rules channel{{"sampler", Kind::whole, true},
                             {"target", Kind::object, true, nullptr, &target}};
  static const Rules sampler{
      {"input", Kind::index, true, "accessors"},
      {"interpolation", Kind::word, false, nullptr, nullptr, 0, {"LINEAR", "STEP", "CUBICSPLINE"}},
      {"output", Kind::index, true, "accessors"}};
  static const Rules rules{{"name", Kind::text},
                           {"channels", Kind::objects, true, nullptr, &channel},
                           {"samplers", Kind::objects, true, nullptr, &sampler}};
  return rules;
}

const Rules& lights_rules() {
  static const Rules spot{{"innerConeAngle", Kind::number}, {"outerConeAngle", Kind::number}};
  static const Rules light{{"type", Kind::word, true, nullptr, nullptr, 0, {"directional", "point", "spot"}},
                           {"color", Kind::numbers, false, nullptr, nullptr, 3},
                           {"intensity", Kind::number},
                           {"range", Kind::number},
                           {"spot", Kind::object, false, nullptr, &spot}};
  static const Rules punctual{{"lights", Kind::objects, true, nullptr, &light}};
  static const Rules rules{{"KHR_lights_punctual", Kind::object, false, nullptr, &punctual}};
  return rules;
}

const Rules& root_rules() {
  static const Rules asset{{"version", Kind::text, true}, {"minVersion", Kind::text}};
  static const Rules view{{"buffer", Kind::index, true, "buffers"},
                          {"byteOffset", Kind::whole},
                          {"byteLength", Kind::whole, true},
                          {"byteStride", Kind::stride}};
  static const Rules buffer{{"uri", Kind::text}, {"byteLength", Kind::whole, true}};
  static const Rules image{
      {"uri", Kind::text}, {"mimeType", Kind::text}, {"bufferView", Kind::index, false, "bufferViews"}};
  static const Rules texture{{"source", Kind::index, false, "images"},
                             {"sampler", Kind::index, false, "samplers"}};
  static const Rules sampler{
      {"magFilter", Kind::whole}, {"minFilter", Kind::whole}, {"wrapS", Kind::whole}, {"wrapT", Kind::whole}};
  static const Rules skin{{"inverseBindMatrices", Kind::index, false, "accessors"},
                          {"skeleton", Kind::index, false, "nodes"},
                          {"joints", Kind::indices, true, "nodes"}};
  static const Rules scene{{"nodes", Kind::indices, false, "nodes"}};
  static const Rules rules{{"asset", Kind::object, true, nullptr, &asset},
                           {"extensionsUsed", Kind::texts},
                           {"extensionsRequired", Kind::texts},
                           {"extensions", Kind::object, false, nullptr, &lights_rules()},
                           {"accessors", Kind::objects, false, nullptr, &accessor_rules()},
                           {"bufferViews", Kind::objects, false, nullptr, &view},
                           {"buffers", Kind::objects, false, nullptr, &buffer},
                           {"images", Kind::objects, false, nullptr, &image},
                           {"textures", Kind::objects, false, nullptr, &texture},
                           {"samplers", Kind::objects, false, nullptr, &sampler},
                           {"materials", Kind::objects, false, nullptr, &material_rules()},
                           {"meshes", Kind::objects, false, nullptr, &mesh_rules()},
                           {"nodes", Kind::objects, false, nullptr, &node_rules()},
                           {"skins", Kind::objects, false, nullptr, &skin},
                           {"animations", Kind::objects, false, nullptr, &animation_rules()},
                           {"scenes", Kind::objects, false, nullptr, &scene},
                           {"scene", Kind::index, false, "scenes"}};
  return rules;
}

/// A value in a few letters, for "found …".
std::string brief(const Json& value) {
  std::string text = value.is_structured() ? (value.is_array() ? "a list" : "an object")
                                           : value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "…";
  return text;
}

/// As JSON pointers want it (RFC 6901).
std::string escaped(const std::string& key) {
  std::string out;
  for (const char letter : key) {
    if (letter == '~')
      out += "~0";
    else if (letter == '/')
      out += "~1";
    else
      out += letter;
  }
  return out;
}

class Checker {
public:
  Checker(const Json& root, Report& report)
      : root_(root)
      , report_(report) {}

  void object(const Json& value, const Rules& rules, const std::string& at) {
    for (const Rule& rule : rules) {
      const auto found = value.find(rule.name);
      const std::string place = at + '/' + rule.name;
      if (found == value.end()) {
        if (rule.required) report_.invalid(place, "a value, which glTF requires", "nothing");
        continue;
      }
      check(*found, rule, place);
    }
  }

private:
  void check(const Json& value, const Rule& rule, const std::string& at) {
    switch (rule.kind) {
    case Kind::index:
      index(value, rule, at);
      break;
    case Kind::whole:
      whole(value, at);
      break;
    case Kind::number:
      expect(value.is_number(), value, "a number", at);
      break;
    case Kind::text:
      expect(value.is_string(), value, "a text", at);
      break;
    case Kind::flag:
      expect(value.is_boolean(), value, "true or false", at);
      break;
    case Kind::object:
      if (expect(value.is_object(), value, "an object", at) && rule.inside) object(value, *rule.inside, at);
      break;
    case Kind::index_map:
      index_map(value, rule, at);
      break;
    case Kind::word:
      word(value, rule, at);
      break;
    case Kind::stride:
      stride(value, at);
      break;
    default:
      list(value, rule, at);
    }
  }

  void list(const Json& value, const Rule& rule, const std::string& at) {
    if (!expect(value.is_array(), value, "a list", at)) return;
    if (rule.length != 0 && value.size() != rule.length) {
      report_.invalid(at, std::to_string(rule.length) + " numbers", std::to_string(value.size()));
      return;
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string place = at + '/' + std::to_string(i);
      switch (rule.kind) {
      case Kind::indices:
        index(value[i], rule, place);
        break;
      case Kind::numbers:
        expect(value[i].is_number(), value[i], "a number", place);
        break;
      case Kind::texts:
        expect(value[i].is_string(), value[i], "a text", place);
        break;
      case Kind::index_maps:
        index_map(value[i], rule, place);
        break;
      default:
        if (expect(value[i].is_object(), value[i], "an object", place)) object(value[i], *rule.inside, place);
      }
    }
  }

  void index_map(const Json& value, const Rule& rule, const std::string& at) {
    if (!expect(value.is_object(), value, "an object", at)) return;
    for (const auto& [key, item] : value.items()) index(item, rule, at + '/' + escaped(key));
  }

  void index(const Json& value, const Rule& rule, const std::string& at) {
    if (!whole(value, at)) return;
    const Json::json_pointer pointer(std::string("/") + rule.refers);
    const std::size_t size =
        root_.contains(pointer) && root_.at(pointer).is_array() ? root_.at(pointer).size() : 0;
    if (value.get<std::uint64_t>() >= size)
      report_.invalid(at,
                      "an index into /" + std::string(rule.refers) + ", which has " + std::to_string(size),
                      brief(value));
  }

  void word(const Json& value, const Rule& rule, const std::string& at) {
    std::string all;
    for (const std::string& one : rule.words) all += (all.empty() ? "" : ", ") + one;
    const bool known = value.is_string() && std::find(rule.words.begin(), rule.words.end(),
                                                      value.get<std::string>()) != rule.words.end();
    expect(known, value, ("one of " + all).c_str(), at);
  }

  void stride(const Json& value, const std::string& at) {
    if (!whole(value, at)) return;
    const auto bytes = value.get<std::uint64_t>();
    expect(bytes >= 4 && bytes <= 252 && bytes % 4 == 0, value, "a multiple of 4 from 4 to 252", at);
  }

  bool whole(const Json& value, const std::string& at) {
    return expect(value.is_number_unsigned() && value.get<std::uint64_t>() <= largest_file, value,
                  "a whole number from 0 to 2147483647", at);
  }

  bool expect(bool right, const Json& value, const char* expected, const std::string& at) {
    if (!right) report_.invalid(at, expected, brief(value));
    return right;
  }

  const Json& root_;
  Report& report_;
};

/// Deeper nesting than any glTF needs would only feed recursive parsers.
std::size_t depth_of(const std::string& json) {
  std::size_t depth = 0;
  std::size_t deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

/// Line and column of a byte, counted from 1.
std::string line_of(const std::string& text, std::size_t byte) {
  std::size_t line = 1;
  std::size_t column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    ++column;
    if (text[i] != '\n') continue;
    ++line;
    column = 1;
  }
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// What only this reader looks at, and free-form data that nobody does.
void clean(Json& json) {
  for (const char* key : {"buffers", "images", "cameras", "extras"}) json.erase(key);
  for (const char* list : {"accessors", "bufferViews", "textures", "materials", "meshes", "nodes", "skins",
                           "animations", "scenes"}) {
    if (!json.contains(list)) continue;
    for (Json& item : json[list]) {
      item.erase("extras");
      item.erase("camera");
    }
  }
}

} // namespace

bool check_json(std::string& text, Document& out, std::vector<std::string>& buffer_uris,
                std::vector<std::uint64_t>& buffer_lengths, Report& report) {
  if (depth_of(text) > 64) {
    report.error(model::Code::scene_limit, "", "JSON nested at most 64 levels deep", "deeper nesting");
    return false;
  }
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    report.error(model::Code::scene_unreadable, "", "JSON", "a mistake in " + line_of(text, error.byte));
    return false;
  } catch (const Json::exception&) {
    report.error(model::Code::scene_unreadable, "", "JSON", "a number beyond the range of double precision");
    return false;
  }
  if (!json.is_object()) {
    report.invalid("", "an object", brief(json));
    return false;
  }
  const Json version =
      json.contains("asset") && json["asset"].is_object() ? json["asset"].value("version", Json()) : Json();
  if (version.is_string() && !version.get<std::string>().starts_with("2.")) {
    report.error(model::Code::scene_unsupported, "/asset/version", "glTF 2", brief(version));
    return false;
  }
  Checker(json, report).object(json, root_rules(), "");
  if (report.failed()) return false;
  for (const Json& buffer : json.value("buffers", Json::array())) {
    buffer_uris.push_back(buffer.value("uri", std::string()));
    buffer_lengths.push_back(buffer["byteLength"].get<std::uint64_t>());
  }
  for (const Json& image : json.value("images", Json::array()))
    out.images.push_back({image.value("uri", std::string()), image.value("bufferView", -1)});
  clean(json);
  text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return true;
}

} // namespace cupola::content::gltf
