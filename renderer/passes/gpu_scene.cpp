#include "renderer/passes/gpu_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <glm/mat3x4.hpp>
#include <glm/vec4.hpp>

namespace cupola::passes {

namespace {

/// Twin of renderer/shaders/material.glsl, std140.
struct MaterialBlock {
  glm::vec4 base_color;
  glm::vec4 emissive_cutoff;
  glm::vec4 factors;
  std::array<glm::mat3x4, 5> uv; // columns padded to vec4
};

glm::mat3x4 padded(const glm::mat3& m) {
  return {glm::vec4(m[0], 0.0f), glm::vec4(m[1], 0.0f), glm::vec4(m[2], 0.0f)};
}

std::array<content::TextureUse, 5> maps(const content::Material& material) {
  return {material.base_color_map, material.metallic_roughness_map, material.normal_map,
          material.emissive_map, material.occlusion_map};
}

std::uint32_t features_of(const content::Material& material) {
  std::uint32_t bits = 0;
  const auto uses = maps(material);
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (uses[i].texture >= 0) bits |= 1u << i;
  if (material.unlit) bits |= feature_unlit;
  if (material.alpha_mode == content::AlphaMode::mask) bits |= feature_mask;
  if (material.double_sided) bits |= feature_double_sided;
  if (material.fogless) bits |= feature_fogless;
  return bits;
}

GLenum wrap(content::Wrap mode) {
  switch (mode) {
  case content::Wrap::repeat:
    return GL_REPEAT;
  case content::Wrap::mirror:
    return GL_MIRRORED_REPEAT;
  case content::Wrap::clamp:
    return GL_CLAMP_TO_EDGE;
  }
  return GL_REPEAT;
}

MaterialBlock block_of(const content::Material& material) {
  MaterialBlock block;
  block.base_color = material.base_color;
  block.emissive_cutoff = glm::vec4(material.emissive, material.alpha_cutoff);
  block.factors = {material.metallic, material.roughness, material.normal_scale, material.occlusion_strength};
  const auto uses = maps(material);
  for (std::size_t i = 0; i < uses.size(); ++i) block.uv[i] = padded(uses[i].transform);
  return block;
}

} // namespace

GpuScene::GpuScene(std::shared_ptr<const content::Scene> scene, int anisotropy)
    : scene_(std::move(scene)) {
  const content::Geometry& geometry = scene_->geometry;
  const std::size_t vertex_bytes = geometry.vertices.size() * sizeof(content::Vertex);
  const std::size_t index_bytes = geometry.indices.size() * sizeof(std::uint32_t);
  bytes_ = vertex_bytes + index_bytes;
  vertices_ = gl::Buffer::make();
  indices_ = gl::Buffer::make();
  glNamedBufferStorage(vertices_.id(), static_cast<GLsizeiptr>(std::max<std::size_t>(vertex_bytes, 64)),
                       nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferStorage(indices_.id(), static_cast<GLsizeiptr>(std::max<std::size_t>(index_bytes, 64)),
                       nullptr, GL_DYNAMIC_STORAGE_BIT);
  vertices_.label("scene vertices");
  indices_.label("scene indices");

  vertex_array_ = gl::VertexArray::make();
  const GLuint array = vertex_array_.id();
  glVertexArrayVertexBuffer(array, 0, vertices_.id(), 0, sizeof(content::Vertex));
  glVertexArrayElementBuffer(array, indices_.id());
  const auto attribute = [array](GLuint index, GLint size, GLenum type, GLboolean normalised,
                                 std::size_t offset) {
    glEnableVertexArrayAttrib(array, index);
    glVertexArrayAttribFormat(array, index, size, type, normalised, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, index, 0);
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(content::Vertex, position));
  attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(content::Vertex, normal));
  attribute(2, 2, GL_FLOAT, GL_FALSE, offsetof(content::Vertex, uv));
  attribute(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(content::Vertex, color));

  GLint alignment = 256;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const auto step = static_cast<std::size_t>(alignment);
  material_stride_ = (sizeof(MaterialBlock) + step - 1) / step * step;
  std::vector<std::byte> blocks(std::max<std::size_t>(scene_->materials.size(), 1) * material_stride_);
  for (std::size_t i = 0; i < scene_->materials.size(); ++i) {
    const MaterialBlock block = block_of(scene_->materials[i]);
    std::memcpy(blocks.data() + i * material_stride_, &block, sizeof block);
    features_.push_back(features_of(scene_->materials[i]));
  }
  materials_ = gl::Buffer::make();
  glNamedBufferStorage(materials_.id(), static_cast<GLsizeiptr>(blocks.size()), blocks.data(), 0);

  images_.resize(scene_->images.size());
  make_samplers(anisotropy);
}

void GpuScene::make_samplers(int anisotropy) {
  samplers_.clear();
  for (const content::Texture& texture : scene_->textures) {
    gl::Sampler sampler = gl::Sampler::make();
    const GLuint id = sampler.id();
    glSamplerParameteri(id, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap(texture.wrap_s)));
    glSamplerParameteri(id, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap(texture.wrap_t)));
    glSamplerParameteri(id, GL_TEXTURE_MAG_FILTER, texture.nearest ? GL_NEAREST : GL_LINEAR);
    glSamplerParameteri(id, GL_TEXTURE_MIN_FILTER,
                        texture.mipmaps   ? GL_LINEAR_MIPMAP_LINEAR
                        : texture.nearest ? GL_NEAREST
                                          : GL_LINEAR);
    if (anisotropy > 1 && texture.mipmaps)
      glSamplerParameterf(id, GL_TEXTURE_MAX_ANISOTROPY_EXT, static_cast<float>(anisotropy));
    samplers_.push_back(std::move(sampler));
  }
}

