#include "renderer/content/strokes.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <numbers>
#include <utility>

#include "tests/renderer/content/gltf_file.h"
#include "tests/renderer/content/scene_checks.h"

using namespace cupola;
using namespace cupola::content;

namespace {

constexpr float width = 0.02f; ///< radians

Vertex at(float x, float y, float z, std::uint32_t color = ~0u) {
  return {{x, y, z}, {0.0f, 1.0f, 0.0f}, {x, y}, color};
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

std::vector<Vertex> ribbon(const Vertex& a, const Vertex& b, const glm::vec3& eye) {
  std::vector<Vertex> made(stroke_vertices(Form::lines));
  place_line(a, b, eye, width, made.data());
  return made;
}

/// Triangles that turn their backs to the eye.
int backs(Form form, const std::vector<Vertex>& vertices, const glm::dvec3& eye) {
  const std::vector<std::uint32_t> corners = stroke_corners(form, 1);
  REQUIRE(corners.size() == 3 * stroke_triangles(form));
  int count = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return glm::dvec3(vertices[corners[i + k]].position) - eye; };
    if (!(glm::dot(glm::cross(corner(1) - corner(0), corner(2) - corner(0)), corner(0)) < 0.0)) ++count;
  }
  return count;
}

/// Lines that are ordinary, short, far, seen almost from their ends, and run past the eye.
const std::vector<std::pair<Vertex, Vertex>> lines{{at(-1, 0, -3), at(1, 2, -4)},
                                                   {at(5, 0, 5), at(5, 0.01f, 5)},
                                                   {at(-9000, 4000, 100), at(-9000, 4000, -7000)},
                                                   {at(0.1f, 0, -2), at(0.1f, 0, -500)},
                                                   {at(-50, -1.7f, 2), at(50, -1.7f, 2)}};
const std::vector<glm::vec3> eyes{{0, 0, 0}, {0.5f, 1.5f, 0.25f}, {-20, 3, 40}};

} // namespace

TEST_CASE("a ribbon is as wide as asked for, as seen from the eye, and faces it") {
  for (const auto& [a, b] : lines)
    for (const glm::vec3& eye : eyes) {
      const std::vector<Vertex> made = ribbon(a, b, eye);
      CHECK(backs(Form::lines, made, eye) == 0);
      for (std::size_t i = 0; i <= ribbon_sections; ++i) {
        const glm::dvec3 low = made[2 * i].position - eye, high = made[2 * i + 1].position - eye;
        CHECK(angle(low, high) == doctest::Approx(width).epsilon(0.01));
        if (i == 0) continue;
        const glm::dvec3 low_before = made[2 * i - 2].position - eye;
        const glm::dvec3 high_before = made[2 * i - 1].position - eye;
        for (const double share : {0.25, 0.5, 0.75}) {
          const double wide = angle(glm::mix(low_before, low, share), glm::mix(high_before, high, share));
          CHECK(wide > 0.99 * width);
          CHECK(wide < 1.085 * width);
        }
      }
    }
}

TEST_CASE("a ribbon follows its line, half a width beyond its ends") {
  for (const auto& [a, b] : lines)
    for (const glm::vec3& eye : eyes) {
      const std::vector<Vertex> made = ribbon(a, b, eye);
      for (std::size_t i = 1; i < ribbon_sections; ++i) {
        const glm::dvec3 middle = glm::mix(made[2 * i].position, made[2 * i + 1].position, 0.5f);
        const glm::dvec3 along = glm::normalize(glm::dvec3(b.position - a.position));
        const glm::dvec3 off = middle - glm::dvec3(a.position);
        CHECK(glm::length(off - along * glm::dot(off, along)) < 1e-3 * (1.0 + glm::length(off)));
      }
      const glm::dvec3 first = glm::mix(made[0].position, made[1].position, 0.5f) - eye;
      const glm::dvec3 last = glm::mix(made[8].position, made[9].position, 0.5f) - eye;
      CHECK(angle(first, a.position - eye) == doctest::Approx(0.5 * width).epsilon(0.02));
      CHECK(angle(first, last) ==
            doctest::Approx(angle(a.position - eye, b.position - eye) + width).epsilon(0.01));
    }
}

