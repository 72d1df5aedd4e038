#include "renderer/content/gltf_instances.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

namespace cupola::content::gltf {
namespace {

constexpr const char* extension = "EXT_mesh_gpu_instancing";
constexpr std::size_t most_instances = 1'000'000; ///< of a file: each is a node

struct Attribute {
  const char* name;
  int components;
  std::optional<Numbers> numbers;
};

/// Reads translation, rotation and scale, each where it is given; how many instances there are, or nothing
/// after a problem.
std::optional<std::size_t> read_attributes(const Document& document, const tinygltf::Value& given,
                                           const std::string& at, std::array<Attribute, 3>& out,
                                           Report& report) {
  std::optional<std::size_t> count;
  for (Attribute& attribute : out) {
    if (!given.Has(attribute.name)) continue;
    attribute.numbers = read_numbers(document, given.Get(attribute.name).GetNumberAsInt(), report);
    if (!attribute.numbers) return std::nullopt;
    const Numbers& numbers = *attribute.numbers;
    const std::string own = at + '/' + attribute.name;
    if (numbers.components != attribute.components) {
      report.invalid(own, std::to_string(attribute.components) + " numbers an instance",
                     std::to_string(numbers.components));
      return std::nullopt;
    }
    if (count && numbers.count != *count) {
      report.invalid(own, std::to_string(*count) + " elements, as many as the other attributes have",
                     std::to_string(numbers.count));
      return std::nullopt;
    }
    count = numbers.count;
  }
  if (!count) report.invalid(at, "TRANSLATION, ROTATION or SCALE", "none of them");
  return count;
}

RigNode instance_of(const std::array<Attribute, 3>& attributes, std::size_t i, const std::string& at,
                    Report& report) {
  const auto& [translation, rotation, scale] = attributes;
  RigNode made;
  if (translation.numbers) made.translation = translation.numbers->vec3(i);
  if (scale.numbers) made.scale = scale.numbers->vec3(i);
  if (!rotation.numbers) return made;
  const float* q = rotation.numbers->values.data() + 4 * i;
  const glm::quat turned(q[3], q[0], q[1], q[2]);
  if (glm::dot(turned, turned) > 0.0f)
    made.rotation = glm::normalize(turned);
  else
    report.invalid(at + "/ROTATION", "unit quaternions", "length 0 in element " + std::to_string(i));
  return made;
}

} // namespace

std::vector<std::vector<std::size_t>> read_instances(const Document& document, Rig& rig, Report& report) {
  std::vector<std::vector<std::size_t>> out(document.model.nodes.size());
  std::size_t total = 0;
  for (std::size_t node = 0; node < out.size(); ++node) {
    const tinygltf::Node& from = document.model.nodes[node];
    const auto found = from.extensions.find(extension);
    if (found == from.extensions.end() || from.mesh < 0) continue;
    const std::string whole = path("nodes", node, "/extensions/") + extension;
    if (from.skin >= 0) {
      report.warning(whole, "a mesh without a skin", "one that follows its joints", "It is drawn once.");
      continue;
    }
    std::array<Attribute, 3> attributes{Attribute{"TRANSLATION", 3, {}}, Attribute{"ROTATION", 4, {}},
                                        Attribute{"SCALE", 3, {}}};
    const std::string at = whole + "/attributes";
    const auto count = read_attributes(document, found->second.Get("attributes"), at, attributes, report);
    if (!count) continue;
    total += *count;
    if (total > most_instances) {
      report.error(model::Code::scene_limit, at,
                   "at most " + std::to_string(most_instances) + " instances in a file",
                   std::to_string(total));
      break;
    }
    for (std::size_t i = 0; i < *count && !report.failed(); ++i) {
      RigNode made = instance_of(attributes, i, at, report);
      made.parent = static_cast<int>(node);
      made.weights = rig.nodes[node].weights;
      out[node].push_back(rig.nodes.size());
      rig.order.push_back(rig.nodes.size());
      rig.nodes.push_back(std::move(made));
    }
  }
  return out;
}

} // namespace cupola::content::gltf
