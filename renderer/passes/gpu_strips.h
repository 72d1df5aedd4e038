// The GPU engine: primitives are counted, scanned, emitted and drawn without the CPU ever reading back
// [Lorenz & Döllner, sec. 2.1, in terms of compute shaders]. Render thread only.
#pragma once

#include <vector>

#include "renderer/gl/handle.h"
#include "renderer/passes/scene_pass.h"
#include "renderer/passes/strip_range.h"

namespace cupola::passes {

class GpuStrips {
public:
  /// Fails when the driver refuses a compute shader.
  [[nodiscard]] static model::Result<GpuStrips> make();

  /// Draws the strips of a viewport. When the list of pairs is too short in this frame, the same draw falls
  /// back to all triangles in all strips, so nothing is missing; the list has grown by the next frames, up
  /// to `max_pairs`. Counts are those of an earlier frame: reading them does not wait.
  DrawCounts draw(ScenePass& pass, const FrameScene& scene, const plan::PieceSet& set,
                  const StripAzimuths& azimuths, std::uint64_t max_pairs, float style_scale);

private:
  GpuStrips() = default;
  /// One ordered list: the opaque or the blended one.
  struct List {
    gl::Buffer clusters, runs, offsets, commands, pairs, control, read_back;
    std::size_t cluster_count = 0, run_count = 0;
    std::uint64_t pair_capacity = 0;
    std::uint64_t last_total = 0;
    gl::Fence fence;
    const std::uint32_t* mapped = nullptr;
  };
  void draw_list(ScenePass& pass, const FrameScene& scene, std::span<const DrawItem> items, List& list,
                 std::size_t strips, std::uint64_t max_pairs, float style_scale);
  void upload(const FrameScene& scene, std::span<const DrawItem> items, const std::vector<Run>& runs,
              List& list);
  void collect_total(List& list);

  gl::Program count_, offsets_, emit_;
  gl::Buffer pieces_, borders_;
  gl::VertexArray empty_array_;
  std::array<List, 2> lists_;
};

} // namespace cupola::passes
