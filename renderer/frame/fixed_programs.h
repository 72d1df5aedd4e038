// The programs that do not depend on the scene, built once.
#pragma once

#include "configs/model/problem.h"
#include "renderer/gl/handle.h"
#include "renderer/passes/piece_area.h"

namespace cupola::frame {

struct FixedPrograms {
  gl::Program downsample, picture, piece_lines;
  passes::PieceArea::Programs area;
};

/// Render thread. Fails when one does not compile.
[[nodiscard]] model::Result<FixedPrograms> build_fixed();

} // namespace cupola::frame