TEST_CASE("colours and coordinates run evenly along a line") {
  const Vertex a = at(-1, 0, -1, 0xff000000u), b = at(1, 0, -1, 0xff0000ffu);
  const std::vector<Vertex> made = ribbon(a, b, {});
  for (std::size_t i = 0; i <= ribbon_sections; ++i) {
    const float x = std::clamp(made[2 * i].position.x, -1.0f, 1.0f);
    CHECK(made[2 * i].uv.x == doctest::Approx(x).epsilon(0.001));
    CHECK(static_cast<int>(made[2 * i].color & 255) == doctest::Approx(127.5 * (x + 1.0)).epsilon(0.01));
    CHECK((made[2 * i].color >> 24) == 255);
  }
}

TEST_CASE("lines through the eye, from it, and without a length have finite ribbons") {
  for (const auto& [a, b] : {std::pair{at(-1, 0, 0), at(1, 0, 0)},
                             {at(0, 0, 0), at(1, 1, 0)},
                             {at(0, 1, 0), at(0, 0, 0)},
                             {at(0, 0, -1), at(0, 0, -5)},
                             {at(2, 2, 2), at(2, 2, 2)},
                             {at(0, 0, 0), at(0, 0, 0)}})
    for (const Vertex& vertex : ribbon(a, b, {}))
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(std::isfinite(vertex.position[axis]));
        CHECK(std::abs(vertex.position[axis]) < 6.0f);
        CHECK(std::isfinite(vertex.normal[axis]));
      }
}

TEST_CASE("a point is a disc as large as a circle of its size, and faces the eye") {
  for (const Vertex& point : {at(0, 0, -1), at(0, 8, 0), at(0, -8, 0.001f), at(300, 20, -4000)})
    for (const glm::vec3& eye : eyes) {
      std::vector<Vertex> made(stroke_vertices(Form::points));
      place_point(point, eye, width, made.data());
      CHECK(backs(Form::points, made, eye) == 0);
      const double distance = glm::distance(point.position, eye);
      double area = 0.0;
      for (std::size_t i = 0; i < disc_corners; ++i) {
        const glm::dvec3 one = made[i].position - point.position;
        const glm::dvec3 next = made[(i + 1) % disc_corners].position - point.position;
        area += 0.5 * glm::length(glm::cross(one, next));
      }
      CHECK(area / (distance * distance) ==
            doctest::Approx(std::numbers::pi * 0.25 * width * width).epsilon(0.01));
    }
  std::array<Vertex, disc_corners> none{};
  place_point(at(1, 2, 3), {1, 2, 3}, width, none.data());
  for (const Vertex& vertex : none) CHECK(vertex.position == glm::vec3(1, 2, 3));
}

TEST_CASE("every mode of points and lines has its strokes") {
  // Mode, and the points or lines that it makes of four corners.
  const std::vector<std::array<std::size_t, 2>> expected{{0, 4}, {1, 2}, {2, 4}, {3, 3}};
  for (const auto& pair : expected)
    for (const bool indexed : {false, true}) {
      const std::size_t mode = pair[0], count = pair[1];
      CAPTURE(mode);
      GltfFile file;
      Json primitive{
          {"attributes", {{"POSITION", file.floats({0, 0, -9, 1, 0, -9, 1, 1, -9, 0, 1, -9}, "VEC3")}}},
          {"mode", mode}};
      if (indexed) primitive["indices"] = file.shorts({3, 2, 1, 0}, "SCALAR");
      file.show(primitive);
      const auto loaded = load(file);
      REQUIRE(loaded);
      CHECK(loaded->warnings.empty());
      const Scene& scene = *loaded->scene;
      check_geometry(scene);
      const Form form = mode == 0 ? Form::points : Form::lines;
      CHECK(scene.geometry.indices.size() == 3 * count * stroke_triangles(form));
      CHECK(scene.geometry.vertices.size() == count * stroke_vertices(form));
      CHECK(scene.static_vertices == 0);
      CHECK(scene.rig != nullptr);
      CHECK(scene.duration == 0.0);
    }
}

