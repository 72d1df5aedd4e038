// Animation through whole files: values worked out by hand.
#include "renderer/content/rig.h"

#include <doctest/doctest.h>

#include "tests/renderer/content/gltf_file.h"
#include "tests/renderer/content/scene_checks.h"

using namespace cupola;
using namespace cupola::content;

namespace {

const std::vector<float> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

struct Moving {
  GltfFile file;
  int node = 0;
  Moving() { node = file.show({{"attributes", {{"POSITION", file.floats(triangle, "VEC3")}}}}); }
  void animate(const char* path, const std::vector<float>& times, const std::vector<float>& values,
               const char* type, const char* interpolation = nullptr) {
    Json sampler{{"input", file.floats(times, "SCALAR")}, {"output", file.floats(values, type)}};
    if (interpolation) sampler["interpolation"] = interpolation;
    file.add("animations", {{"name", path},
                            {"samplers", {sampler}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
  }
};

std::shared_ptr<const Scene> good(const model::Result<LoadedScene>& loaded) {
  if (!loaded)
    for (const model::Problem& problem : loaded.error()) MESSAGE(to_text(problem));
  REQUIRE(loaded);
  check_geometry(*loaded->scene);
  return loaded->scene;
}

/// A vertex at a time; clusters have to hold everything then.
Vertex at(const Scene& scene, double time, std::size_t vertex) {
  Pose posed;
  pose(scene, time, glm::vec3(0.0f), posed);
  REQUIRE(posed.vertices.size() == scene.geometry.vertices.size() - scene.static_vertices);
  REQUIRE(posed.clusters.size() == scene.geometry.clusters.size());
  for (const Cluster& cluster : posed.clusters) {
    for (std::uint32_t k = 0; k < cluster.index_count; ++k) {
      const std::uint32_t index = scene.geometry.indices[cluster.first_index + k];
      const glm::vec3& p = index < scene.static_vertices
                               ? scene.geometry.vertices[index].position
                               : posed.vertices[index - scene.static_vertices].position;
      REQUIRE(glm::distance(p, cluster.center) <= cluster.radius * 1.000001f);
    }
  }
  return posed.vertices.at(vertex);
}

void check_point(const glm::vec3& found, const glm::vec3& expected) {
  CHECK(found.x == doctest::Approx(expected.x).epsilon(1e-5));
  CHECK(found.y == doctest::Approx(expected.y).epsilon(1e-5));
  CHECK(found.z == doctest::Approx(expected.z).epsilon(1e-5));
}

} // namespace

TEST_CASE("linear translation: between keys, before the first, after one round") {
  Moving m;
  m.animate("translation", {1, 2, 4}, {0, 0, 0, 10, 0, 0, 10, 8, 0}, "VEC3");
  const auto scene = good(load(m.file));
  CHECK(scene->duration == doctest::Approx(4.0));
  CHECK(scene->static_vertices == 0);
  check_point(at(*scene, 0.5, 0).position, {0, 0, 0});
  check_point(at(*scene, 1.25, 0).position, {2.5, 0, 0});
  check_point(at(*scene, 3.0, 0).position, {10, 4, 0});
  check_point(at(*scene, 4.0 + 1.25, 0).position, {2.5, 0, 0});
  check_point(at(*scene, -1.0, 1).position, {11, 4, 0}); // three seconds into the round before
}

TEST_CASE("step holds, and cubic splines follow Hermite's formula") {
  Moving step;
  step.animate("translation", {0, 1, 2}, {0, 0, 0, 5, 0, 0, 7, 0, 0}, "VEC3", "STEP");
  const auto stepping = good(load(step.file));
  check_point(at(*stepping, 0.99, 0).position, {0, 0, 0});
  check_point(at(*stepping, 1.0, 0).position, {5, 0, 0});
  check_point(at(*stepping, 1.99, 0).position, {5, 0, 0});

  // keys at 0 s and 2 s: from 1 with slope 3 to 5 with slope -1; at a quarter of the way:
  // h00 27/32 · 1 + h10 9/64 · 2 · 3 + h01 5/32 · 5 + h11 -3/64 · 2 · -1 = 2.5625
  Moving cubic;
  cubic.animate("translation", {0, 2}, {0, 0, 0, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 0, 0, 0, 0}, "VEC3",
                "CUBICSPLINE");
  const auto curved = good(load(cubic.file));
  check_point(at(*curved, 0.5, 0).position, {2.5625, 0, 0});
}

TEST_CASE("rotations take the short way round at even speed") {
  const float h = 0.70710678f;
  Moving m;
  m.animate("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h}, "VEC4"); // a quarter turn about z, sign reversed
  const auto scene = good(load(m.file));
  const double third = 30.0 * 3.14159265358979 / 180.0;
  check_point(at(*scene, 1.0 / 3.0, 1).position, glm::vec3(std::cos(third), std::sin(third), 0));
  CHECK(at(*scene, 0.4, 0).normal.z == doctest::Approx(1.0));
}

TEST_CASE("scale moves bounds and normals") {
  Moving m;
  m.animate("scale", {0, 1}, {1, 1, 1, 3, 5, 1}, "VEC3");
  const auto scene = good(load(m.file));
  check_point(at(*scene, 0.5, 2).position, {0, 3, 0});
  CHECK(at(*scene, 0.5, 2).normal.z == doctest::Approx(1.0));
}

TEST_CASE("the animation is chosen by name; an unknown name is a problem") {
  Moving m;
  m.animate("translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
  m.animate("scale", {0, 3}, {1, 1, 1, 2, 2, 2}, "VEC3");
  CHECK(good(load(m.file))->duration == doctest::Approx(1.0));
  CHECK(good(load(m.file, "scale"))->duration == doctest::Approx(3.0));
  const auto refused = load(m.file, "scal");
  REQUIRE_FALSE(refused);
  CHECK(refused.error()[0].pointer == "/animations");
  CHECK(refused.error()[0].found.find("'scale'") != std::string::npos);
}

TEST_CASE("what does not move stays out of the pose") {
  Moving m;
  m.file.show(
      {{"attributes",
        {{"POSITION", m.file.floats({5, 0, 0, 6, 0, 0, 5, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 1}, "VEC3")}}}});
  m.animate("translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
  const auto scene = good(load(m.file));
  CHECK(scene->static_vertices == 6);
  CHECK(scene->geometry.vertices.size() == 9);
  check_point(at(*scene, 0.5, 0).position, {0.5, 0, 0});
}

TEST_CASE("a child moves with its animated parent, lights too") {
  Moving m;
  const int arm = m.file.add("nodes", {{"children", {m.node}}});
  m.file.json["scenes"][0]["nodes"] = {arm};
  m.file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  m.file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  m.file.json["nodes"][m.node]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  m.file.json["nodes"][m.node]["translation"] = {0, 2, 0};
  m.node = arm;
  m.animate("translation", {0, 1}, {0, 0, 0, 4, 0, 0}, "VEC3");
  const auto scene = good(load(m.file));
  check_point(at(*scene, 0.75, 0).position, {3, 2, 0});
  Pose posed;
  pose(*scene, 0.75, glm::vec3(0.0f), posed);
  REQUIRE(posed.lights.size() == 1);
  check_point(posed.lights[0].position, {3, 2, 0});
  check_point(scene->lights[0].position, {0, 2, 0});
}

TEST_CASE("skins blend their joints, and ignore the mesh's own node") {
  GltfFile file;
  const Json attributes{{"POSITION", file.floats({0, 0, 0, 0, 1, 0, 1, 2, 0}, "VEC3")},
                        {"NORMAL", file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
                        {"JOINTS_0", file.bytes({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4")},
                        {"WEIGHTS_0", file.floats({1, 0, 0, 0, 2, 2, 0, 0, 0, 1, 0, 0}, "VEC4")}};
  const int mesh_node = file.show({{"attributes", attributes}}, {{"translation", {100, 0, 0}}});
  const int root = file.add("nodes", Json::object());
  const int tip = file.add("nodes", {{"translation", {0, 1, 0}}});
  file.json["nodes"][root]["children"] = {tip};
  file.json["scenes"][0]["nodes"].push_back(root);
  std::vector<float> inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  file.add("skins", {{"joints", {root, tip}}, {"inverseBindMatrices", file.floats(inverse, "MAT4")}});
  file.json["nodes"][mesh_node]["skin"] = 0;
  const float h = 0.70710678f;
  const Json sampler{{"input", file.floats({0, 1}, "SCALAR")},
                     {"output", file.floats({0, 0, 0, 1, 0, 0, h, h}, "VEC4")},
                     {"interpolation", "STEP"}};
  file.add("animations",
           {{"samplers", {sampler}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", tip}, {"path", "rotation"}}}}}}});
  const auto scene = good(load(file));
  check_point(at(*scene, 0.0, 2).position, {1, 2, 0}); // bound as drawn: not moved by 100
  const auto still = at(*scene, 0.5, 2).position;
  check_point(still, {1, 2, 0});
  Rig bent = *scene->rig; // the end of the round itself, which pose() wraps to its start
  const RigState state = rig_state(bent, 1.0);
  std::vector<Vertex> vertices(3);
  place_part(bent, state, bent.parts.at(0), glm::vec3(0.0f), vertices.data());
  check_point(vertices[0].position, {0, 0, 0});
  check_point(vertices[1].position, {0, 1, 0});  // at the joint: weights 2 and 2 count as halves
  check_point(vertices[2].position, {-1, 2, 0}); // (1, 1) against the tip, turned by a quarter
}

TEST_CASE("morph targets, sparse ones too: weights of the mesh, the node and over time") {
  GltfFile file;
  const std::vector<std::uint16_t> where{2};
  const std::vector<float> what{0, 4, 0};
  const int sparse = file.add(
      "accessors", {{"componentType", 5126},
                    {"count", 3},
                    {"type", "VEC3"},
                    {"sparse",
                     {{"count", 1},
                      {"indices", {{"bufferView", file.view(where.data(), 2)}, {"componentType", 5123}}},
                      {"values", {{"bufferView", file.view(what.data(), 12)}}}}}});
  const int shift = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int node = file.show({{"attributes", {{"POSITION", file.floats(triangle, "VEC3")}}},
                              {"targets", {{{"POSITION", sparse}}, {{"POSITION", shift}}}}});
  file.json["meshes"][0]["weights"] = {0.5, 0};
  check_point(good(load(file))->geometry.vertices[2].position, {0, 3, 0});
  file.json["nodes"][node]["weights"] = {0.25, 2};
  check_point(good(load(file))->geometry.vertices[2].position, {0, 2, 2});
  const Json sampler{{"input", file.floats({0, 2}, "SCALAR")},
                     {"output", file.floats({0, 0, 1, 3}, "SCALAR")}};
  file.add("animations",
           {{"samplers", {sampler}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}}}}});
  const auto scene = good(load(file));
  check_point(at(*scene, 1.0, 2).position, {0, 3, 1.5});
  check_point(at(*scene, 0.0, 2).position, {0, 1, 0});
  CHECK(at(*scene, 1.0, 2).normal.z == doctest::Approx(1.0)); // computed anew
}
