#include "renderer/passes/piece_area.h"

#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "renderer/gl/shader.h"
#include "renderer/passes/lookup_pass.h"

namespace cupola::passes {

namespace {

constexpr GLint location_depth = 0, location_color = 1;

/// In front of all that a scene can be, and behind it: reversed depth.
void set_depth(const gl::Program& program, float depth) {
  glProgramUniform1f(program.id(), location_depth, depth);
}

} // namespace

model::Result<PieceArea::Programs> PieceArea::make_programs() {
  const gl::Stage area{GL_VERTEX_SHADER, "renderer/passes/area.vert.glsl"};
  const auto build = [&area](const char* label, const char* fragment) {
    return gl::build_program({label, {area, {GL_FRAGMENT_SHADER, fragment}}, {}});
  };
  auto unshown = build("unshown pixels", "renderer/passes/unshown.frag.glsl");
  auto flat = build("background", "renderer/passes/flat.frag.glsl");
  auto lookup = build("lookup of an area", "renderer/passes/lookup.frag.glsl");
  model::Problems problems;
  for (const auto* result : {&unshown, &flat, &lookup})
    if (!*result) problems.insert(problems.end(), result->error().begin(), result->error().end());
  if (!problems.empty()) return tl::unexpected(problems);
  return Programs{std::move(*unshown), std::move(*flat), std::move(*lookup)};
}

PieceArea::PieceArea(const plan::PieceSet& set)
    : fills_(set.fills)
    , corners_(gl::Buffer::make())
    , array_(gl::VertexArray::make()) {
  std::vector<glm::vec2> corners;
  const auto add = [&](const std::array<std::uint32_t, 3>& triangle) {
    for (const std::uint32_t corner : triangle) corners.emplace_back(set.corners[corner].screen);
  };
  const auto close = [&](Part& part) { part.count = static_cast<GLsizei>(corners.size()) - part.first; };
  if (!fills_)
    for (const auto& triangle : set.triangles) add(triangle);
  close(all_);
  rim_.first = all_.count;
  for (std::size_t i = 0; i < set.triangles.size(); ++i)
    if (set.shown[i] == plan::Shown::some) add(set.triangles[i]);
  close(rim_);
  looked_up_.first = rim_.first + rim_.count;
  for (const auto& triangle : set.looked_up)
    for (const glm::dvec2& corner : triangle) corners.emplace_back(corner);
  close(looked_up_);
  glNamedBufferData(corners_.id(), static_cast<GLsizeiptr>(corners.size() * sizeof(glm::vec2)),
                    corners.data(), GL_STATIC_DRAW);
  glEnableVertexArrayAttrib(array_.id(), 0);
  glVertexArrayAttribFormat(array_.id(), 0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array_.id(), 0, 0);
  glVertexArrayVertexBuffer(array_.id(), 0, corners_.id(), 0, sizeof(glm::vec2));
}

void PieceArea::draw(const Part& part) const {
  glBindVertexArray(array_.id());
  glDrawArrays(GL_TRIANGLES, part.first, part.count);
}

void PieceArea::prepare(const Programs& programs, const projection::Map& map, const glm::vec3& background,
                        const CubemapTarget* cubemap) const {
  glClearColor(background.r, background.g, background.b, 1.0f);
  glClearDepth(0.0);
  glClear(fills_ ? GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT : GL_DEPTH_BUFFER_BIT);
  glDisable(GL_CULL_FACE);
  glDepthFunc(GL_GEQUAL);
  if (rim_.count > 0) {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glUseProgram(programs.unshown.id());
    set_map(map);
    set_depth(programs.unshown, 1.0f);
    draw(rim_);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  if (looked_up_.count > 0 && cubemap != nullptr) {
    glUseProgram(programs.lookup.id());
    set_map(map);
    set_depth(programs.lookup, 1.0f);
    glBindTextureUnit(0, cubemap->texture());
    glBindSampler(0, 0);
    draw(looked_up_);
  }
  glEnable(GL_CULL_FACE);
}

void PieceArea::draw_background(const Programs& programs, const glm::vec3& background,
                                const Occlusion* occlusion) const {
  std::vector<GLint> firsts;
  std::vector<GLsizei> counts;
  for (GLint corner = 0; corner < all_.count; corner += 3) {
    if (occlusion != nullptr && occlusion->covers(static_cast<std::uint32_t>(corner / 3))) continue;
    if (!firsts.empty() && firsts.back() + counts.back() == corner) {
      counts.back() += 3;
    } else {
      firsts.push_back(corner);
      counts.push_back(3);
    }
  }
  if (firsts.empty()) return;
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glUseProgram(programs.flat.id());
  glProgramUniform3fv(programs.flat.id(), location_color, 1, glm::value_ptr(background));
  set_depth(programs.flat, 0.0f);
  glBindVertexArray(array_.id());
  glMultiDrawArrays(GL_TRIANGLES, firsts.data(), counts.data(), static_cast<GLsizei>(firsts.size()));
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
}

} // namespace cupola::passes
