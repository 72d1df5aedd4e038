#include "renderer/content/gltf.h"

#include <doctest/doctest.h>

#include "tests/renderer/content/gltf_file.h"
#include "tests/renderer/content/scene_checks.h"

using namespace cupola;
using namespace cupola::content;

namespace {

const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}; ///< counter-clockwise, facing +z

const Scene& good(const model::Result<LoadedScene>& loaded) {
  if (!loaded)
    for (const model::Problem& problem : loaded.error()) MESSAGE(to_text(problem));
  REQUIRE(loaded);
  for (const model::Problem& problem : loaded->warnings) CHECK_MESSAGE(false, to_text(problem));
  check_geometry(*loaded->scene);
  return *loaded->scene;
}

/// Corners of all triangles, in order.
std::vector<glm::vec3> corners(const Scene& scene) {
  std::vector<glm::vec3> all;
  for (const std::uint32_t index : scene.geometry.indices)
    all.push_back(scene.geometry.vertices[index].position);
  return all;
}

glm::vec3 facing(const Scene& scene, std::size_t triangle) {
  const auto c = corners(scene);
  return glm::normalize(
      glm::cross(c[3 * triangle + 1] - c[3 * triangle], c[3 * triangle + 2] - c[3 * triangle]));
}

float area(const Scene& scene) {
  const auto c = corners(scene);
  float sum = 0.0f;
  for (std::size_t i = 0; i + 2 < c.size(); i += 3)
    sum += 0.5f * glm::length(glm::cross(c[i + 1] - c[i], c[i + 2] - c[i]));
  return sum;
}

} // namespace

TEST_CASE("all kinds of indices, strips, fans and none at all draw the same square") {
  for (const char* kind : {"bytes", "shorts", "words", "strip", "fan", "none"}) {
    CAPTURE(kind);
    const std::string name = kind;
    GltfFile file;
    Json primitive{{"attributes", {{"POSITION", file.floats(square, "VEC3")}}}};
    if (name == "bytes") primitive["indices"] = file.bytes({0, 1, 2, 0, 2, 3}, "SCALAR");
    if (name == "shorts") primitive["indices"] = file.shorts({0, 1, 2, 0, 2, 3}, "SCALAR");
    if (name == "words") primitive["indices"] = file.words({0, 1, 2, 0, 2, 3}, "SCALAR");
    if (name == "strip") {
      primitive["indices"] = file.shorts({0, 1, 3, 2}, "SCALAR");
      primitive["mode"] = 5;
    }
    if (name == "fan") primitive["mode"] = 6;
    if (name == "none")
      primitive["attributes"]["POSITION"] =
          file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    file.show(primitive);
    const auto loaded = load(file);
    const Scene& scene = good(loaded);
    REQUIRE(scene.geometry.indices.size() == 6);
    CHECK(area(scene) == doctest::Approx(1.0));
    for (const std::size_t triangle : {0U, 1U}) CHECK(facing(scene, triangle).z == doctest::Approx(1.0));
    for (const Vertex& vertex : scene.geometry.vertices)
      CHECK(vertex.normal.z == doctest::Approx(1.0)); // computed
  }
}

TEST_CASE("nodes: matrices, scale of the show, mirrored nodes keep their front") {
  GltfFile file;
  const int position = file.floats(square, "VEC3");
  const Json primitive{{"attributes", {{"POSITION", position}}}, {"mode", 6}};
  const int parent =
      file.add("nodes", {{"translation", {10, 0, 0}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}});
  file.json["scenes"][0]["nodes"].push_back(parent);
  const int mesh = file.add("meshes", {{"primitives", {primitive}}});
  const int child =
      file.add("nodes", {{"mesh", mesh}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 3, 1}}});
  file.json["nodes"][parent]["children"] = {child};
  file.show(primitive, {{"scale", {-1, 1, 1}}});
  const auto loaded = load(file, "", 0.5);
  const Scene& scene = good(loaded);
  // the child's square lies 3 m along the parent's +z, which is the world's +x
  CHECK(scene.bounds_max.x == doctest::Approx((10.0 + 3.0) * 0.5));
  CHECK(scene.bounds_min.z == doctest::Approx(-2.0 * 0.5)); // +x of the square became -z
  CHECK(scene.bounds_min.x == doctest::Approx(-1.0 * 0.5));
  for (std::size_t t = 0; t < 4; ++t) {
    const std::uint32_t index = scene.geometry.indices[3 * t];
    CHECK(glm::dot(facing(scene, t), scene.geometry.vertices[index].normal) == doctest::Approx(1.0));
  }
}

