// A scene on the GPU: vertices, indices, materials and textures. Uploaded in portions, so that a running show
// keeps its frame rate while a new scene arrives. Render thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/gl/handle.h"

namespace cupola::passes {

/// What the fragment program must do for a material: bits that select its variant.
enum MaterialFeature : std::uint32_t {
  feature_base_color_map = 1u << 0,
  feature_metallic_roughness_map = 1u << 1,
  feature_normal_map = 1u << 2,
  feature_emissive_map = 1u << 3,
  feature_occlusion_map = 1u << 4,
  feature_unlit = 1u << 5,
  feature_mask = 1u << 6,
  feature_double_sided = 1u << 7,
  feature_fogless = 1u << 8,
  material_feature_count = 9
};

class GpuScene {
public:
  /// Reserves memory; nothing is uploaded yet. `anisotropy` of texture filtering, at most the driver's.
  GpuScene(std::shared_ptr<const content::Scene> scene, int anisotropy);

  /// Uploads about `bytes` more; true when all is there.
  bool upload(std::size_t bytes);

  /// Textures are filtered anew from now on.
  void set_anisotropy(int anisotropy);

  /// Replaces what moves with time.
  void set_moving_vertices(const std::vector<content::Vertex>& vertices);
  /// Replaces the indices from `first` on: blended triangles in today's order.
  void set_indices(std::size_t first, const std::vector<std::uint32_t>& indices);

  /// Binds the uniform block and textures of a material.
  void bind_material(std::uint32_t material) const;

  [[nodiscard]] const content::Scene& scene() const { return *scene_; }
  [[nodiscard]] std::uint32_t features(std::uint32_t material) const { return features_[material]; }
  [[nodiscard]] GLuint vertices() const { return vertices_.id(); }
  [[nodiscard]] GLuint indices() const { return indices_.id(); }
  [[nodiscard]] GLuint vertex_array() const { return vertex_array_.id(); }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; } ///< of vertices and indices

private:
  void upload_image(std::size_t image);
  void make_samplers(int anisotropy);

  std::shared_ptr<const content::Scene> scene_;
  gl::Buffer vertices_, indices_, materials_;
  gl::VertexArray vertex_array_;
  std::vector<gl::Texture> images_;
  std::vector<gl::Sampler> samplers_; ///< one per scene texture
  std::vector<std::uint32_t> features_;
  std::size_t material_stride_ = 0;
  std::uint64_t bytes_ = 0;
  std::size_t vertex_bytes_done_ = 0, index_bytes_done_ = 0, images_done_ = 0;
};

} // namespace cupola::passes
