// Draws the scene through perspectives: one for the whole draw, six layers of a cubemap, or the pieces of a
// viewport by either engine. The framebuffer, viewport and scissor are the caller's. Render thread only.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <span>
#include <vector>

#include "renderer/gl/handle.h"
#include "renderer/passes/cells.h"
#include "renderer/passes/distribute.h"
#include "renderer/passes/draw_list.h"
#include "renderer/passes/gpu_scene.h"
#include "renderer/passes/scene_programs.h"

namespace cupola::passes {

/// The scene as it is this frame.
struct FrameScene {
  GpuScene& gpu;
  const DrawList& list;
  FrameGeometry geometry;
  glm::vec3 eye;
  glm::mat3 view_from_world;
  float near;
  model::StyleKind style;
  bool lights;
  bool shades_uncovered;   ///< see FrameVariant
  bool primitives = false; ///< see FrameVariant

  /// Corners must keep their own barycentric coordinates: nothing is shared.
  [[nodiscard]] bool edges() const { return primitives || style == model::StyleKind::wireframe; }
};

/// Work done, for statistics.
struct DrawCounts {
  std::uint64_t triangles = 0; ///< sent to the rasteriser
  std::uint64_t pairs = 0;     ///< (triangle, piece) pairs of the piecewise method that are drawn
  std::uint64_t bytes = 0;     ///< of buffers that the engine keeps
  DrawCounts& operator+=(const DrawCounts& other) {
    triangles += other.triangles;
    pairs += other.pairs;
    bytes += other.bytes;
    return *this;
  }
};

/// Sets what all scene draws share: reversed depth, face culling. Call once per frame and after other passes.
void set_scene_state();

/// Buffers that the GPU fills or reads in a ring, so that writing never waits for drawing.
class StreamBuffer {
public:
  /// Memory for `bytes`, mapped for writing; grows when needed. Valid until the next call of finish().
  [[nodiscard]] std::byte* begin(std::size_t bytes);
  [[nodiscard]] GLuint id() const { return segments_[current_].buffer.id(); }
  /// After the draws that read it have been issued.
  void finish();
  [[nodiscard]] std::size_t bytes() const;

private:
  struct Segment {
    gl::Buffer buffer;
    std::size_t size = 0;
    std::byte* mapped = nullptr;
    gl::Fence fence;
  };
  std::array<Segment, 3> segments_;
  std::size_t current_ = 0;
};

class ScenePass {
public:
  explicit ScenePass(ScenePrograms& programs);

  /// One perspective. `style_scale`: target pixels per output pixel. Items outside the view are culled.
  DrawCounts draw_direct(const FrameScene& scene, const glm::dmat3& to_screen, float style_scale);

  /// Layers of a layered framebuffer, `layers` naming those drawn; to_screen by layer number.
  DrawCounts draw_layered(const FrameScene& scene, const std::array<glm::dmat3, 6>& to_screen,
                          std::span<const int> layers, float style_scale);

  /// Strips by the CPU engine, into the current GL viewport; `scale`: target pixels per output pixel. The
  /// scissor is left undefined. Large scenes go through in portions, so that memory stays bounded by about
  /// `max_pairs` pairs and nothing is ever missing.
  DrawCounts draw_strips_cpu(const FrameScene& scene, const plan::PieceSet& set,
                             const StripAzimuths& azimuths, std::uint64_t max_pairs, int scale);

  /// Triangular pieces by the CPU engine, into the current GL viewport and scissor. `occlusion` is the
  /// viewport's own. `background` is called when all that is opaque has been drawn, before the blended.
  DrawCounts draw_cells_cpu(const FrameScene& scene, const PieceTable& pieces, Occlusion& occlusion,
                            std::uint64_t max_pairs, int scale, const std::function<void()>& background);

  void bind_program(const FrameScene& scene, VertexPath path, std::uint32_t material, float style_scale,
                    std::span<const glm::mat3> to_screen, std::span<const int> layers);

private:
  /// What direct and layered draws fetch vertices from; true: by number, from storage buffers 0 and 1.
  bool bind_geometry(const FrameScene& scene) const;
  DrawCounts draw_items(const FrameScene& scene, std::span<const DrawItem> items, const glm::dmat3& to_screen,
                        float style_scale);
  struct StripTarget {
    int scale;
    int group_size;              ///< strips of one draw
    std::vector<GLint> scissors; ///< x, y, width, height of each strip
  };
  DrawCounts draw_batches(const FrameScene& scene, const std::vector<EmittedBatch>& batches,
                          const StripTarget& target);
  /// Calls distribute(items) and draws what it leaves in `batches_`, portion by portion.
  template <class F>
  DrawCounts draw_distributed(const FrameScene& scene, std::span<const DrawItem> items,
                              std::uint64_t max_pairs, const StripTarget& target, const F& distribute);
  /// Copies the vertices of all batches; where each batch's first one is.
  std::vector<std::size_t> upload_vertices(const std::vector<EmittedBatch>& batches);

  ScenePrograms& programs_;
  gl::VertexArray emitted_array_, empty_array_;
  StreamBuffer emitted_vertices_, emitted_indices_;
  std::vector<EmittedBatch> batches_;
  std::vector<DrawItem> visible_;
};

} // namespace cupola::passes