TEST_CASE("attributes: normals, texture coordinates of all types, vertex colours") {
  GltfFile file;
  const std::vector<float> normals{0, 0, 2, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  file.show({{"attributes",
              {{"POSITION", file.floats(square, "VEC3")},
               {"NORMAL", file.floats(normals, "VEC3")},
               {"TEXCOORD_0", file.shorts({0, 0, 65535, 0, 65535, 65535, 0, 65535}, "VEC2", true)},
               {"COLOR_0", file.bytes({255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 51, 51}, "VEC3", true)}}},
             {"mode", 6}});
  // three bytes a colour need a stride of four in files that keep the rules; this view is packed
  const auto loaded = load(file);
  const Scene& scene = good(loaded);
  REQUIRE(scene.geometry.vertices.size() == 4);
  CHECK(scene.geometry.vertices[0].normal == glm::vec3(0, 0, 1));
  CHECK(scene.geometry.vertices[2].uv == glm::vec2(1, 1));
  CHECK(scene.geometry.vertices[0].color == 0xff0000ffU);
  CHECK(scene.geometry.vertices[3].color == 0xff333333U);
}

TEST_CASE("interleaved attributes by byteStride") {
  GltfFile file;
  std::vector<float> mixed;
  for (std::size_t i = 0; i < 4; ++i) {
    mixed.insert(mixed.end(), square.begin() + static_cast<std::ptrdiff_t>(3 * i),
                 square.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    mixed.insert(mixed.end(), {static_cast<float>(i), 0.5f});
  }
  const int view = file.view(mixed.data(), mixed.size() * 4);
  file.json["bufferViews"][view]["byteStride"] = 20;
  const int position =
      file.add("accessors", {{"bufferView", view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  const int uv = file.add(
      "accessors",
      {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}});
  file.show({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"mode", 6}});
  const auto loaded = load(file);
  const Scene& scene = good(loaded);
  CHECK(area(scene) == doctest::Approx(1.0));
  CHECK(scene.bounds_max == glm::vec3(1, 1, 0));
  CHECK(scene.geometry.vertices[0].uv == glm::vec2(1, 0.5)); // a fan's triangle begins with its second corner
}

TEST_CASE("materials, samplers, textures and their transforms") {
  GltfFile file;
  const std::vector<std::uint8_t> picture = png({255, 0, 0, 0, 255, 0});
  const int view = file.view(picture.data(), picture.size());
  file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  file.add("images", {{"uri", "data:image/png;base64," + base64(picture)}});
  file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9729}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  file.add("textures", {{"source", 1}});
  const Json transform{
      {"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}}}};
  file.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_unlit"};
  file.add("materials", {{"name", "one"},
                         {"pbrMetallicRoughness",
                          {{"baseColorFactor", {0.5, 0.25, 0.125, 0.75}},
                           {"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
                           {"metallicFactor", 0.3},
                           {"roughnessFactor", 0.6},
                           {"metallicRoughnessTexture", {{"index", 1}}}}},
                         {"normalTexture", {{"index", 1}, {"scale", 0.7}}},
                         {"occlusionTexture", {{"index", 1}, {"strength", 0.4}}},
                         {"emissiveTexture", {{"index", 0}}},
                         {"emissiveFactor", {1, 0.5, 0}},
                         {"alphaMode", "MASK"},
                         {"alphaCutoff", 0.2},
                         {"doubleSided", true}});
  file.add("materials", {{"alphaMode", "BLEND"}, {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  const int position = file.floats(square, "VEC3");
  const int uv = file.floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");
  for (const int material : {1, 0})
    file.show(
        {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"material", material}, {"mode", 6}});
  file.show({{"attributes", {{"POSITION", position}}}, {"mode", 6}});
  const auto loaded = load(file);
  const Scene& scene = good(loaded);
  const Material& m = scene.materials.at(0);
  CHECK(m.base_color == glm::vec4(0.5f, 0.25f, 0.125f, 0.75f));
  CHECK(m.metallic == doctest::Approx(0.3));
  CHECK(m.roughness == doctest::Approx(0.6));
  CHECK(m.normal_scale == doctest::Approx(0.7));
  CHECK(m.occlusion_strength == doctest::Approx(0.4));
  CHECK(m.emissive == glm::vec3(1.0f, 0.5f, 0.0f));
  CHECK(m.alpha_mode == AlphaMode::mask);
  CHECK(m.alpha_cutoff == doctest::Approx(0.2));
  CHECK(m.double_sided);
  CHECK(scene.materials.at(1).unlit);
  CHECK(scene.materials.at(1).alpha_mode == AlphaMode::blend);
  CHECK(scene.materials.at(2).metallic == 1.0f); // glTF's default material
  const Texture& texture = scene.textures.at(static_cast<std::size_t>(m.base_color_map.texture));
  CHECK(texture.wrap_s == Wrap::clamp);
  CHECK(texture.wrap_t == Wrap::mirror);
  CHECK(texture.nearest);
  CHECK_FALSE(texture.mipmaps);
  const Image& image = scene.images.at(static_cast<std::size_t>(texture.image));
  CHECK(image.srgb);
  CHECK(image.rgba == std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255});
  const Texture& data = scene.textures.at(static_cast<std::size_t>(m.normal_map.texture));
  CHECK_FALSE(scene.images.at(static_cast<std::size_t>(data.image)).srgb);
  CHECK(data.wrap_s == Wrap::repeat);
  CHECK(m.occlusion_map.texture == m.metallic_roughness_map.texture);
  // The extension's own example: the lower left quarter of the picture (v down).
  for (const glm::vec2& at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    const glm::vec3 moved = m.base_color_map.transform * glm::vec3(at, 1.0f);
    CHECK(moved.x == doctest::Approx(at.y * 0.5));
    CHECK(moved.y == doctest::Approx(1.0 - at.x * 0.5));
  }
  CHECK(scene.geometry.clusters.back().material == 1); // what blends stands last
}

TEST_CASE("a material on the second set of coordinates, and one on two sets") {
  GltfFile file;
  const std::vector<std::uint8_t> picture = png({255, 0, 0});
  file.add("images", {{"uri", "data:image/png;base64," + base64(picture)}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}},
                         {"occlusionTexture", {{"index", 0}}}});
  file.show({{"attributes",
              {{"POSITION", file.floats(square, "VEC3")},
               {"TEXCOORD_0", file.floats({9, 9, 9, 9, 9, 9, 9, 9}, "VEC2")},
               {"TEXCOORD_1", file.floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2")}}},
             {"material", 0},
             {"mode", 6}});
  const auto loaded = load(file);
  REQUIRE(loaded);
  CHECK(loaded->scene->geometry.vertices[1].uv == glm::vec2(1, 1)); // the fan's third corner
  CHECK(loaded->scene->materials[0].occlusion_map.texture == -1);
  REQUIRE(loaded->warnings.size() == 1);
  CHECK(loaded->warnings[0].pointer == "/materials/0/occlusionTexture/texCoord");
  CHECK(loaded->warnings[0].severity == model::Severity::warning);
}

TEST_CASE("punctual lights") {
  GltfFile file;
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 2}},
      {{"type", "spot"},
       {"intensity", 10},
       {"range", 8},
       {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}};
  const auto light = [](int index) { return Json{{"KHR_lights_punctual", {{"light", index}}}}; };
  file.show({{"attributes", {{"POSITION", file.floats(square, "VEC3")}}}, {"mode", 6}},
            {{"extensions", light(0)}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}});
  const int spot = file.add("nodes", {{"translation", {1, 2, 3}}, {"extensions", light(1)}});
  file.json["scenes"][0]["nodes"].push_back(spot);
  const auto loaded = load(file, "", 2.0);
  const Scene& scene = good(loaded);
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].kind == LightKind::directional);
  CHECK(scene.lights[0].radiance == glm::vec3(2, 1, 0));
  CHECK(scene.lights[0].direction.y == doctest::Approx(-1.0)); // -z, turned down by a quarter
  CHECK(scene.lights[1].kind == LightKind::spot);
  CHECK(scene.lights[1].position == glm::vec3(2, 4, 6));
  CHECK(scene.lights[1].range == doctest::Approx(16.0));
  CHECK(scene.lights[1].radiance.x == doctest::Approx(40.0)); // as bright at twice the distance
  CHECK(scene.lights[1].cos_outer == doctest::Approx(std::cos(0.5)));
}

TEST_CASE("sparse accessors, with and without a buffer beneath") {
  GltfFile file;
  const std::vector<std::uint16_t> where{0, 2};
  const std::vector<float> what{0, 0, 5, 1, 1, 5};
  const Json sparse{{"count", 2},
                    {"indices", {{"bufferView", file.view(where.data(), 4)}, {"componentType", 5123}}},
                    {"values", {{"bufferView", file.view(what.data(), 24)}}}};
  const int moved = file.floats(square, "VEC3");
  file.json["accessors"][moved]["sparse"] = sparse;
  const int zero =
      file.add("accessors", {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}, {"sparse", sparse}});
  file.show({{"attributes", {{"POSITION", moved}}}, {"mode", 6}});
  const auto loaded = load(file);
  const Scene& scene = good(loaded);
  CHECK(scene.bounds_max.z == doctest::Approx(5.0));
  CHECK(scene.bounds_max.x == doctest::Approx(1.0));
  GltfFile other = file;
  other.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = zero;
  const auto second = load(other);
  CHECK(good(second).bounds_max == glm::vec3(1, 1, 5));
}

TEST_CASE("a binary container, with its numbers and a picture inside") {
  GltfFile file;
  file.show({{"attributes", {{"POSITION", file.floats(square, "VEC3")}}}, {"mode", 6}});
  const auto loaded = load(write_bytes("made.glb", file.glb()));
  CHECK(area(good(loaded)) == doctest::Approx(1.0));
}

TEST_CASE("files beside the document, with spaces and percent signs in their names") {
  GltfFile file;
  std::vector<std::uint8_t> bytes(square.size() * 4);
  std::memcpy(bytes.data(), square.data(), bytes.size());
  write_bytes("a buffer.bin", bytes);
  file.add("bufferViews", {{"buffer", 0}, {"byteLength", 48}});
  file.add("accessors", {{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  file.show({{"attributes", {{"POSITION", 0}}}, {"mode", 6}});
  for (const char* uri : {"a buffer.bin", "a%20buffer.bin", "./a%20buffer.bin"}) {
    file.json["buffers"] = Json::array({{{"uri", uri}, {"byteLength", 48}}});
    const auto loaded = load(file);
    CHECK(area(good(loaded)) == doctest::Approx(1.0));
  }
}

TEST_CASE("only the opening scene's nodes are shown") {
  GltfFile file;
  const Json primitive{{"attributes", {{"POSITION", file.floats(square, "VEC3")}}}, {"mode", 6}};
  file.show(primitive);
  file.show(primitive, {{"translation", {50, 0, 0}}});
  file.json["scenes"][0]["nodes"] = {0};
  const auto loaded = load(file);
  CHECK(good(loaded).bounds_max.x == doctest::Approx(1.0));
}

TEST_CASE("a large scene: 4,000 nodes of 250 triangles") {
  GltfFile file;
  std::vector<float> fan{0, 0, 0};
  for (int i = 0; i <= 250; ++i)
    fan.insert(fan.end(), {std::cos(i * 0.02513f), std::sin(i * 0.02513f), 0.0f});
  const int mesh = file.add(
      "meshes", {{"primitives", {{{"attributes", {{"POSITION", file.floats(fan, "VEC3")}}}, {"mode", 6}}}}});
  for (int i = 0; i < 4000; ++i) {
    const int node = file.add("nodes", {{"mesh", mesh}, {"translation", {3 * (i % 64), 0, -3 * (i / 64)}}});
    file.json["scenes"][0]["nodes"].push_back(node);
  }
  const auto loaded = load(file);
  const Scene& scene = good(loaded);
  CHECK(scene.geometry.indices.size() == std::size_t{3} * 4000 * 250);
  CHECK(scene.geometry.clusters.size() >= 1000 * 1000 / 256);
}

TEST_CASE("what lessens the picture is a named warning") {
  struct Case {
    const char* name;
    const char* pointer;
    void (*change)(GltfFile&);
  };
  const Case cases[] = {
      {"an unknown extension", "/extensionsUsed/0",
       [](GltfFile& f) { f.json["extensionsUsed"] = {"KHR_materials_clearcoat"}; }},
      {"no positions", "/meshes/0/primitives/0/attributes",
       [](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["attributes"] = Json::object(); }},
  };
  for (const Case& one : cases) {
    CAPTURE(one.name);
    GltfFile file;
    const int position = file.floats(square, "VEC3");
    for (int i = 0; i < 2; ++i) file.show({{"attributes", {{"POSITION", position}}}, {"mode", 6}});
    one.change(file);
    const auto loaded = load(file);
    REQUIRE(loaded);
    REQUIRE(loaded->warnings.size() == 1);
    CHECK(loaded->warnings[0].pointer == one.pointer);
    CHECK(loaded->warnings[0].code == model::Code::scene_unsupported);
    CHECK(loaded->warnings[0].at.file == (gltf_folder() / "made.gltf").string());
    CHECK_FALSE(loaded->scene->geometry.indices.empty());
  }
}
