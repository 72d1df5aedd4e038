// The CPU engine for triangular pieces: triangles are cut to the pieces they touch and projected there, on
// all cores [Lorenz & Döllner, sec. 2.1, without replicating what a piece does not show]. Pure, no GL.
//
// Found in two steps: a cluster's sphere against the tree of cones, then each triangle's pyramid of three
// planes through the eye against the groups that are left. Both pyramids are convex, so the planes of either
// decide exactly whether they meet. Cutting is done in a piece's own barycentric coordinates, where its
// borders are b = 0: what lies on a border lands on it exactly, and so does its neighbour's share.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/passes/draw_list.h"
#include "renderer/passes/emitted.h"
#include "renderer/passes/occlusion.h"
#include "renderer/passes/piece_table.h"

namespace cupola::passes {

struct CellView {
  const PieceTable& pieces;
  glm::vec3 eye;
  glm::mat3 view_from_world;
  float near;
  bool edges; ///< corners must keep their own barycentric coordinates (wireframe): nothing is shared
};

/// Distributes everything in the list; batches stand in drawing order and reuse their memory. Portions have
/// group 0. `occlusion` is read, and written by opaque triangles; it belongs to view.pieces. Which hidden
/// parts are left out depends on the threads, what is seen does not.
void distribute_cells(const FrameGeometry& geometry, std::span<const DrawItem> items, const CellView& view,
                      Occlusion& occlusion, std::vector<EmittedBatch>& batches);

} // namespace cupola::passes
