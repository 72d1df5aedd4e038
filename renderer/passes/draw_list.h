// What is drawn this frame, in which order. One centre of projection: the order is the same for every face,
// piece and viewport. Pure, no GL.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::passes {

/// Neighbouring indices of one material, drawn together.
struct Run {
  std::uint32_t material = 0;
  std::uint32_t first_index = 0, index_count = 0;
};

/// A cluster, or a stretch of sorted blended triangles, with a bounding sphere.
struct DrawItem {
  std::uint32_t material = 0;
  std::uint32_t first_index = 0, index_count = 0;
  glm::vec3 center{0.0f}; ///< world
  float radius = -1.0f;   ///< negative: unknown, never culled
};

struct DrawList {
  std::vector<DrawItem> opaque;  ///< opaque and masked: roughly from near to far
  std::vector<DrawItem> blended; ///< from far to near
  /// Today's indices of the blended triangles; they replace the scene's from blended_first on.
  std::vector<std::uint32_t> blended_indices;
  std::uint32_t blended_first = 0;
};

/// Orders clusters for an eye at `eye`: opaque ones by shells of distance and then by material, so that near
/// things hide far ones and state changes stay few; blended triangles exactly, by the distance of their
/// centres.
void order_for_eye(const content::Scene& scene, std::span<const content::Cluster> clusters,
                   std::span<const content::Vertex> moving, const glm::vec3& eye, DrawList& out);

/// Joins neighbours of the same material.
[[nodiscard]] std::vector<Run> join_runs(std::span<const DrawItem> items);

} // namespace cupola::passes
