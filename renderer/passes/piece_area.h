// What lies around the scene in a viewport of triangular pieces: pixels that its projection does not show
// keep what they had, where no piece is fit to draw the cubemap is looked up, and what the scene leaves free
// gets the background. Render thread only.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

#include "configs/model/problem.h"
#include "renderer/gl/handle.h"
#include "renderer/passes/occlusion.h"
#include "renderer/passes/targets.h"
#include "renderer/plan/plan.h"

namespace cupola::passes {

class PieceArea {
public:
  struct Programs {
    gl::Program unshown, flat, lookup;
  };
  [[nodiscard]] static model::Result<Programs> make_programs();

  explicit PieceArea(const plan::PieceSet& set);

  /// Clears the current GL viewport and scissor for the scene: depth, and the background's colour where all
  /// of it is shown. Afterwards the scene is drawn with reversed depth, and hides nothing that is looked up.
  /// `cubemap`: where set.looked_up is not empty.
  void prepare(const Programs& programs, const projection::Map& map, const glm::vec3& background,
               const CubemapTarget* cubemap) const;

  /// The background, behind everything that has been drawn since prepare(). `occlusion`: pieces that it
  /// covers are left out; null: none.
  void draw_background(const Programs& programs, const glm::vec3& background,
                       const Occlusion* occlusion) const;

private:
  struct Part {
    GLint first = 0;
    GLsizei count = 0; ///< corners
  };
  void draw(const Part& part) const;

  bool fills_; ///< the background is cleared, not drawn
  Part all_, rim_, looked_up_;
  gl::Buffer corners_;
  gl::VertexArray array_;
};

} // namespace cupola::passes
