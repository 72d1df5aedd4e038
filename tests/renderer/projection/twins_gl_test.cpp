// C++ and GLSL twins against each other, on the device that is there.
//
// Tolerances come from float: 2^-24 = 6e-8 relative per operation. An azimuth up to π is rounded to 2e-7 and
// its sine and cosine add as much again, so a direction before the off-axis vector is good to about 1e-6
// radians; an eye at distance 1 - g from the wall magnifies that by 1 / g. At 16384 pixels for a full turn a
// pixel is 4e-4. An orthographic picture and Panini's from afar end where directions crowd without limit:
// there a rounding in the image is a larger angle.
#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/gl/handle.h"
#include "renderer/gl/shader.h"
#include "renderer/outputs/context.h"
#include "renderer/projection/map.h"

using namespace cupola;
using namespace cupola::projection;

namespace {

const std::array<std::string, 10> names{"perspective",   "cylinder",      "fisheye",  "equirectangular",
                                        "stereographic", "orthographic",  "mercator", "panini",
                                        "cube_cross",    "camera_texture"};

constexpr const char* mains[] = {R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer In { vec4 given[]; };
layout(std430, binding = 1) writeonly buffer Out { vec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= given.length()) return;
  vec3 direction;
  bool shown = map_ray(given[i].xy, direction);
  answers[i] = vec4(direction, shown ? 1.0 : 0.0);
}
)",
                                 R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer In { vec4 given[]; };
layout(std430, binding = 1) writeonly buffer Out { vec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= given.length()) return;
  vec2 st;
  bool found = map_point(given[i].xyz, st);
  answers[i] = vec4(st, 0.0, found ? 1.0 : 0.0);
}
)"};

/// How much the twins may differ, in radians, by the least distance between eye and wall.
struct Tolerance {
  double gap, rays, points;
};
constexpr std::array tolerances{Tolerance{1.0, 1.5e-6, 1e-5}, Tolerance{0.05, 1e-5, 1e-4}};

/// Times as much where directions crowd towards the end of a shape.
double crowding(std::size_t shape) {
  return names[shape] == "orthographic" || names[shape] == "panini" ? 50.0 : 1.0;
}

/// A headless context with map.glsl compiled into two compute programs.
class Gpu {
public:
  Gpu() {
    auto made = outputs::Context::make_headless([](outputs::MessageLevel, std::string_view) {});
    REQUIRE(made);
    context_ = std::move(*made);
    REQUIRE(context_->make_current());
    const auto map = gl::expand("renderer/projection/map.glsl", {});
    REQUIRE(map);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string text = map->text + mains[i];
      const char* source = text.c_str();
      programs_[i] = gl::Program(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
      GLint linked = 0;
      glGetProgramiv(programs_[i].id(), GL_LINK_STATUS, &linked);
      std::string log(4096, ' ');
      GLsizei length = 0;
      glGetProgramInfoLog(programs_[i].id(), 4096, &length, log.data());
      REQUIRE_MESSAGE(linked == GL_TRUE, log.substr(0, static_cast<std::size_t>(length)));
    }
  }

