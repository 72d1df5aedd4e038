// A scene in memory, ready to be drawn or traced: triangles in world space, materials, images, lights. No GL.
// Made on the prepare thread by load_scene(); immutable afterwards and shared by all threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "configs/model/show.h"

namespace cupola::content {

/// 36 bytes, as the GPU reads it.
struct Vertex {
  glm::vec3 position;        ///< metres, world
  glm::vec3 normal;          ///< unit length, world
  glm::vec2 uv;              ///< (0,0) is the first texel of the first row of the image
  std::uint32_t color = ~0u; ///< RGBA8, red in the lowest byte, linear; multiplies the base colour
};

/// 8 bit RGBA, rows from the top.
struct Image {
  std::string name;
  int width = 0, height = 0;
  bool srgb = true; ///< colour; false for data such as normals
  std::vector<std::uint8_t> rgba;
};

enum class Wrap : std::uint8_t { repeat, mirror, clamp };

struct Texture {
  int image = -1;
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  bool nearest = false; ///< blocky magnification, as glTF's NEAREST
  bool mipmaps = true;
};

/// How a material reads a texture: uv' = transform · (u, v, 1) [KHR_texture_transform].
struct TextureUse {
  int texture = -1; ///< none
  glm::mat3 transform{1.0f};
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// Metallic-roughness as in glTF 2.0.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};
  float metallic = 0.0f, roughness = 1.0f;
  glm::vec3 emissive{0.0f};
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;   ///< base colour and what it emits as they are, no light
  bool fogless = false; ///< a sky: fog does not reach it
  TextureUse base_color_map, metallic_roughness_map, normal_map, emissive_map, occlusion_map;
};

/// Up to a few hundred neighbouring triangles of one material: the unit of culling.
struct Cluster {
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t material = 0;
  glm::vec3 center{0.0f};
  float radius = 0.0f;
};

/// Triangles, counter-clockwise from their front; points and lines stand as triangles too, see Pose. Clusters
/// stand sorted by alpha mode (opaque, mask, blend), then by material, and cover `indices` without gap or
/// overlap, in order.
struct Geometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Cluster> clusters;
};

enum class LightKind : std::uint8_t { directional, point, spot };
struct Light {
  LightKind kind{};
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, 0.0f, -1.0f}; ///< in which it shines
  glm::vec3 radiance{1.0f};               ///< colour times intensity
  float range = 0.0f;                     ///< 0: unbounded
  float cos_inner = 1.0f, cos_outer = 0.0f;
};

struct Rig; ///< nodes, skins, morph targets, animation, points and lines; private to this room

struct Scene {
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  Geometry geometry;                 ///< at time 0, seen from the origin
  std::vector<Light> lights;         ///< at time 0
  std::uint32_t static_vertices = 0; ///< vertices from here on move with time or with the eye
  double duration = 0.0;             ///< seconds of one round of the animation; 0: nothing moves with time
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};
  std::shared_ptr<const Rig> rig; ///< null when nothing moves
};

struct LoadedScene {
  std::shared_ptr<const Scene> scene;
  model::Problems warnings;
};

/// Generates or reads what the show asks for. `folder`: that relative paths start from.
[[nodiscard]] model::Result<LoadedScene> load_scene(const model::Content& content,
                                                    const std::filesystem::path& folder);

/// What moves, at a time and seen from an eye, which points and lines turn to. Sizes never change:
/// vertices[i] replaces geometry.vertices[static_vertices + i].
struct Pose {
  std::vector<Vertex> vertices;
  std::vector<Cluster> clusters; ///< all clusters, with bounds that hold at this time
  std::vector<Light> lights;
};
/// Writes the pose at `time` seconds (repeats after `duration`) for an eye in world space; reuses the memory
/// of `out`. Any thread.
void pose(const Scene& scene, double time, const glm::vec3& eye, Pose& out);

} // namespace cupola::content
