#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "renderer/gl/embedded.h"
#include "renderer/gl/shader.h"

using namespace cupola;

TEST_CASE("includes are resolved once, defines stand first") {
  const std::vector<std::string> defines{"CUPOLA_DIRECT", "ANSWER 42"};
  const auto expanded = gl::expand("renderer/passes/scene.vert.glsl", defines);
  REQUIRE(expanded);
  CHECK(expanded->text.rfind("#version 450 core\n#define CUPOLA_DIRECT\n#define ANSWER 42\n", 0) == 0);
  CHECK(expanded->text.find("#include") == std::string::npos);
  CHECK(expanded->text.find("uniform FrameBlock") != std::string::npos);
  CHECK(expanded->text.find("uniform FrameBlock") == expanded->text.rfind("uniform FrameBlock"));
  CHECK(expanded->files.front() == "renderer/passes/scene.vert.glsl");
}

TEST_CASE("a file that is not there is a problem that names it") {
  const auto expanded = gl::expand("renderer/passes/absent.glsl", {});
  REQUIRE_FALSE(expanded);
  CHECK(expanded.error().front().code == model::Code::shader_failed);
  CHECK(expanded.error().front().expected.find("renderer/passes/absent.glsl") != std::string::npos);
}

TEST_CASE("the compiler's places become files and lines") {
  const std::vector<std::string> files{"a.glsl", "b.glsl"};
  CHECK(gl::map_message("1:14(7): error: x", files) == "b.glsl:14(7): error: x");  // Mesa
  CHECK(gl::map_message("0(3) : error C1: y", files) == "a.glsl:3 : error C1: y"); // NVIDIA
  CHECK(gl::map_message("1:1(1): e\n0:2(2): f", files) == "b.glsl:1(1): e\na.glsl:2(2): f");
  CHECK(gl::map_message("7:1(1): unknown", files) == "7:1(1): unknown");
  CHECK(gl::map_message("no place", files) == "no place");
}

TEST_CASE("every shader of the tree is embedded under its path") {
  bool found = false;
  for (const gl::EmbeddedFile& file : gl::embedded_files()) {
    CHECK(!file.text.empty());
    found = found || file.name == "renderer/content/shading.glsl";
  }
  CHECK(found);
}
