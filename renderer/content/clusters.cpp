#include "renderer/content/clusters.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace cupola::content {
namespace {

struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};
  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
};

class Splitter {
public:
  Splitter(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& triangles,
           std::size_t largest)
      : triangles_(triangles)
      , largest_(largest)
      , order_(triangles.size() / 3)
      , middles_(triangles.size() / 3) {
    std::iota(order_.begin(), order_.end(), 0U);
    for (std::size_t t = 0; t < middles_.size(); ++t) {
      Box box;
      for (std::size_t k = 0; k < 3; ++k) box.add(vertices[triangles[3 * t + k]].position);
      middles_[t] = box.low * 0.5f + box.high * 0.5f;
    }
  }

  /// Calls emit(first, last) for each part, in order; afterwards order() lists the triangles.
  template <class Emit>
  void split(std::size_t first, std::size_t last, const Emit& emit) {
    const std::size_t count = last - first;
    const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    if (count <= largest_) {
      std::sort(at(first), at(last)); // the order that the generator or file had
      emit(first, last);
      return;
    }
    Box box;
    for (std::size_t i = first; i < last; ++i) box.add(middles_[order_[i]]);
    const glm::vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.z >= size.y ? 2 : 1);
    const std::size_t parts = (count + largest_ - 1) / largest_;
    const std::size_t middle = first + count * (parts / 2) / parts;
    std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
      const float left = middles_[a][axis];
      const float right = middles_[b][axis];
      return left != right ? left < right : a < b;
    });
    split(first, middle, emit);
    split(middle, last, emit);
  }

  [[nodiscard]] std::uint32_t index(std::size_t place, std::size_t corner) const {
    return triangles_[3 * static_cast<std::size_t>(order_[place]) + corner];
  }
  [[nodiscard]] std::size_t count() const { return order_.size(); }

private:
  const std::vector<std::uint32_t>& triangles_;
  std::size_t largest_;
  std::vector<std::uint32_t> order_;
  std::vector<glm::vec3> middles_;
};

template <class Position>
void enclose(Cluster& cluster, std::span<const std::uint32_t> indices, const Position& position) {
  const auto own = indices.subspan(cluster.first_index, cluster.index_count);
  if (own.empty()) return;
  Box box;
  for (const std::uint32_t index : own) box.add(position(index));
  cluster.center = box.low * 0.5f + box.high * 0.5f;
  float farthest = 0.0f;
  for (const std::uint32_t index : own) {
    const glm::vec3 offset = position(index) - cluster.center;
    farthest = std::max(farthest, glm::dot(offset, offset));
  }
  cluster.radius = std::sqrt(farthest) * 1.000001f; // no vertex outside for rounding
}

} // namespace

void set_bounds(Cluster& cluster, std::span<const Vertex> vertices, std::span<const std::uint32_t> indices) {
  enclose(cluster, indices,
          [&](std::uint32_t index) -> const glm::vec3& { return vertices[index].position; });
}

void set_moving_bounds(const Geometry& geometry, std::uint32_t static_vertices, std::span<const Vertex> moved,
                       Cluster& cluster) {
  enclose(cluster, geometry.indices, [&](std::uint32_t index) -> const glm::vec3& {
    return index < static_vertices ? geometry.vertices[index].position
                                   : moved[index - static_vertices].position;
  });
}

void make_clusters(Geometry& geometry, std::vector<std::vector<std::uint32_t>>& triangles,
                   const std::vector<Material>& materials) {
  std::vector<std::size_t> order(triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return materials[a].alpha_mode < materials[b].alpha_mode;
  });
  std::size_t total = 0;
  for (const auto& list : triangles) total += list.size();
  const std::size_t largest = std::clamp<std::size_t>(total / 3 / 512, 32, most_cluster_triangles);
  geometry.indices.clear();
  geometry.indices.reserve(total);
  geometry.clusters.clear();
  for (const std::size_t material : order) {
    std::vector<std::uint32_t>& list = triangles[material];
    if (list.empty()) continue;
    Splitter splitter(geometry.vertices, list, largest);
    splitter.split(0, splitter.count(), [&](std::size_t first, std::size_t last) {
      Cluster cluster;
      cluster.first_index = static_cast<std::uint32_t>(geometry.indices.size());
      cluster.index_count = static_cast<std::uint32_t>((last - first) * 3);
      cluster.material = static_cast<std::uint32_t>(material);
      for (std::size_t place = first; place < last; ++place)
        for (std::size_t corner = 0; corner < 3; ++corner)
          geometry.indices.push_back(splitter.index(place, corner));
      set_bounds(cluster, geometry.vertices, geometry.indices);
      geometry.clusters.push_back(cluster);
    });
    std::vector<std::uint32_t>().swap(list);
  }
}

void set_scene_bounds(Scene& scene) {
  scene.bounds_min = scene.bounds_max = glm::vec3(0.0f);
  if (scene.geometry.vertices.empty()) return;
  Box box;
  for (const Vertex& vertex : scene.geometry.vertices) box.add(vertex.position);
  scene.bounds_min = box.low;
  scene.bounds_max = box.high;
}

} // namespace cupola::content
