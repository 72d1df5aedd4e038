// What opaque triangles hide: for each triangular piece how far the nearest one reaches that covers all of
// it, and for each group of pieces the farthest of its pieces. What lies behind is never seen, so it need not
// be cut, sent or drawn; the picture is the same without it. All members but reset() are thread-safe; a
// reader may see a value a moment old, which hides less, never more. Pure, no GL.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "renderer/passes/piece_table.h"

namespace cupola::passes {

class Occlusion {
public:
  /// Forgets everything; from now on for these pieces, which must outlive it.
  void reset(const PieceTable& pieces);

  /// Depths are w of the piece's own projection: nothing of a part whose least w is `nearest` is seen there.
  [[nodiscard]] bool hides(std::uint32_t piece, float nearest) const {
    return nearest > depths_[piece].load(std::memory_order_relaxed);
  }
  /// Nothing at this distance from the eye (metres) or beyond is seen in any piece of the group.
  [[nodiscard]] bool hides_in_group(std::uint32_t group, float distance) const {
    return distance > group_reaches_[group].load(std::memory_order_relaxed);
  }
  /// Whether an opaque triangle covers all of the piece.
  [[nodiscard]] bool covers(std::uint32_t piece) const;

  /// An opaque triangle covers all of the piece, nowhere deeper than `depth` (w) and `distance` (metres).
  void cover(std::uint32_t piece, float depth, float distance);

private:
  using Values = std::unique_ptr<std::atomic<float>[]>;
  [[nodiscard]] float farthest_in(std::uint32_t group) const;

  const PieceTable* pieces_ = nullptr;
  Values depths_, reaches_, group_reaches_;
  std::size_t piece_room_ = 0, group_room_ = 0;
};

} // namespace cupola::passes
