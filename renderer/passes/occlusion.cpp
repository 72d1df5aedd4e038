#include "renderer/passes/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cupola::passes {

namespace {

constexpr float nowhere = std::numeric_limits<float>::infinity();

/// Whether `value` was lower and has been stored.
bool lower(std::atomic<float>& stored, float value) {
  float before = stored.load(std::memory_order_relaxed);
  while (value < before)
    if (stored.compare_exchange_weak(before, value, std::memory_order_relaxed)) return true;
  return false;
}

} // namespace

void Occlusion::reset(const PieceTable& pieces) {
  pieces_ = &pieces;
  const auto clear = [](Values& values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values[i].store(nowhere, std::memory_order_relaxed);
  };
  const std::size_t piece_count = pieces.pieces().size(), group_count = pieces.groups().size();
  if (piece_room_ < piece_count) {
    depths_ = std::make_unique<std::atomic<float>[]>(piece_count);
    reaches_ = std::make_unique<std::atomic<float>[]>(piece_count);
    piece_room_ = piece_count;
  }
  if (group_room_ < group_count) {
    group_reaches_ = std::make_unique<std::atomic<float>[]>(group_count);
    group_room_ = group_count;
  }
  clear(depths_, piece_count);
  clear(reaches_, piece_count);
  clear(group_reaches_, group_count);
}

bool Occlusion::covers(std::uint32_t piece) const {
  return depths_[piece].load(std::memory_order_relaxed) < nowhere;
}

float Occlusion::farthest_in(std::uint32_t group) const {
  const PieceTable::Group& of = pieces_->groups()[group];
  float farthest = 0.0f;
  if (of.is_leaf(group)) {
    for (std::uint32_t i = of.first; i < of.first + of.count; ++i)
      farthest = std::max(farthest, reaches_[i].load(std::memory_order_relaxed));
    return farthest;
  }
  const std::uint32_t left = group + 1, right = pieces_->groups()[left].next;
  return std::max(group_reaches_[left].load(std::memory_order_relaxed),
                  group_reaches_[right].load(std::memory_order_relaxed));
}

void Occlusion::cover(std::uint32_t piece, float depth, float distance) {
  lower(depths_[piece], depth);
  if (!lower(reaches_[piece], distance)) return;
  for (std::uint32_t group = pieces_->pieces()[piece].leaf; group != PieceTable::no_group;
       group = pieces_->groups()[group].parent)
    if (!lower(group_reaches_[group], farthest_in(group))) return;
}

} // namespace cupola::passes
