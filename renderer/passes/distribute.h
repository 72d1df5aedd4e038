// The CPU engine: triangles are distributed to the strips they touch and projected there, on all cores
// [Lorenz & Döllner, sec. 2.1 and 3.1]. Nothing is cut: each strip has a scissor of its own pixels, so a
// pixel belongs to one strip alone and no seam can open, and no edge is added that the scene does not have.
// Pure, no GL.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/passes/draw_list.h"
#include "renderer/passes/emitted.h"
#include "renderer/passes/strip_range.h"
#include "renderer/plan/plan.h"

namespace cupola::passes {

struct StripView {
  const plan::PieceSet& set;
  const StripAzimuths& azimuths;
  glm::vec3 eye;
  glm::mat3 view_from_world;
  float near;
  int group_size; ///< strips drawn together, each with a scissor of its own
  bool edges;     ///< corners must keep their own barycentric coordinates (wireframe): nothing is shared
};

/// Distributes everything in the list; batches stand in drawing order and reuse their memory.
void distribute_strips(const FrameGeometry& geometry, std::span<const DrawItem> items, const StripView& view,
                       std::vector<EmittedBatch>& batches);

} // namespace cupola::passes
