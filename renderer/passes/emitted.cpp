#include "renderer/passes/emitted.h"

#include <algorithm>
#include <cmath>

namespace cupola::passes {

void EmittedBatch::clear() {
  vertices.clear();
  indices.clear();
  portions.clear();
  pairs = hidden = 0;
}

void EmittedBatch::take(std::vector<std::uint32_t>& from, std::uint32_t material, std::uint32_t run,
                        std::uint32_t group) {
  if (from.empty()) return;
  portions.push_back({material, run, group, static_cast<std::uint32_t>(indices.size()),
                      static_cast<std::uint32_t>(from.size())});
  indices.insert(indices.end(), from.begin(), from.end());
  from.clear();
}

std::size_t depth_shell(float depth, float per_octave) {
  if (!(depth > 1.0f)) return 0;
  const float shell = std::min(per_octave * std::log2(depth), static_cast<float>(depth_shells - 1));
  return static_cast<std::size_t>(shell);
}

std::uint32_t pack_normal(const glm::vec3& normal) {
  const auto part = [](float x) {
    const float step = std::clamp(x, -1.0f, 1.0f) * 511.0f;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(step + (step < 0.0f ? -0.5f : 0.5f))) & 1023u;
  };
  return part(normal.x) | part(normal.y) << 10 | part(normal.z) << 20;
}

std::uint32_t mix_color(const std::array<const content::Vertex*, 3>& of, const glm::vec3& weights) {
  if (of[0]->color == of[1]->color && of[1]->color == of[2]->color) return of[0]->color;
  std::uint32_t out = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    float sum = 0.5f;
    for (int i = 0; i < 3; ++i)
      sum += static_cast<float>(of[static_cast<std::size_t>(i)]->color >> shift & 255u) * weights[i];
    out |= static_cast<std::uint32_t>(std::clamp(sum, 0.0f, 255.0f)) << shift;
  }
  return out;
}

std::vector<TaskItems> split_items(std::span<const DrawItem> items, std::uint32_t indices) {
  std::vector<TaskItems> portions;
  std::size_t begin = 0;
  std::uint32_t sum = 0, run = 0, first_run = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0 && items[i].material != items[i - 1].material) ++run;
    if (i == begin) first_run = run;
    sum += items[i].index_count;
    if (sum >= indices || i + 1 == items.size()) {
      portions.push_back({items.subspan(begin, i + 1 - begin), first_run});
      begin = i + 1;
      sum = 0;
    }
  }
  return portions;
}

} // namespace cupola::passes