TEST_CASE("points and lines without normals shine as they are, others are lit; neither has a back") {
  GltfFile file;
  const int position = file.floats({0, 0, -9, 1, 0, -9}, "VEC3");
  const int normal = file.floats({0, 0, 1, 0, 0, 1}, "VEC3");
  file.add("materials", {{"emissiveFactor", {0.5, 0, 0}}, {"normalTexture", {{"index", 0}}}});
  file.json["textures"] = Json::array({{{"source", 0}}});
  file.json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(png({128, 128, 255}))}}});
  file.show({{"attributes", {{"POSITION", position}}}, {"mode", 1}, {"material", 0}});
  file.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"mode", 0}, {"material", 0}});
  file.show({{"attributes", {{"POSITION", position}}}, {"mode", 0}, {"material", 0}});
  const auto loaded = load(file);
  REQUIRE(loaded);
  const Scene& scene = *loaded->scene;
  REQUIRE(scene.materials.size() == 4); // the file's, glTF's default, and a variant of each kind
  CHECK(scene.materials[2].unlit);
  CHECK(!scene.materials[3].unlit);
  for (const std::size_t variant : {2U, 3U}) {
    CHECK(scene.materials[variant].double_sided);
    CHECK(scene.materials[variant].normal_map.texture == -1);
    CHECK(scene.materials[variant].emissive.r == 0.5f);
  }
  for (const Cluster& cluster : scene.geometry.clusters) CHECK(cluster.material >= 2);
}

TEST_CASE("what stands beside points stays, what moves moves them, and they turn to the eye") {
  GltfFile file;
  const int square = file.floats({0, 0, -9, 1, 0, -9, 1, 1, -9}, "VEC3");
  file.show({{"attributes", {{"POSITION", square}}}});
  const int moving = file.show({{"attributes", {{"POSITION", square}}}, {"mode", 0}});
  file.add(
      "animations",
      {{"channels", {{{"sampler", 0}, {"target", {{"node", moving}, {"path", "translation"}}}}}},
       {"samplers",
        {{{"input", file.floats({0, 2}, "SCALAR")}, {"output", file.floats({0, 0, 0, 0, 4, 0}, "VEC3")}}}}});
  const auto loaded = load(file);
  REQUIRE(loaded);
  const Scene& scene = *loaded->scene;
  CHECK(scene.static_vertices == 3);
  CHECK(scene.duration == 2.0);
  Pose posed;
  for (const glm::vec3& eye : eyes) {
    pose(scene, 1.0, eye, posed);
    REQUIRE(posed.vertices.size() == 3 * disc_corners);
    for (std::size_t point = 0; point < 3; ++point) {
      const std::vector<Vertex> disc(posed.vertices.begin() + static_cast<long>(point * disc_corners),
                                     posed.vertices.begin() + static_cast<long>((point + 1) * disc_corners));
      CHECK(backs(Form::points, disc, eye) == 0);
      glm::vec3 middle(0.0f);
      for (const Vertex& vertex : disc) middle += vertex.position / float{disc_corners};
      const glm::vec3 wanted = scene.geometry.vertices[point].position + glm::vec3(0, 2, 0);
      CHECK(glm::distance(middle, wanted) < 1e-3f);
    }
    for (const Cluster& cluster : posed.clusters)
      for (std::uint32_t k = 0; k < cluster.index_count; ++k) {
        const std::uint32_t index = scene.geometry.indices[cluster.first_index + k];
        const glm::vec3 place =
            index < 3 ? scene.geometry.vertices[index].position : posed.vertices[index - 3].position;
        CHECK(glm::distance(place, cluster.center) <= cluster.radius * 1.000001f);
      }
  }
}
