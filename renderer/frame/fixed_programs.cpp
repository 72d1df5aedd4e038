#include "renderer/frame/fixed_programs.h"

#include "renderer/gl/shader.h"
#include "renderer/passes/piece_lines.h"

namespace cupola::frame {

model::Result<FixedPrograms> build_fixed() {
  const gl::Stage fullscreen{GL_VERTEX_SHADER, "renderer/passes/fullscreen.vert.glsl"};
  auto downsample = gl::build_program(
      {"downsample", {fullscreen, {GL_FRAGMENT_SHADER, "renderer/passes/downsample.frag.glsl"}}, {}});
  auto picture = gl::build_program(
      {"picture", {fullscreen, {GL_FRAGMENT_SHADER, "renderer/passes/picture.frag.glsl"}}, {}});
  auto piece_lines = passes::PieceLines::make_program();
  auto area = passes::PieceArea::make_programs();
  model::Problems problems;
  for (const auto* result : {&downsample, &picture, &piece_lines})
    if (!*result) problems.insert(problems.end(), result->error().begin(), result->error().end());
  if (!area) problems.insert(problems.end(), area.error().begin(), area.error().end());
  if (!problems.empty()) return tl::unexpected(problems);
  return FixedPrograms{std::move(*downsample), std::move(*picture), std::move(*piece_lines),
                       std::move(*area)};
}

} // namespace cupola::frame
