// The GPU engine: primitives are counted, scanned, emitted and drawn without the CPU ever reading back
// [Lorenz & Döllner, sec. 2.1, in terms of compute shaders]. Render thread only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "renderer/gl/handle.h"
#include "renderer/passes/piece_table.h"
#include "renderer/passes/scene_pass.h"
#include "renderer/passes/strip_range.h"

namespace cupola::passes {

/// How far triangular pieces reach over each other's borders, in pixels: nothing opens between them where a
/// pixel's centre, or another place at which it is sampled, lies on a border. Blended materials do without:
/// there they would show twice.
inline constexpr double piece_overlap = 1.0 / 64.0;

/// By how much of w the planes of a triangular piece are to be moved for `piece_overlap`, or for a twentieth
/// of the piece where it is narrower than 20 of them. `pixels`: the size of what the piece is drawn into.
[[nodiscard]] glm::dvec3 overlap_shares(const plan::PieceSet& set, std::size_t piece,
                                        const glm::dvec2& pixels);

/// The pieces of one viewport and the lists of pairs that are kept for it.
class GpuPieces {
public:
  struct Programs {
    struct Binning {
      gl::Program count, emit;
    };
    Binning strips, triangles;
    gl::Program offsets;
  };
  /// Fails when the driver refuses a compute shader.
  [[nodiscard]] static model::Result<Programs> make_programs();

  GpuPieces();

  void load_strips(const plan::PieceSet& set, const StripAzimuths& azimuths);
  /// `pixels`: the size of what they are drawn into.
  void load_triangles(const plan::PieceSet& set, const PieceTable& table, const glm::dvec2& pixels);

  /// Draws the pieces loaded last, into the current GL viewport. A list that cannot hold all pairs is filled
  /// and drawn several times in the frame, each time with the pairs that follow; what even that leaves out is
  /// drawn as all its triangles in all pieces, so nothing is missing. It has grown by the next frames, up to
  /// `max_pairs`. Counts are those of an earlier frame: reading them does not wait.
  DrawCounts draw(const Programs& programs, ScenePass& pass, const FrameScene& scene, std::uint64_t max_pairs,
                  float style_scale);

private:
  /// One ordered list: the opaque or the blended one.
  struct List {
    gl::Buffer clusters, runs, offsets, counts, commands, pairs, control, read_back;
    std::size_t cluster_count = 0, run_count = 0;
    std::uint64_t pair_capacity = 0;
    std::uint32_t rounds = 1; ///< times that it is filled in a frame
    std::uint64_t last_total = 0;
    gl::Fence fence;
    const std::uint32_t* mapped = nullptr;
  };
  void load_pieces(const plan::PieceSet& set, std::span<const glm::dvec3> overlaps);
  void draw_list(const Programs& programs, ScenePass& pass, const FrameScene& scene,
                 std::span<const DrawItem> items, List& list, std::uint64_t max_pairs, float style_scale);
  void make_room(List& list, std::uint64_t triangles, std::uint64_t max_pairs) const;
  static void upload(const FrameScene& scene, std::span<const DrawItem> items, const std::vector<Run>& runs,
                     List& list);
  void bind_buffers(const FrameScene& scene, const List& list) const;
  void draw_round(ScenePass& pass, const FrameScene& scene, const std::vector<Run>& runs, const List& list,
                  std::uint32_t round, float style_scale) const;

  bool strips_ = false;
  std::size_t piece_count_ = 0;
  gl::Buffer pieces_;
  gl::Buffer search_; ///< what finds pieces: borders of strips, or groups of triangles
  gl::Buffer rays_;   ///< of triangles
  glm::mat3 axes_from_view_{1.0f};
  bool full_turn_ = false;
  gl::VertexArray empty_array_;
  std::array<List, 2> lists_;
};

} // namespace cupola::passes