void GpuScene::set_anisotropy(int anisotropy) { make_samplers(anisotropy); }

void GpuScene::upload_image(std::size_t index) {
  const content::Image& image = scene_->images[index];
  const auto largest = static_cast<unsigned>(std::max({image.width, image.height, 1}));
  gl::Texture texture = gl::Texture::make(GL_TEXTURE_2D);
  texture.label(image.name);
  glTextureStorage2D(texture.id(), static_cast<GLsizei>(std::bit_width(largest)),
                     image.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, std::max(image.width, 1),
                     std::max(image.height, 1));
  if (image.width > 0 && image.height > 0)
    glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE,
                        image.rgba.data());
  glGenerateTextureMipmap(texture.id());
  images_[index] = std::move(texture);
}

bool GpuScene::upload(std::size_t bytes) {
  const content::Geometry& geometry = scene_->geometry;
  const auto portion = [&bytes](GLuint buffer, const void* data, std::size_t size, std::size_t& done) {
    const std::size_t now = std::min(bytes, size - done);
    if (now == 0) return;
    glNamedBufferSubData(buffer, static_cast<GLintptr>(done), static_cast<GLsizeiptr>(now),
                         static_cast<const std::byte*>(data) + done);
    done += now;
    bytes -= now;
  };
  const std::size_t vertex_bytes = geometry.vertices.size() * sizeof(content::Vertex);
  const std::size_t index_bytes = geometry.indices.size() * sizeof(std::uint32_t);
  portion(vertices_.id(), geometry.vertices.data(), vertex_bytes, vertex_bytes_done_);
  portion(indices_.id(), geometry.indices.data(), index_bytes, index_bytes_done_);
  while (bytes > 0 && images_done_ < images_.size()) {
    upload_image(images_done_);
    bytes -= std::min(bytes, scene_->images[images_done_].rgba.size());
    ++images_done_;
  }
  return vertex_bytes_done_ == vertex_bytes && index_bytes_done_ == index_bytes &&
         images_done_ == images_.size();
}

void GpuScene::set_moving_vertices(const std::vector<content::Vertex>& vertices) {
  if (vertices.empty()) return;
  glNamedBufferSubData(vertices_.id(),
                       static_cast<GLintptr>(scene_->static_vertices * sizeof(content::Vertex)),
                       static_cast<GLsizeiptr>(vertices.size() * sizeof(content::Vertex)), vertices.data());
}

void GpuScene::set_indices(std::size_t first, const std::vector<std::uint32_t>& indices) {
  if (indices.empty()) return;
  glNamedBufferSubData(indices_.id(), static_cast<GLintptr>(first * sizeof(std::uint32_t)),
                       static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data());
}

void GpuScene::bind_material(std::uint32_t index) const {
  glBindBufferRange(GL_UNIFORM_BUFFER, 1, materials_.id(), static_cast<GLintptr>(index * material_stride_),
                    sizeof(MaterialBlock));
  const auto uses = maps(scene_->materials[index]);
  for (std::size_t unit = 0; unit < uses.size(); ++unit) {
    if (uses[unit].texture < 0) continue;
    const auto texture = static_cast<std::size_t>(uses[unit].texture);
    const auto image = static_cast<std::size_t>(scene_->textures[texture].image);
    glBindTextureUnit(static_cast<GLuint>(unit), images_[image].id());
    glBindSampler(static_cast<GLuint>(unit), samplers_[texture].id());
  }
}

} // namespace cupola::passes