  std::vector<glm::vec4> rays(const Map& map, const std::vector<glm::vec4>& points) {
    return run(programs_[0].id(), map, points);
  }
  std::vector<glm::vec4> points(const Map& map, const std::vector<glm::vec4>& directions) {
    return run(programs_[1].id(), map, directions);
  }

private:
  std::vector<glm::vec4> run(GLuint program, const Map& map, const std::vector<glm::vec4>& given) {
    const MapUniforms u = uniforms(map);
    glProgramUniform1i(program, MapUniforms::location_shape, u.shape);
    glProgramUniform4fv(program, MapUniforms::location_parameters, 1, glm::value_ptr(u.parameters));
    glProgramUniform1f(program, MapUniforms::location_zoom, u.zoom);
    glProgramUniform3fv(program, MapUniforms::location_off_axis, 1, glm::value_ptr(u.off_axis));
    glProgramUniformMatrix3fv(program, MapUniforms::location_orientation, 1, GL_FALSE,
                              glm::value_ptr(u.orientation));
    const auto bytes = static_cast<GLsizeiptr>(given.size() * sizeof(glm::vec4));
    const auto in = gl::Buffer::make(), out = gl::Buffer::make();
    glNamedBufferStorage(in.id(), bytes, given.data(), 0);
    glNamedBufferStorage(out.id(), bytes, nullptr, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.id());
    glUseProgram(program);
    glDispatchCompute(static_cast<GLuint>((given.size() + 63) / 64), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> answers(given.size());
    glGetNamedBufferSubData(out.id(), 0, bytes, answers.data());
    REQUIRE(glGetError() == GL_NO_ERROR);
    return answers;
  }

  std::unique_ptr<outputs::Context> context_;
  std::array<gl::Program, 2> programs_;
};

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// A shape of kind `shape`, anywhere in the ranges of the show file. `gap`: least distance of eye and wall.
Map random_map(std::size_t shape, std::mt19937& random, double gap) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  model::Projection p;
  if (shape == 0) p.shape = model::Perspective{{number(0.1, 175)}, model::Angle{number(0.1, 175)}};
  if (shape == 1) p.shape = model::Cylinder{{number(1, 360)}, {number(0.1, 170)}};
  if (shape == 2) p.shape = model::Fisheye{{number(1, 360)}};
  if (shape == 3) p.shape = model::Equirectangular{{number(1, 360)}, {number(1, 180)}};
  if (shape == 4) p.shape = model::Stereographic{{number(1, 350)}};
  if (shape == 5) p.shape = model::Orthographic{{number(1, 180)}};
  if (shape == 6) p.shape = model::Mercator{{number(1, 360)}, {number(1, 178)}};
  if (shape == 7) {
    const double distance = random() % 2 ? number(0, 1) : std::exp(number(0, 3));
    p.shape = model::Panini{{number(0.1, panini_limit(distance) * 360 / 3.1416 - 1)}, {}, distance};
  }
  if (shape == 8) p.shape = model::CubeCross{};
  if (shape == 9) { // of places, before the grid bends them: see camera_texture.glsl
    p.shape = model::CameraTexture{{number(0.1, 175)}, model::Angle{number(0.1, 175)}, 1, 1, {}, {}};
    if (gap < 1.0) p.off_axis = {number(-0.5, 0.5), number(-0.5, 0.5), number(-0.5, 0.5)};
    return make_map(p, 1.0);
  }
  p.zoom = std::exp(number(std::log(0.05), std::log(100.0)));
  if (gap < 1.0) {
    do p.off_axis = {number(-1, 1), number(-1, 1), number(-1, 1)};
    while (glm::length(p.off_axis) > 1.0 - gap);
  }
  p.orientation = {{number(-360, 360)}, {number(-90, 90)}, {number(-180, 180)}};
  return make_map(p, std::exp(number(-1, 1)));
}

std::vector<glm::vec4> grid_and_random_points(std::mt19937& random) {
  std::vector<glm::vec4> points;
  for (int y = 0; y <= 32; ++y)
    for (int x = 0; x <= 32; ++x) points.emplace_back(x / 16.0f - 1.0f, y / 16.0f - 1.0f, 0.0f, 0.0f);
  std::uniform_real_distribution<float> anywhere(-1.0f, 1.0f);
  for (int i = 0; i < 500; ++i) points.emplace_back(anywhere(random), anywhere(random), 0.0f, 0.0f);
  return points;
}

/// Whether a point stands so near to the limit of what is shown that float may decide otherwise.
bool doubtful(const Map& map, glm::dvec2 st) {
  const bool shown = ray(map, st).has_value();
  for (const double scale : {1.0 - 2e-6, 1.0 + 2e-6})
    for (const glm::dvec2 moved : {glm::dvec2(st.x * scale, st.y), glm::dvec2(st.x, st.y * scale)})
      if (ray(map, moved).has_value() != shown) return true;
  return false;
}

struct Compared {
  double worst = 0.0;
  int compared = 0, shown = 0, contrary = 0;
};

