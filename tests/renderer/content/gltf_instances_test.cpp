// EXT_mesh_gpu_instancing: one mesh at many places of a node.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "renderer/content/rig.h"
#include "tests/renderer/content/gltf_file.h"

using namespace cupola;
using namespace cupola::content;

namespace {

constexpr const char* name = "EXT_mesh_gpu_instancing";
const std::vector<float> corner{0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<float> places{0, 0, 0, 5, 0, 0, 0, 7, 0};
const std::vector<float> turns{0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f, 0, 0, 0, 1};
const std::vector<float> sizes{1, 1, 1, 2, 2, 2, -1, 1, 1};

/// A triangle of a node at x = 10, drawn at three places of it.
struct Instanced {
  GltfFile file;
  int node = 0;
  Json& attributes() {
    return file.json["nodes"][static_cast<std::size_t>(node)]["extensions"][name]["attributes"];
  }

  Instanced() {
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {name};
    node = file.show({{"attributes", {{"POSITION", file.floats(corner, "VEC3")}}}},
                     {{"translation", {10, 0, 0}}});
    attributes() = {{"TRANSLATION", file.floats(places, "VEC3")},
                    {"ROTATION", file.floats(turns, "VEC4")},
                    {"SCALE", file.floats(sizes, "VEC3")}};
  }
};

std::vector<glm::vec3> corners_of(const Scene& scene) {
  std::vector<glm::vec3> out;
  for (const std::uint32_t index : scene.geometry.indices)
    out.push_back(scene.geometry.vertices[index].position);
  std::sort(out.begin(), out.end(), [](const glm::vec3& a, const glm::vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  });
  return out;
}

const model::Problem& only_problem(const model::Result<LoadedScene>& loaded) {
  REQUIRE(!loaded);
  REQUIRE(loaded.error().size() == 1);
  return loaded.error().front();
}

} // namespace

TEST_CASE("instances stand where nodes of their own would") {
  Instanced instanced;
  GltfFile apart;
  const int position = apart.floats(corner, "VEC3");
  const int mesh = apart.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", position}}}}}}});
  for (std::size_t i = 0; i < 3; ++i) {
    const float* t = places.data() + 3 * i;
    const float* r = turns.data() + 4 * i;
    const float* s = sizes.data() + 3 * i;
    const int node = apart.add("nodes", {{"mesh", mesh},
                                         {"translation", {10 + t[0], t[1], t[2]}},
                                         {"rotation", {r[0], r[1], r[2], r[3]}},
                                         {"scale", {s[0], s[1], s[2]}}});
    apart.json["scenes"][0]["nodes"].push_back(node);
  }
  const auto a = load(instanced.file), b = load(apart);
  REQUIRE(a);
  REQUIRE(b);
  CHECK(a->warnings.empty());
  const std::vector<glm::vec3> left = corners_of(*a->scene), right = corners_of(*b->scene);
  REQUIRE(left.size() == 9);
  REQUIRE(right.size() == 9);
  for (std::size_t i = 0; i < 9; ++i) CHECK(glm::distance(left[i], right[i]) < 1e-5f);
  CHECK(a->scene->duration == 0.0);
}

TEST_CASE("instances follow their node when it moves") {
  Instanced instanced;
  GltfFile& file = instanced.file;
  const int times = file.floats({0, 1}, "SCALAR");
  const int values = file.floats({10, 0, 0, 10, 4, 0}, "VEC3");
  file.add(
      "animations",
      {{"samplers", {{{"input", times}, {"output", values}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", instanced.node}, {"path", "translation"}}}}}}});
  const auto loaded = load(file);
  REQUIRE(loaded);
  const Scene& scene = *loaded->scene;
  CHECK(scene.static_vertices == 0);
  REQUIRE(scene.rig);
  CHECK(scene.rig->parts.size() == 3);
  Pose moved_to;
  pose(scene, 1.0 - 1e-7, glm::vec3(0.0f), moved_to); // at the end it begins anew
  REQUIRE(moved_to.vertices.size() == 9);
  for (std::size_t i = 0; i < 9; ++i) {
    const glm::vec3 moved = moved_to.vertices[i].position - scene.geometry.vertices[i].position;
    CHECK(glm::distance(moved, glm::vec3(0, 4, 0)) < 1e-5f);
  }
}

TEST_CASE("what contradicts itself about instances is a problem at its own place") {
  const std::string at = std::string("/nodes/0/extensions/") + name + "/attributes";
  Instanced few;
  few.attributes()["SCALE"] = few.file.floats({1, 1, 1}, "VEC3");
  CHECK(only_problem(load(few.file)).pointer.ends_with(at + "/SCALE"));
  Instanced flat;
  flat.attributes()["ROTATION"] = flat.attributes()["SCALE"];
  CHECK(only_problem(load(flat.file)).pointer.ends_with(at + "/ROTATION"));
  Instanced none;
  none.attributes() = Json::object();
  CHECK(only_problem(load(none.file)).pointer.ends_with(at));
  Instanced still;
  still.attributes()["ROTATION"] = still.file.floats(std::vector<float>(12, 0.0f), "VEC4");
  CHECK_FALSE(load(still.file));
  Instanced beyond;
  beyond.attributes()["SCALE"] = 99;
  CHECK(only_problem(load(beyond.file)).pointer.ends_with(at + "/SCALE"));
  Instanced lost;
  lost.file.json["nodes"][0]["extensions"][name].erase("attributes");
  CHECK(only_problem(load(lost.file)).pointer.ends_with(at));
}

TEST_CASE("a small file cannot ask for many instances") {
  Instanced many; // 12 nodes at 99,999 places each
  Json& accessors = many.file.json["accessors"];
  accessors.push_back({{"componentType", 5126}, {"count", 99'999}, {"type", "VEC3"}});
  many.attributes() = {{"TRANSLATION", accessors.size() - 1}};
  for (int i = 1; i < 12; ++i) many.file.add("nodes", many.file.json["nodes"][0]);
  CHECK(only_problem(load(many.file)).code == model::Code::scene_limit);
}
