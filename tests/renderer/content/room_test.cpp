#include "renderer/content/room.h"

#include <doctest/doctest.h>

#include "renderer/content/mipmap.h"
#include "renderer/content/random.h"
#include "tests/renderer/content/scene_checks.h"

using namespace cupola;
using namespace cupola::content;

namespace {

/// The wall that a ray from the middle meets.
std::string wall_towards(const Scene& scene, const glm::dvec3& ray) {
  const Hit hit = look(scene, glm::dvec3(0.01, 0.02, 0.03), ray);
  REQUIRE(hit.front);
  return scene.materials[hit.material].name;
}

/// Texture coordinates of the room's wall at a point.
glm::vec2 uv_at(const Scene& scene, std::uint32_t material, const glm::vec3& point) {
  for (const Cluster& cluster : scene.geometry.clusters) {
    if (cluster.material != material) continue;
    for (std::uint32_t k = 0; k < cluster.index_count; k += 3) {
      const auto corner = [&](std::uint32_t c) {
        return scene.geometry.vertices[scene.geometry.indices[cluster.first_index + k + c]];
      };
      const Vertex a = corner(0), b = corner(1), c = corner(2);
      const glm::vec3 n = glm::cross(b.position - a.position, c.position - a.position);
      const float area = glm::dot(n, n);
      const float u = glm::dot(glm::cross(c.position - b.position, point - b.position), n) / area;
      const float v = glm::dot(glm::cross(a.position - c.position, point - c.position), n) / area;
      if (u >= -1e-4f && v >= -1e-4f && u + v <= 1.0001f) return a.uv * u + b.uv * v + c.uv * (1.0f - u - v);
    }
  }
  FAIL("the point is on no triangle");
  return {};
}

} // namespace

TEST_CASE("the room's walls stand where their names say") {
  const Scene scene = make_room({});
  check_geometry(scene);
  CHECK(wall_towards(scene, {1, 0, 0}) == "+X");
  CHECK(wall_towards(scene, {-1, 0, 0}) == "-X");
  CHECK(wall_towards(scene, {0, 1, 0}) == "+Y");
  CHECK(wall_towards(scene, {0, -1, 0}) == "-Y");
  CHECK(wall_towards(scene, {0, 0, 1}) == "+Z");
  CHECK(wall_towards(scene, {0, 0, -1}) == "-Z");
  CHECK(scene.bounds_max == glm::vec3(5.0f));
  CHECK(scene.bounds_min == glm::vec3(-5.0f));
  for (const Material& material : scene.materials) CHECK(material.unlit);
}

TEST_CASE("the room is closed, seen from anywhere inside") {
  model::Room wish;
  wish.size = 4.0;
  const Scene scene = make_room(wish);
  Random random{5};
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 eye(random.between(-1.9, 1.9), random.between(-1.9, 1.9), random.between(-1.9, 1.9));
    const glm::dvec3 ray(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    const Hit hit = look(scene, eye, glm::normalize(ray));
    REQUIRE(std::isfinite(hit.distance));
    REQUIRE(hit.front);
  }
}

TEST_CASE("the letters are upright and not mirrored") {
  const Scene scene = make_room({});
  struct Expectation {
    std::uint32_t wall;
    glm::vec3 forward, right, up; ///< of a viewer for whom the wall reads upright
  };
  const Expectation all[] = {
      {0, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {1, {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
      {2, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {3, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
      {4, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {5, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
  };
  for (const Expectation& e : all) {
    CAPTURE(e.wall);
    CHECK(glm::cross(e.forward, e.up) == e.right);
    const glm::vec2 top_left = uv_at(scene, e.wall, (e.forward - e.right * 0.99f + e.up * 0.99f) * 5.0f);
    const glm::vec2 bottom_right = uv_at(scene, e.wall, (e.forward + e.right * 0.99f - e.up * 0.99f) * 5.0f);
    CHECK(top_left.x == doctest::Approx(0.005).epsilon(0.01));
    CHECK(top_left.y == doctest::Approx(0.005).epsilon(0.01));
    CHECK(bottom_right.x == doctest::Approx(0.995).epsilon(0.001));
    CHECK(bottom_right.y == doctest::Approx(0.995).epsilon(0.001));
  }
}

TEST_CASE("a wall's picture: its colour exactly, and an F in the lower left corner") {
  const Scene scene = make_room({});
  for (std::size_t w = 0; w < 6; ++w) {
    const Image& image = scene.images[w];
    const auto texel = [&](float u, float v) {
      const auto x = static_cast<std::size_t>(u * static_cast<float>(image.width));
      const auto y = static_cast<std::size_t>(v * static_cast<float>(image.height));
      const std::uint8_t* t = image.rgba.data() + (y * static_cast<std::size_t>(image.width) + x) * 4;
      return std::array<std::uint8_t, 3>{t[0], t[1], t[2]};
    };
    const std::array<std::uint8_t, 3> white{255, 255, 255};
    CHECK(texel(0.05f, 0.05f) == room_walls()[w].color);
    CHECK(texel(0.95f, 0.95f) == room_walls()[w].color);
    // the F: stem at the left, arms at the top and in the middle, nothing at the lower right
    CHECK(texel(4.7f / 64, 60.0f / 64) == white);
    CHECK(texel(11.0f / 64, 50.7f / 64) == white);
    CHECK(texel(9.0f / 64, 55.2f / 64) == white);
    CHECK(texel(11.0f / 64, 60.0f / 64) == room_walls()[w].color);
  }
}
