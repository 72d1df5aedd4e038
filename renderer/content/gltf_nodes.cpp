#include "renderer/content/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cupola::content::gltf {
namespace {

glm::vec3 vec3(const std::vector<double>& v, const glm::vec3& fallback) {
  if (v.size() != 3) return fallback;
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

std::size_t target_count(const Document& document, const tinygltf::Node& node) {
  if (node.mesh < 0) return 0;
  const auto& primitives = document.model.meshes[static_cast<std::size_t>(node.mesh)].primitives;
  return primitives.empty() ? 0 : primitives.front().targets.size();
}

RigNode read_node(const Document& document, std::size_t index, Report& report) {
  const tinygltf::Node& from = document.model.nodes[index];
  RigNode made;
  made.translation = vec3(from.translation, made.translation);
  made.scale = vec3(from.scale, made.scale);
  if (from.rotation.size() == 4) {
    const glm::quat turned(static_cast<float>(from.rotation[3]), static_cast<float>(from.rotation[0]),
                           static_cast<float>(from.rotation[1]), static_cast<float>(from.rotation[2]));
    const float square = glm::dot(turned, turned);
    if (square > 0.0f)
      made.rotation = glm::normalize(turned);
    else
      report.invalid(path("nodes", index, "/rotation"), "a unit quaternion", "length 0");
  }
  if (from.matrix.size() == 16) {
    made.fixed = true;
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        made.matrix[column][row] =
            static_cast<float>(from.matrix[static_cast<std::size_t>(4 * column + row)]);
  }
  const std::size_t targets = target_count(document, from);
  const std::vector<double>* weights = &from.weights;
  std::string at = path("nodes", index, "/weights");
  if (weights->empty() && from.mesh >= 0) {
    weights = &document.model.meshes[static_cast<std::size_t>(from.mesh)].weights;
    at = path("meshes", static_cast<std::size_t>(from.mesh), "/weights");
  }
  if (!weights->empty() && weights->size() != targets)
    report.invalid(at, std::to_string(targets) + " weights, one for each morph target",
                   std::to_string(weights->size()));
  made.weights.assign(weights->begin(), weights->end());
  made.weights.resize(targets, 0.0f);
  return made;
}

/// Checks one sampler of an animation and copies it; false after a problem.
bool read_sampler(const Document& document, const tinygltf::AnimationSampler& from, const std::string& at,
                  RigChannel& channel, Report& report) {
  const auto input = read_numbers(document, from.input, report);
  const auto output = read_numbers(document, from.output, report);
  if (!input || !output) return false;
  const std::string word = from.interpolation.empty() ? "LINEAR" : from.interpolation;
  if (word != "LINEAR" && word != "STEP" && word != "CUBICSPLINE") {
    report.invalid(at + "/interpolation", "LINEAR, STEP or CUBICSPLINE", "'" + word + "'");
    return false;
  }
  channel.curve = word == "STEP"          ? RigCurve::step
                  : word == "CUBICSPLINE" ? RigCurve::cubic
                                          : RigCurve::linear;
  const auto& times = input->values;
  if (input->components != 1 || times.front() < 0.0f ||
      std::adjacent_find(times.begin(), times.end(), [](float a, float b) { return a >= b; }) !=
          times.end()) {
    report.invalid(at + "/input", "times from 0 on, each later than the one before", "others");
    return false;
  }
  const int width = channel.path == RigPath::weights ? 1 : static_cast<int>(channel.width);
  const std::size_t wanted = times.size() * channel.width * (channel.curve == RigCurve::cubic ? 3 : 1);
  if (output->components != width || output->values.size() != wanted) {
    report.invalid(at + "/output",
                   std::to_string(wanted / static_cast<std::size_t>(width)) + " elements of " +
                       std::to_string(width),
                   std::to_string(output->count) + " of " + std::to_string(output->components));
    return false;
  }
  channel.times = times;
  channel.values = output->values;
  return true;
}

/// A scale that passes through zero turns a mesh inside out, which triangles cannot follow.
bool changes_sign(const RigChannel& channel) {
  const std::size_t block = channel.curve == RigCurve::cubic ? 9 : 3;
  const std::size_t first = channel.curve == RigCurve::cubic ? 3 : 0;
  bool positive = false;
  bool negative = false;
  for (std::size_t key = 0; key < channel.times.size(); ++key) {
    const float* v = channel.values.data() + key * block + first;
    (v[0] * v[1] * v[2] < 0.0f ? negative : positive) = true;
  }
  return positive && negative;
}

const tinygltf::Animation* find_animation(const Document& document, const std::string& name,
                                          std::size_t& index, Report& report) {
  const auto& all = document.model.animations;
  if (name.empty()) return all.empty() ? nullptr : &all.front();
  std::vector<std::string> names;
  for (index = 0; index < all.size(); ++index) {
    if (all[index].name == name) return &all[index];
    names.push_back(all[index].name);
  }
  const std::string near = model::nearest(name, names);
  report.invalid("/animations", "an animation called '" + name + "'",
                 names.empty() ? "none at all"
                               : std::to_string(names.size()) + " others" +
                                     (near.empty() ? "" : ", such as '" + near + "'"));
  return nullptr;
}

/// Every node's parent, or a problem where a node has two.
bool find_parents(const Document& document, Rig& rig, Report& report) {
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
    const auto& children = document.model.nodes[i].children;
    for (std::size_t k = 0; k < children.size(); ++k) {
      RigNode& child = rig.nodes[static_cast<std::size_t>(children[k])];
      if (child.parent >= 0) {
        report.invalid(path("nodes", i, "/children/") + std::to_string(k), "a node without another parent",
                       "node " + std::to_string(children[k]) + ", a child of node " +
                           std::to_string(child.parent));
        return false;
      }
      child.parent = static_cast<int>(i);
    }
  }
  return true;
}

} // namespace

