#include "renderer/passes/emitted.h"

#include <algorithm>

namespace cupola::passes {

std::uint32_t pack_normal(const glm::vec3& normal) {
  const auto part = [](float x) {
    const float step = std::clamp(x, -1.0f, 1.0f) * 511.0f;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(step + (step < 0.0f ? -0.5f : 0.5f))) & 1023u;
  };
  return part(normal.x) | part(normal.y) << 10 | part(normal.z) << 20;
}

std::vector<std::span<const DrawItem>> split_items(std::span<const DrawItem> items, std::uint32_t indices) {
  std::vector<std::span<const DrawItem>> portions;
  std::size_t begin = 0;
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    sum += items[i].index_count;
    if (sum >= indices || i + 1 == items.size()) {
      portions.push_back(items.subspan(begin, i + 1 - begin));
      begin = i + 1;
      sum = 0;
    }
  }
  return portions;
}

} // namespace cupola::passes
