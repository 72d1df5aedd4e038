#include "renderer/passes/draw_list.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

namespace cupola::passes {

namespace {

/// Shells double in distance; within one, the order does not matter to hiding.
int shell(float distance) { return distance < 1.0f ? 0 : static_cast<int>(std::log2(distance)) + 1; }

struct BlendedTriangle {
  float distance;
  std::uint32_t first_index;
  std::uint32_t material;
};

void order_blended(const content::Scene& scene, std::span<const content::Cluster> clusters,
                   std::span<const content::Vertex> moving, const glm::vec3& eye, DrawList& out) {
  const content::Geometry& geometry = scene.geometry;
  const auto position = [&](std::uint32_t corner) {
    const std::uint32_t index = geometry.indices[corner];
    return index < scene.static_vertices || moving.empty() ? geometry.vertices[index].position
                                                           : moving[index - scene.static_vertices].position;
  };
  std::vector<BlendedTriangle> triangles;
  for (const content::Cluster& cluster : clusters)
    for (std::uint32_t i = 0; i < cluster.index_count; i += 3) {
      const std::uint32_t first = cluster.first_index + i;
      const glm::vec3 centre = (position(first) + position(first + 1) + position(first + 2)) / 3.0f;
      triangles.push_back({glm::distance(centre, eye), first, cluster.material});
    }
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const auto& a, const auto& b) { return a.distance > b.distance; });
  for (const BlendedTriangle& triangle : triangles) {
    const auto at = out.blended_first + static_cast<std::uint32_t>(out.blended_indices.size());
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      out.blended_indices.push_back(geometry.indices[triangle.first_index + corner]);
    // Stretches stay short enough to be work for several cores and work groups.
    const bool joins = !out.blended.empty() && out.blended.back().material == triangle.material &&
                       out.blended.back().index_count < 3 * 256;
    if (joins)
      out.blended.back().index_count += 3;
    else
      out.blended.push_back({triangle.material, at, 3});
  }
}

} // namespace

void order_for_eye(const content::Scene& scene, std::span<const content::Cluster> clusters,
                   std::span<const content::Vertex> moving, const glm::vec3& eye, DrawList& out) {
  out.opaque.clear();
  out.blended.clear();
  out.blended_indices.clear();
  const auto is_blended = [&](const content::Cluster& cluster) {
    return scene.materials[cluster.material].alpha_mode == content::AlphaMode::blend;
  };
  const auto first_blended = std::find_if(clusters.begin(), clusters.end(), is_blended);

  struct Key {
    int shell;
    std::uint32_t material;
    std::size_t cluster;
    bool operator<(const Key& other) const {
      return std::tie(shell, material, cluster) < std::tie(other.shell, other.material, other.cluster);
    }
  };
  std::vector<Key> keys;
  keys.reserve(clusters.size());
  for (auto it = clusters.begin(); it != first_blended; ++it) {
    const float distance = std::max(0.0f, glm::distance(it->center, eye) - it->radius);
    keys.push_back({shell(distance), it->material, static_cast<std::size_t>(it - clusters.begin())});
  }
  std::sort(keys.begin(), keys.end());
  for (const Key& key : keys) {
    const content::Cluster& cluster = clusters[key.cluster];
    out.opaque.push_back(
        {cluster.material, cluster.first_index, cluster.index_count, cluster.center, cluster.radius});
  }
  if (first_blended == clusters.end()) return;
  out.blended_first = first_blended->first_index;
  order_blended(scene, {first_blended, clusters.end()}, moving, eye, out);
}

std::vector<Run> join_runs(std::span<const DrawItem> items) {
  std::vector<Run> runs;
  for (const DrawItem& item : items) {
    if (!runs.empty() && runs.back().material == item.material &&
        runs.back().first_index + runs.back().index_count == item.first_index)
      runs.back().index_count += item.index_count;
    else
      runs.push_back({item.material, item.first_index, item.index_count});
  }
  return runs;
}

} // namespace cupola::passes