void read_nodes(const Document& document, Rig& rig, Report& report) {
  const std::size_t count = document.model.nodes.size();
  for (std::size_t i = 0; i < count; ++i) rig.nodes.push_back(read_node(document, i, report));
  if (!find_parents(document, rig, report)) return;
  for (std::size_t i = 0; i < count; ++i)
    if (rig.nodes[i].parent < 0) rig.order.push_back(i);
  for (std::size_t done = 0; done < rig.order.size(); ++done)
    for (const int child : document.model.nodes[rig.order[done]].children)
      rig.order.push_back(static_cast<std::size_t>(child));
  if (rig.order.size() == count) return;
  std::vector<bool> reached(count, false); // what no root leads to hangs on a cycle
  for (const std::size_t index : rig.order) reached[index] = true;
  std::size_t on_cycle =
      static_cast<std::size_t>(std::find(reached.begin(), reached.end(), false) - reached.begin());
  for (std::size_t step = 0; step < count; ++step)
    on_cycle = static_cast<std::size_t>(rig.nodes[on_cycle].parent);
  report.invalid(path("nodes", on_cycle, "/children"), "a tree of nodes", "a node among its own descendants");
}

void read_skins(const Document& document, Rig& rig, Report& report) {
  for (std::size_t i = 0; i < document.model.skins.size(); ++i) {
    const tinygltf::Skin& from = document.model.skins[i];
    RigSkin made;
    made.joints.assign(from.joints.begin(), from.joints.end());
    if (made.joints.empty()) {
      report.invalid(path("skins", i, "/joints"), "at least one joint", "none");
      continue;
    }
    made.inverse_bind.resize(made.joints.size(), glm::mat4(1.0f));
    if (from.inverseBindMatrices >= 0) {
      const auto matrices = read_numbers(document, from.inverseBindMatrices, report);
      if (!matrices) continue;
      if (matrices->components != 16 || matrices->count < made.joints.size() ||
          document.model.accessors[static_cast<std::size_t>(from.inverseBindMatrices)].type !=
              TINYGLTF_TYPE_MAT4) {
        report.invalid(path("skins", i, "/inverseBindMatrices"),
                       std::to_string(made.joints.size()) + " matrices (MAT4), one for each joint",
                       std::to_string(matrices->count) + " elements of " +
                           std::to_string(matrices->components));
        continue;
      }
      for (std::size_t k = 0; k < made.joints.size(); ++k)
        for (int column = 0; column < 4; ++column)
          for (int row = 0; row < 4; ++row)
            made.inverse_bind[k][column][row] =
                matrices->values[16 * k + static_cast<std::size_t>(4 * column + row)];
    }
    rig.skins.push_back(std::move(made));
  }
}

