// Files that contradict themselves: each with the place that the problem has to name.
#include <doctest/doctest.h>
#include <functional>
#include <sys/stat.h>

#include "renderer/content/random.h"
#include "tests/renderer/content/gltf_file.h"
#include "tests/renderer/content/scene_checks.h"

using namespace cupola;
using namespace cupola::content;

namespace {

/// Two nodes, a textured and animated square with skin and morph target: something of everything.
/// `picture`: its texture is in the file.
GltfFile rich(bool picture = true) {
  GltfFile file;
  const std::vector<std::uint8_t> bytes = png({255, 0, 0, 0, 0, 255});
  file.add("images", {{"bufferView", file.view(bytes.data(), bytes.size())}, {"mimeType", "image/png"}});
  file.add("samplers", {{"wrapS", 10497}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const int position = file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");            // 0
  const int uv = file.floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");                              // 1
  const int indices = file.shorts({0, 1, 2, 0, 2, 3}, "SCALAR");                             // 2
  const int joints = file.bytes({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");   // 3
  const int weights = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4"); // 4
  const int node =
      file.show({{"attributes",
                  {{"POSITION", position}, {"TEXCOORD_0", uv}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
                 {"indices", indices},
                 {"material", 0},
                 {"targets", {{{"POSITION", position}}}}},
                {{"skin", 0}});
  const int joint = file.add("nodes", {{"name", "joint"}});
  file.json["scenes"][0]["nodes"].push_back(joint);
  file.add("skins", {{"joints", {joint}}});
  const int times = file.floats({0, 1}, "SCALAR");           // 5
  const int moves = file.floats({0, 0, 0, 1, 0, 0}, "VEC3"); // 6
  const int sizes = file.floats({0, 1}, "SCALAR");           // 7
  file.add("animations",
           {{"samplers", {{{"input", times}, {"output", moves}}, {{"input", times}, {"output", sizes}}}},
            {"channels",
             {{{"sampler", 0}, {"target", {{"node", joint}, {"path", "translation"}}}},
              {{"sampler", 1}, {"target", {{"node", node}, {"path", "weights"}}}}}}});
  const std::vector<std::uint8_t> where{1, 3};
  const std::vector<float> what{5, 6};
  file.add("accessors", {{"componentType", 5126},
                         {"count", 4},
                         {"type", "SCALAR"}, // 8
                         {"sparse",
                          {{"count", 2},
                           {"indices", {{"bufferView", file.view(where.data(), 2)}, {"componentType", 5121}}},
                           {"values", {{"bufferView", file.view(what.data(), 8)}}}}}});
  if (!picture)
    file.json.erase("images"), file.json.erase("textures"), file.json.erase("materials"),
        file.json["meshes"][0]["primitives"][0].erase("material");
  return file;
}

struct Case {
  const char* pointer;
  std::function<void(Json&)> change;
};

bool names(const model::Problems& problems, const std::string& pointer) {
  return std::any_of(problems.begin(), problems.end(), [&](const model::Problem& p) {
    return p.pointer == pointer && p.severity == model::Severity::error && !p.expected.empty();
  });
}

} // namespace

TEST_CASE("the file that the broken ones come from is good") {
  const auto loaded = load(rich());
  if (!loaded)
    for (const model::Problem& problem : loaded.error()) MESSAGE(to_text(problem));
  REQUIRE(loaded);
  CHECK(loaded->warnings.empty());
  CHECK(loaded->scene->duration == doctest::Approx(1.0));
}

TEST_CASE("every contradiction is a problem at its own place") {
  const Case cases[] = {
      {"/asset", [](Json& j) { j.erase("asset"); }},
      {"/asset/version", [](Json& j) { j["asset"]["version"] = "1.0"; }},
      {"/asset/version", [](Json& j) { j["asset"]["version"] = 2; }},
      {"/extensionsRequired/0", [](Json& j) { j["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "missing.bin"}, {"byteLength", 8}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "/etc/hostname"}, {"byteLength", 1}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "../made.gltf"}, {"byteLength", 1}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "%2e%2e/made.gltf"}, {"byteLength", 1}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "http://example.org/a.bin"}, {"byteLength", 1}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "data:;base64,A*B"}, {"byteLength", 1}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"byteLength", 8}}});
       }},
      {"/buffers/0/uri",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "."}, {"byteLength", 8}}});
       }},
      {"/buffers/0/byteLength",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "data:;base64,AAAA"}, {"byteLength", 9}}});
       }},
      {"/buffers/0/byteLength",
       [](Json& j) {
         j["buffers"] = Json::array({{{"uri", "data:;base64,AAAA"}, {"byteLength", -1}}});
       }},
      {"/bufferViews/1/buffer", [](Json& j) { j["bufferViews"][1]["buffer"] = 1; }},
      {"/bufferViews/1/byteOffset", [](Json& j) { j["bufferViews"][1]["byteOffset"] = 1'000'000; }},
      {"/bufferViews/1/byteLength", [](Json& j) { j["bufferViews"][1]["byteLength"] = 2'000'000'000; }},
      {"/bufferViews/1/byteLength", [](Json& j) { j["bufferViews"][1]["byteLength"] = 1e300; }},
      {"/bufferViews/1/byteLength", [](Json& j) { j["bufferViews"][1]["byteLength"] = 48.5; }},
      {"/bufferViews/1/byteStride", [](Json& j) { j["bufferViews"][1]["byteStride"] = 6; }},
      {"/bufferViews/1/byteStride", [](Json& j) { j["bufferViews"][1]["byteStride"] = 4; }},
      {"/accessors/0/bufferView", [](Json& j) { j["accessors"][0]["bufferView"] = 99; }},
      {"/accessors/0/bufferView", [](Json& j) { j["accessors"][0]["bufferView"] = "1"; }},
      {"/accessors/0/byteOffset", [](Json& j) { j["accessors"][0]["byteOffset"] = 2; }},
      {"/accessors/0/byteOffset", [](Json& j) { j["accessors"][0]["byteOffset"] = 40; }},
      {"/accessors/0/byteOffset", [](Json& j) { j["accessors"][0]["byteOffset"] = 4'000'000; }},
      {"/accessors/0/count", [](Json& j) { j["accessors"][0]["count"] = 5; }},
      {"/accessors/0/count", [](Json& j) { j["accessors"][0]["count"] = 0; }},
      {"/accessors/0/count", [](Json& j) { j["accessors"][0]["count"] = 2'000'000'000; }},
      {"/accessors/8/count", [](Json& j) { j["accessors"][8]["count"] = 40'000'000; }},
      {"/accessors/0/componentType", [](Json& j) { j["accessors"][0]["componentType"] = 5124; }},
      {"/accessors/0/componentType", [](Json& j) { j["accessors"][0].erase("componentType"); }},
      {"/accessors/0/type", [](Json& j) { j["accessors"][0]["type"] = "VEC5"; }},
      {"/accessors/8/sparse/count", [](Json& j) { j["accessors"][8]["sparse"]["count"] = 5; }},
      {"/accessors/8/sparse/indices", [](Json& j) { j["accessors"][8]["count"] = 3; }},
      {"/accessors/8/sparse/indices/bufferView",
       [](Json& j) { j["accessors"][8]["sparse"]["indices"]["bufferView"] = 50; }},
      {"/accessors/8/sparse/indices/byteOffset",
       [](Json& j) { j["accessors"][8]["sparse"]["indices"]["byteOffset"] = 50; }},
      {"/accessors/8/sparse/indices/componentType",
       [](Json& j) { j["accessors"][8]["sparse"]["indices"]["componentType"] = 5126; }},
      {"/accessors/8/sparse/values/byteOffset",
       [](Json& j) { j["accessors"][8]["sparse"]["values"]["byteOffset"] = 400; }},
      {"/meshes/0/primitives/0/indices", [](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 77; }},
      {"/meshes/0/primitives/0/indices", [](Json& j) { j["accessors"][2]["count"] = 5; }},
      {"/accessors/0/componentType", [](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 0; }},
      {"/meshes/0/primitives/0/mode", [](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; }},
      {"/meshes/0/primitives/0/indices", // an odd number of ends of lines
       [](Json& j) {
         j["accessors"][2]["count"] = 5;
         j["meshes"][0]["primitives"][0]["mode"] = 1;
       }},
      {"/meshes/0/primitives/0/material", [](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 1; }},
      {"/meshes/0/primitives/0/attributes/TEXCOORD_0",
       [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2; }},
      {"/meshes/0/primitives/0/attributes/POSITION",
       [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 1; }},
      {"/meshes/0/primitives/0/attributes/a~1b~0",
       [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["a/b~"] = 99; }},
      {"/meshes/0/primitives", [](Json& j) { j["meshes"][0]["primitives"] = "none"; }},
      {"/meshes/0/weights",
       [](Json& j) {
         j["meshes"][0]["weights"] = {1, 2};
       }},
      {"/images/0", [](Json& j) { j["images"][0]["bufferView"] = 1; }},
      {"/images/0/uri",
       [](Json& j) {
         j["images"][0] = {{"uri", "no.png"}};
       }},
      {"/images/0", [](Json& j) { j["images"][0] = Json::object(); }},
      {"/textures/0/source", [](Json& j) { j["textures"][0]["source"] = 1; }},
      {"/textures/0/source", [](Json& j) { j["textures"][0].erase("source"); }},
      {"/samplers/0/wrapS", [](Json& j) { j["samplers"][0]["wrapS"] = 3; }},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index",
       [](Json& j) { j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 4; }},
      {"/materials/0/alphaMode", [](Json& j) { j["materials"][0]["alphaMode"] = "GLASS"; }},
      {"/materials/0/emissiveFactor",
       [](Json& j) {
         j["materials"][0]["emissiveFactor"] = {1, 2};
       }},
      {"/nodes/0/mesh", [](Json& j) { j["nodes"][0]["mesh"] = 3; }},
      {"/nodes/0/matrix",
       [](Json& j) {
         j["nodes"][0]["matrix"] = {1, 2, 3};
       }},
      {"/nodes/0/rotation",
       [](Json& j) {
         j["nodes"][0]["rotation"] = {0, 0, 0, 0};
       }},
      {"/nodes/1/children", [](Json& j) { j["nodes"][1]["children"] = {1}; }},
      {"/nodes/0/children",
       [](Json& j) { j["nodes"][0]["children"] = {1}, j["nodes"][1]["children"] = {0}; }},
      {"/nodes/2/children/0",
       [](Json& j) {
         j["nodes"][1]["children"] = {0}, j["nodes"].push_back({{"children", {0}}});
       }},
      {"/nodes/0/children/0", [](Json& j) { j["nodes"][0]["children"] = {12}; }},
      {"/scenes/0/nodes/0", [](Json& j) { j["nodes"][1]["children"] = {0}; }},
      {"/scene", [](Json& j) { j["scene"] = 1; }},
      {"/skins/0/joints", [](Json& j) { j["skins"][0]["joints"] = Json::array(); }},
      {"/skins/0/joints/0", [](Json& j) { j["skins"][0]["joints"] = {9}; }},
      {"/skins/0/inverseBindMatrices", [](Json& j) { j["skins"][0]["inverseBindMatrices"] = 4; }},
      {"/animations/0/channels/0/sampler", [](Json& j) { j["animations"][0]["channels"][0]["sampler"] = 8; }},
      {"/animations/0/channels/0/target/node",
       [](Json& j) { j["animations"][0]["channels"][0]["target"]["node"] = 8; }},
      {"/animations/0/channels/0/target/node",
       [](Json& j) { j["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }},
      {"/animations/0/samplers/0/input", [](Json& j) { j["animations"][0]["samplers"][0]["input"] = 4; }},
      {"/animations/0/samplers/0/output", [](Json& j) { j["animations"][0]["samplers"][0]["output"] = 0; }},
      {"/animations/0/samplers/0/interpolation",
       [](Json& j) { j["animations"][0]["samplers"][0]["interpolation"] = "LOG"; }},
      {"/nodes",
       [](Json& j) {
         j["nodes"] = {{"a", 1}};
       }},
  };
  for (const Case& one : cases) {
    const std::string pointer = one.pointer;
    CAPTURE(pointer);
    GltfFile file = rich();
    one.change(file.json);
    const auto loaded = load(file);
    REQUIRE_FALSE(loaded);
    std::string all;
    for (const model::Problem& problem : loaded.error()) all += to_text(problem) + '\n';
    CAPTURE(all);
    CHECK(names(loaded.error(), one.pointer));
  }
}

TEST_CASE("an index beyond the vertices, a joint beyond the skin, numbers that are none") {
  GltfFile file;
  const int position = file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3");
  file.show({{"attributes", {{"POSITION", position}}}, {"indices", file.bytes({0, 1, 3}, "SCALAR")}});
  auto loaded = load(file);
  REQUIRE_FALSE(loaded);
  CHECK(names(loaded.error(), "/meshes/0/primitives/0/indices"));

  GltfFile joints = rich();
  joints.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
      joints.bytes({7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  loaded = load(joints);
  REQUIRE_FALSE(loaded);
  CHECK(names(loaded.error(), "/nodes/0/skin"));

  GltfFile infinite;
  infinite.show(
      {{"attributes",
        {{"POSITION",
          infinite.floats({0, 0, 0, 1, 0, 0, 1, std::numeric_limits<float>::infinity(), 0}, "VEC3")}}}});
  loaded = load(infinite);
  REQUIRE_FALSE(loaded);
  CHECK(names(loaded.error(), "/accessors/0"));
}

TEST_CASE("a small file cannot ask for much memory") {
  GltfFile file; // 4,000 nodes that each show 100,000 vertices
  const int position = file.add("accessors", {{"componentType", 5126}, {"count", 99'999}, {"type", "VEC3"}});
  const int mesh = file.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", position}}}}}}});
  for (int i = 0; i < 4000; ++i)
    file.json["scenes"][0]["nodes"].push_back(file.add("nodes", {{"mesh", mesh}}));
  const auto loaded = load(file);
  REQUIRE_FALSE(loaded);
  CHECK(loaded.error()[0].code == model::Code::scene_limit);
}

TEST_CASE("a damaged picture is a problem") {
  for (std::size_t at = 20; at < 60; at += 20) {
    std::vector<std::uint8_t> bytes = png({255, 0, 0, 0, 0, 255});
    bytes[at] ^= 0x55;
    GltfFile file = rich();
    file.json["images"][0] = {{"uri", "data:image/png;base64," + base64(bytes)}};
    const auto loaded = load(file);
    REQUIRE_FALSE(loaded);
    CHECK(names(loaded.error(), "/images/0"));
  }
}

TEST_CASE("what is no glTF file") {
  const auto refused = [](const std::filesystem::path& file, model::Code code) {
    CAPTURE(file.string());
    const auto loaded = load(file);
    REQUIRE_FALSE(loaded);
    CHECK(loaded.error()[0].code == code);
    CHECK(loaded.error()[0].at.file == file.string());
  };
  const auto text = [](const std::string& name, const std::string& content) {
    return write_bytes(name, {content.begin(), content.end()});
  };
  refused(gltf_folder() / "nowhere.gltf", model::Code::scene_unreadable);
  refused(text("empty.gltf", ""), model::Code::scene_unreadable);
  refused(text("half.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": ["),
          model::Code::scene_unreadable);
  refused(text("number.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}"),
          model::Code::scene_unreadable);
  refused(text("list.gltf", "[]"), model::Code::scene_invalid);
  refused(text("deep.gltf", std::string(100'000, '[')), model::Code::scene_limit);
  refused(text("latin.gltf", "{\"asset\": {\"version\": \"2.0\", \"generator\": \"\xe4\"}}"),
          model::Code::scene_unreadable);
  std::filesystem::create_directories(gltf_folder() / "folder.gltf");
  refused(gltf_folder() / "folder.gltf", model::Code::scene_unreadable);
  const std::filesystem::path pipe = gltf_folder() / "pipe.gltf";
  mkfifo(pipe.c_str(), 0600);
  refused(pipe, model::Code::scene_unreadable);
  std::filesystem::remove(pipe);
}

TEST_CASE("a GLB file that is cut off anywhere is a problem or whole enough, never a crash") {
  const std::vector<std::uint8_t> whole = rich().glb();
  REQUIRE(load(write_bytes("whole.glb", whole)));
  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 97) {
    const std::vector<std::uint8_t> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    CHECK_FALSE(load(write_bytes("part.glb", part)));
  }
}

TEST_CASE("random byte flips: a sound scene or problems") {
  const std::vector<std::uint8_t> whole = rich(false).glb(); // libpng would print each mistake
  Random random{99};
  int survived = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<std::uint8_t> bytes = whole;
    const int flips = 1 + random.below(4);
    for (int i = 0; i < flips; ++i)
      bytes[static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())))] ^=
          static_cast<std::uint8_t>(1U << random.below(8));
    const auto loaded = load(write_bytes("flipped.glb", bytes));
    if (!loaded) {
      CHECK_FALSE(loaded.error().empty());
      continue;
    }
    ++survived;
    for (const std::uint32_t index : loaded->scene->geometry.indices)
      REQUIRE(index < loaded->scene->geometry.vertices.size());
    Pose posed;
    pose(*loaded->scene, 0.5, glm::vec3(0.0f), posed);
  }
  CHECK(survived > 30); // names and numbers may change without harm
  CHECK(survived < 950);
}
