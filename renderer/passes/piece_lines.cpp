#include "renderer/passes/piece_lines.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <set>
#include <utility>
#include <vector>

#include "renderer/gl/shader.h"

namespace cupola::passes {

namespace {

/// Ends of lines in normalised device coordinates, each border once: sides of triangles that two pieces have
/// in common, and between strips.
std::vector<glm::vec2> ends_of(const plan::PieceSet& set, const plan::PixelRect& viewport, int scale) {
  std::vector<glm::vec2> ends;
  if (set.strips) {
    for (std::size_t i = 1; i < set.pieces.size(); ++i) {
      // Through the middle of the target's column right of the border, so that rounding cannot move the line.
      const double x = set.pieces[i].bounds.x - viewport.x + 0.5 / scale;
      const auto s = static_cast<float>(2.0 * x / viewport.width - 1.0);
      ends.emplace_back(s, -1.0f);
      ends.emplace_back(s, 1.0f);
    }
    return ends;
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> drawn;
  for (const auto& t : set.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (!drawn.insert(std::minmax(a, b)).second) continue;
      ends.emplace_back(set.corners[a].screen);
      ends.emplace_back(set.corners[b].screen);
    }
  return ends;
}

} // namespace

model::Result<gl::Program> PieceLines::make_program() {
  return gl::build_program({"piece lines",
                            {{GL_VERTEX_SHADER, "renderer/passes/area.vert.glsl"},
                             {GL_FRAGMENT_SHADER, "renderer/passes/flat.frag.glsl"}},
                            {}});
}

PieceLines::PieceLines(const plan::PieceSet& set, const plan::PixelRect& viewport, int scale)
    : scale_(scale)
    , ends_(gl::Buffer::make())
    , array_(gl::VertexArray::make()) {
  const std::vector<glm::vec2> ends = ends_of(set, viewport, scale);
  count_ = static_cast<GLsizei>(ends.size());
  glNamedBufferData(ends_.id(), static_cast<GLsizeiptr>(ends.size() * sizeof(glm::vec2)), ends.data(),
                    GL_STATIC_DRAW);
  glEnableVertexArrayAttrib(array_.id(), 0);
  glVertexArrayAttribFormat(array_.id(), 0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array_.id(), 0, 0);
  glVertexArrayVertexBuffer(array_.id(), 0, ends_.id(), 0, sizeof(glm::vec2));
}

void PieceLines::draw(const gl::Program& program) const {
  constexpr GLint location_color = 1;
  if (count_ == 0) return;
  glDisable(GL_DEPTH_TEST);
  glUseProgram(program.id());
  glProgramUniform3f(program.id(), location_color, 0.0f, 0.0f, 0.0f);
  glBindVertexArray(array_.id());
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  for (int shift = 0; shift < scale_ * scale_; ++shift) { // wide lines are more than core profiles promise
    glViewport(viewport[0] + shift % scale_, viewport[1] + shift / scale_, viewport[2], viewport[3]);
    glDrawArrays(GL_LINES, 0, count_);
  }
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  glEnable(GL_DEPTH_TEST);
}

} // namespace cupola::passes
