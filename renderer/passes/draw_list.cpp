#include "renderer/passes/draw_list.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <tuple>

namespace cupola::passes {

namespace {

/// Shells double in distance; within one, the order does not matter to hiding.
int shell(float distance) { return distance < 1.0f ? 0 : static_cast<int>(std::log2(distance)) + 1; }

/// Positions of a scene's corners by their place in the index list, moving ones from the pose.
class Corners {
public:
  Corners(const content::Scene& scene, std::span<const content::Vertex> moving)
      : scene_(scene)
      , moving_(moving) {}
  [[nodiscard]] const glm::vec3& operator[](std::uint32_t corner) const {
    const std::uint32_t index = scene_.geometry.indices[corner];
    return index < scene_.static_vertices || moving_.empty()
               ? scene_.geometry.vertices[index].position
               : moving_[index - scene_.static_vertices].position;
  }

private:
  const content::Scene& scene_;
  std::span<const content::Vertex> moving_;
};

/// No point of the cluster is nearer to the eye. By its sphere; around the eye (a sky, a wide ground) by the
/// spheres of its triangles.
float nearest_of(const content::Cluster& cluster, const Corners& corners, const glm::vec3& eye) {
  const float distance = glm::distance(cluster.center, eye) - cluster.radius;
  if (distance > 0.0f) return distance;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3) {
    const glm::vec3 centre = (corners[i] + corners[i + 1] + corners[i + 2]) / 3.0f;
    const float radius = std::max({glm::distance(corners[i], centre), glm::distance(corners[i + 1], centre),
                                   glm::distance(corners[i + 2], centre)});
    nearest = std::min(nearest, glm::distance(centre, eye) - radius);
  }
  return std::max(0.0f, nearest);
}

struct BlendedTriangle {
  float distance;
  std::uint32_t first_index;
  std::uint32_t material;
};

void order_blended(const content::Geometry& geometry, std::span<const content::Cluster> clusters,
                   const Corners& corners, const glm::vec3& eye, DrawList& out) {
  std::vector<BlendedTriangle> triangles;
  for (const content::Cluster& cluster : clusters)
    for (std::uint32_t i = 0; i < cluster.index_count; i += 3) {
      const std::uint32_t first = cluster.first_index + i;
      const glm::vec3 centre = (corners[first] + corners[first + 1] + corners[first + 2]) / 3.0f;
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
  const Corners corners(scene, moving);
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
    keys.push_back({shell(nearest_of(*it, corners, eye)), it->material,
                    static_cast<std::size_t>(it - clusters.begin())});
  }
  std::sort(keys.begin(), keys.end());
  for (const Key& key : keys) {
    const content::Cluster& cluster = clusters[key.cluster];
    out.opaque.push_back(
        {cluster.material, cluster.first_index, cluster.index_count, cluster.center, cluster.radius});
  }
  if (first_blended == clusters.end()) return;
  out.blended_first = first_blended->first_index;
  order_blended(scene.geometry, {first_blended, clusters.end()}, corners, eye, out);
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