Compared compare_rays(Gpu& gpu, const Map& map, const std::vector<glm::vec4>& points) {
  Compared out;
  const auto answers = gpu.rays(map, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 st(points[i].x, points[i].y);
    if (doubtful(map, st)) continue;
    ++out.compared;
    const auto wanted = ray(map, st);
    out.contrary += wanted.has_value() != (answers[i].w == 1.0f);
    if (!wanted || answers[i].w != 1.0f) continue;
    ++out.shown;
    out.worst = std::max(out.worst, angle(*wanted, glm::dvec3(answers[i])));
  }
  return out;
}

} // namespace

TEST_CASE("rays: directions of both twins") {
  Gpu gpu;
  std::mt19937 random(21);
  const auto points = grid_and_random_points(random);
  for (std::size_t shape = 0; shape < names.size(); ++shape) {
    for (const auto& [gap, ray_tolerance, point_tolerance] : tolerances) {
      double worst = 0.0;
      int shown = 0;
      for (int i = 0; i < 150; ++i) {
        const Compared found = compare_rays(gpu, random_map(shape, random, gap), points);
        CHECK(found.contrary == 0);
        worst = std::max(worst, found.worst);
        shown += found.shown;
      }
      MESSAGE(names[shape], ", eye at least ", gap, " from the wall: largest difference ", worst,
              " rad over ", shown, " rays");
      CHECK(worst < ray_tolerance * crowding(shape));
      CHECK(shown > 20'000);
    }
  }
}

TEST_CASE("points: image coordinates of both twins show the same direction") {
  Gpu gpu;
  std::mt19937 random(22);
  std::normal_distribution<double> normal;
  std::vector<glm::vec4> directions;
  for (int i = 0; i < 1500; ++i) directions.emplace_back(normal(random), normal(random), normal(random), 0.0);
  for (std::size_t shape = 0; shape < names.size(); ++shape) {
    if (names[shape] == "camera_texture") continue; // its twin gives places, also outside the picture
    for (const auto& [gap, ray_tolerance, point_tolerance] : tolerances) {
      double worst = 0.0;
      int compared = 0, contrary = 0;
      for (int i = 0; i < 150; ++i) {
        const Map map = random_map(shape, random, gap);
        const auto answers = gpu.points(map, directions);
        for (std::size_t d = 0; d < directions.size(); ++d) {
          const glm::dvec3 direction(directions[d]);
          const auto wanted = image_point(map, direction);
          if (wanted && doubtful(map, *wanted)) continue;
          if (wanted.has_value() != (answers[d].w == 1.0f)) {
            // Only where the shape's own limit is: a rim, or a plane seen edge on.
            ++contrary;
            continue;
          }
          if (!wanted) continue;
          const auto shown = ray(map, glm::dvec2(answers[d]));
          if (!shown) continue; // float has stepped over the seam
          ++compared;
          worst = std::max(worst, angle(*shown, direction));
        }
      }
      MESSAGE(names[shape], ", eye at least ", gap, " from the wall: largest difference ", worst,
              " rad over ", compared, " directions, ", contrary, " at a limit");
      CHECK(worst < point_tolerance * crowding(shape));
      CHECK(contrary <= 20);
      CHECK(compared > 5'000);
    }
  }
}

TEST_CASE("nonsense gives no direction and no NaN") {
  Gpu gpu;
  std::mt19937 random(23);
  for (std::size_t shape = 0; shape < names.size(); ++shape) {
    const Map map = random_map(shape, random, 0.5);
    for (const glm::vec4& answer : gpu.points(map, {{0, 0, 0, 0}, {INFINITY, 0, 0, 0}})) {
      CHECK(answer.w == 0.0f);
      CHECK(std::isfinite(answer.x + answer.y));
    }
    for (const glm::vec4& answer : gpu.rays(map, {{1e30f, 1e30f, 0, 0}, {0, 0, 0, 0}}))
      CHECK(std::isfinite(answer.x + answer.y + answer.z));
  }
}
