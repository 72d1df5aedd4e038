#include "renderer/content/clusters.h"

#include <doctest/doctest.h>

#include "renderer/content/random.h"
#include "tests/renderer/content/scene_checks.h"

using namespace cupola::content;

namespace {

/// `count` small triangles, scattered over a square kilometre.
std::vector<std::uint32_t> scatter(Geometry& geometry, std::size_t count, Random& random) {
  std::vector<std::uint32_t> list;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 corner(random.between(0, 1000), random.between(0, 20), random.between(0, 1000));
    for (const glm::vec3& offset : {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 0, -1)}) {
      list.push_back(static_cast<std::uint32_t>(geometry.vertices.size()));
      Vertex vertex;
      vertex.position = corner + offset;
      vertex.normal = {0, 1, 0};
      geometry.vertices.push_back(vertex);
    }
  }
  return list;
}

} // namespace

TEST_CASE("clusters are sorted by alpha mode and material, compact, and cover everything") {
  Scene scene;
  scene.materials.resize(4);
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[2].alpha_mode = AlphaMode::mask;
  Random random{3};
  std::vector<std::vector<std::uint32_t>> triangles(4);
  for (const std::size_t m : {0U, 1U, 3U}) triangles[m] = scatter(scene.geometry, 20'000 + 7 * m, random);
  triangles[2] = scatter(scene.geometry, 1, random);
  make_clusters(scene.geometry, triangles, scene.materials);
  check_geometry(scene);
  std::vector<std::uint32_t> order;
  for (const Cluster& cluster : scene.geometry.clusters)
    if (order.empty() || order.back() != cluster.material) order.push_back(cluster.material);
  CHECK(order == std::vector<std::uint32_t>{1, 3, 2, 0});
  CHECK(scene.geometry.indices.size() == 3 * (60'000 + 28 + 1));
  // 256 of 20,000 triangles on a square kilometre fill a square of 113 m, when the split is fair
  for (const Cluster& cluster : scene.geometry.clusters) CHECK(cluster.radius < 160.0f);
}

TEST_CASE("no triangles make no clusters") {
  Scene scene;
  scene.materials.resize(1);
  std::vector<std::vector<std::uint32_t>> none(1);
  make_clusters(scene.geometry, none, scene.materials);
  set_scene_bounds(scene);
  CHECK(scene.geometry.clusters.empty());
  CHECK(scene.bounds_max == glm::vec3(0.0f));
}

TEST_CASE("all triangles at one place are split all the same") {
  Scene scene;
  scene.materials.resize(1);
  scene.geometry.vertices.resize(3);
  for (Vertex& vertex : scene.geometry.vertices) vertex.normal = {0, 1, 0};
  std::vector<std::vector<std::uint32_t>> triangles(1);
  for (int i = 0; i < 1000; ++i) triangles[0].insert(triangles[0].end(), {0, 1, 2});
  make_clusters(scene.geometry, triangles, scene.materials);
  check_geometry(scene);
}
