// From triangles in any order to the clusters that scene.h promises. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::content {

inline constexpr std::size_t most_cluster_triangles = 256;

/// Fills `indices` and `clusters` of a geometry whose vertices stand already. triangles[m]: index triples of
/// material m; emptied on the way. Clusters are split along their longest side, so they are compact, and
/// smaller in small scenes, which thus have some 500 as well; the same input gives the same clusters on every
/// machine.
void make_clusters(Geometry& geometry, std::vector<std::vector<std::uint32_t>>& triangles,
                   const std::vector<Material>& materials);

/// Sets a cluster's sphere: around the middle of its box, through its farthest vertex.
void set_bounds(Cluster& cluster, std::span<const Vertex> vertices, std::span<const std::uint32_t> indices);

/// The same when vertices from `static_vertices` on stand at `moved`.
void set_moving_bounds(const Geometry& geometry, std::uint32_t static_vertices, std::span<const Vertex> moved,
                       Cluster& cluster);

/// Sets the scene's box from its vertices; all zero when there are none.
void set_scene_bounds(Scene& scene);

} // namespace cupola::content
