// What the CPU engines produce: triangles on the screen, in portions by material; and what they read. Pure,
// no GL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/passes/draw_list.h"

namespace cupola::passes {

/// 52 bytes, as the EMITTED vertex program reads it.
struct EmittedVertex {
  glm::vec4 position;   ///< x, y and w in clip space of the viewport; z: the strip's scissor within its group
  glm::vec3 offset;     ///< from the eye, world axes, metres
  std::uint32_t normal; ///< 2_10_10_10_REV, signed normalised
  glm::vec2 uv;
  std::uint32_t color;
  glm::vec2 corner; ///< barycentric coordinates of corners 0 and 1 in the scene's triangle
};

/// Triangles of one material in one group of strips.
struct EmittedPortion {
  std::uint32_t material = 0;
  std::uint32_t run = 0; ///< drawn in rising order over all batches; equal ones have one material
  std::uint32_t group = 0;
  std::uint32_t first_index = 0, index_count = 0;
};

/// What one task produced. Indices count from the task's own first vertex.
struct EmittedBatch {
  std::vector<EmittedVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<EmittedPortion> portions;
  std::uint64_t pairs = 0;  ///< (triangle, piece), found
  std::uint64_t hidden = 0; ///< of them, left out behind an opaque triangle

  void clear();
  /// Moves indices of one material and group here as a portion; none where there are none.
  void take(std::vector<std::uint32_t>& from, std::uint32_t material, std::uint32_t run, std::uint32_t group);
};

/// Geometry as it is this frame: moving vertices come from the pose, blended triangles stand in today's
/// order.
struct FrameGeometry {
  std::span<const content::Vertex> still;  ///< vertices [0, still.size())
  std::span<const content::Vertex> moving; ///< vertices from still.size() on
  std::span<const std::uint32_t> indices;  ///< the scene's
  struct {
    std::span<const std::uint32_t> indices; ///< replace the scene's from `first` on
    std::uint32_t first = 0;
  } blended;
  std::span<const content::Material> materials;
  [[nodiscard]] const content::Vertex& vertex(std::uint32_t index) const {
    return index < still.size() ? still[index] : moving[index - still.size()];
  }
  [[nodiscard]] std::uint32_t index(std::uint32_t at) const {
    return blended.indices.empty() || at < blended.first ? indices[at] : blended.indices[at - blended.first];
  }
};

/// Shells of depth, `per_octave` from a metre on: opaque triangles of nearer ones are drawn earlier, so that
/// little is shaded in vain.
inline constexpr std::size_t depth_shells = 32;
[[nodiscard]] std::size_t depth_shell(float depth, float per_octave);

/// As the vertex program reads it: 2_10_10_10_REV, signed normalised.
[[nodiscard]] std::uint32_t pack_normal(const glm::vec3& normal);

/// The colour of a point of a triangle; weights sum to 1.
[[nodiscard]] std::uint32_t mix_color(const std::array<const content::Vertex*, 3>& of,
                                      const glm::vec3& weights);

/// Work for one task: neighbours in a list of items.
struct TaskItems {
  std::span<const DrawItem> items;
  std::uint32_t first_run; ///< how often the material has changed before the first of them
};

/// The items in portions of about `indices` indices, in order.
[[nodiscard]] std::vector<TaskItems> split_items(std::span<const DrawItem> items, std::uint32_t indices);

} // namespace cupola::passes