void read_animation(const Document& document, const std::string& name, Rig& rig, Report& report) {
  std::size_t index = 0;
  const tinygltf::Animation* animation = find_animation(document, name, index, report);
  if (animation == nullptr) return;
  for (std::size_t i = 0; i < animation->channels.size(); ++i) {
    const tinygltf::AnimationChannel& from = animation->channels[i];
    const std::string at = path("animations", index, "/channels/") + std::to_string(i);
    if (from.target_node < 0) continue; // glTF: ignored
    RigChannel made;
    made.node = static_cast<std::size_t>(from.target_node);
    if (from.target_path == "translation" || from.target_path == "scale") {
      made.path = from.target_path == "scale" ? RigPath::scale : RigPath::translation;
    } else if (from.target_path == "rotation") {
      made.path = RigPath::rotation;
      made.width = 4;
    } else if (from.target_path == "weights") {
      made.path = RigPath::weights;
      made.width = rig.nodes[made.node].weights.size();
    } else {
      report.warning(at + "/target/path", "translation, rotation, scale or weights",
                     "'" + from.target_path + "'", "It does not move.");
      continue;
    }
    if (made.path != RigPath::weights && rig.nodes[made.node].fixed) {
      report.invalid(at + "/target/node", "a node without a matrix", "node " + std::to_string(made.node));
      continue;
    }
    if (from.sampler < 0 || static_cast<std::size_t>(from.sampler) >= animation->samplers.size()) {
      report.invalid(at + "/sampler", "an index below " + std::to_string(animation->samplers.size()),
                     std::to_string(from.sampler));
      continue;
    }
    if (made.width == 0) {
      report.invalid(at + "/target/node", "a node whose mesh has morph targets",
                     "node " + std::to_string(made.node));
      continue;
    }
    const std::string sampler_at = path("animations", index, "/samplers/") + std::to_string(from.sampler);
    if (!read_sampler(document, animation->samplers[static_cast<std::size_t>(from.sampler)], sampler_at, made,
                      report))
      continue;
    if (made.path == RigPath::scale && changes_sign(made))
      report.warning(at, "a scale that keeps its sign", "one that turns what it scales inside out",
                     "Fronts and backs are those of the beginning.");
    rig.channels.push_back(std::move(made));
  }
}

std::vector<bool> shown_nodes(const Document& document, const Rig& rig, Report& report) {
  std::vector<bool> shown(rig.nodes.size(), document.model.scenes.empty());
  if (document.model.scenes.empty()) return shown;
  const auto scene = static_cast<std::size_t>(std::max(document.model.defaultScene, 0));
  for (std::size_t i = 0; i < document.model.scenes[scene].nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(document.model.scenes[scene].nodes[i]);
    if (rig.nodes[node].parent >= 0)
      report.invalid(path("scenes", scene, "/nodes/") + std::to_string(i), "a node without a parent",
                     "node " + std::to_string(node));
    shown[node] = true;
  }
  for (const std::size_t index : rig.order) {
    const int parent = rig.nodes[index].parent;
    if (parent >= 0 && shown[static_cast<std::size_t>(parent)]) shown[index] = true;
  }
  return shown;
}

std::vector<bool> moving_nodes(const Rig& rig) {
  std::vector<bool> moves(rig.nodes.size(), false);
  for (const RigChannel& channel : rig.channels)
    if (channel.path != RigPath::weights && channel.times.size() > 1) moves[channel.node] = true;
  for (const std::size_t index : rig.order) {
    const int parent = rig.nodes[index].parent;
    if (parent >= 0 && moves[static_cast<std::size_t>(parent)]) moves[index] = true;
  }
  return moves;
}

} // namespace cupola::content::gltf
