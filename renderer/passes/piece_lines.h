// Borders of pieces as black lines, one output pixel wide, over a picture. Render thread only.
#pragma once

#include "configs/model/problem.h"
#include "renderer/gl/handle.h"
#include "renderer/plan/plan.h"

namespace cupola::passes {

class PieceLines {
public:
  [[nodiscard]] static model::Result<gl::Program> make_program();

  /// `viewport`: the rect that the pieces stand in; `scale`: target pixels per output pixel.
  PieceLines(const plan::PieceSet& set, const plan::PixelRect& viewport, int scale);

  /// Into the current GL viewport and scissor. The depth test is on afterwards, as for the scene.
  void draw(const gl::Program& program) const;

private:
  int scale_;
  GLsizei count_ = 0; ///< ends of lines
  gl::Buffer ends_;
  gl::VertexArray array_;
};

} // namespace cupola::passes
