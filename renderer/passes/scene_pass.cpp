#include "renderer/passes/scene_pass.h"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

namespace cupola::passes {

namespace {

bool is_blended(const FrameScene& scene, std::uint32_t material) {
  return scene.gpu.scene().materials[material].alpha_mode == content::AlphaMode::blend;
}

void set_blending(bool on) {
  glDepthMask(on ? GL_FALSE : GL_TRUE);
  if (on)
    glEnable(GL_BLEND);
  else
    glDisable(GL_BLEND);
}

/// In the view of `to_screen`, all of the sphere is outside: left, right, above, below or behind.
bool outside(const glm::mat3& to_screen, const glm::vec3& center, float radius, float near) {
  const glm::mat3 rows = glm::transpose(to_screen);
  const auto beyond = [&](const glm::vec3& plane) {
    return glm::dot(plane, center) < -radius * glm::length(plane);
  };
  return beyond(rows[2] - rows[0]) || beyond(rows[2] + rows[0]) || beyond(rows[2] - rows[1]) ||
         beyond(rows[2] + rows[1]) || glm::dot(rows[2], center) + radius * glm::length(rows[2]) < near;
}

void cull(const FrameScene& scene, std::span<const DrawItem> items, const glm::mat3& to_screen,
          std::vector<DrawItem>& visible) {
  visible.clear();
  for (const DrawItem& item : items)
    if (item.radius < 0.0f ||
        !outside(to_screen, scene.view_from_world * (item.center - scene.eye), item.radius, scene.near))
      visible.push_back(item);
}

/// A perspective that mirrors turns front faces round. Determinants of unmirrored ones are negative (−z
/// ahead).
void set_front_face(const glm::dmat3& to_screen) {
  glFrontFace(glm::determinant(to_screen) < 0.0 ? GL_CCW : GL_CW);
}

} // namespace

void set_scene_state() {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_FRAMEBUFFER_SRGB);
  set_blending(false);
}

ScenePass::ScenePass(ScenePrograms& programs)
    : programs_(programs) {
  empty_array_ = gl::VertexArray::make();
  emitted_array_ = gl::VertexArray::make();
  const GLuint array = emitted_array_.id();
  const auto attribute = [array](GLuint index, GLint size, GLenum type, GLboolean normalised,
                                 std::size_t offset) {
    glEnableVertexArrayAttrib(array, index);
    glVertexArrayAttribFormat(array, index, size, type, normalised, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, index, 0);
  };
  attribute(0, 4, GL_FLOAT, GL_FALSE, offsetof(EmittedVertex, clip));
  attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(EmittedVertex, offset));
  attribute(2, 4, GL_INT_2_10_10_10_REV, GL_TRUE, offsetof(EmittedVertex, normal));
  attribute(3, 2, GL_FLOAT, GL_FALSE, offsetof(EmittedVertex, uv));
  attribute(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(EmittedVertex, color));
  attribute(5, 2, GL_FLOAT, GL_FALSE, offsetof(EmittedVertex, corner));
}

void ScenePass::bind_program(const FrameScene& scene, VertexPath path, std::uint32_t material,
                             float style_scale, std::span<const glm::mat3> to_screen,
                             std::span<const int> layers) {
  const std::uint32_t features = scene.gpu.features(material);
  glUseProgram(programs_.get(path, scene.style, scene.lights, features));
  glUniform1f(12, style_scale);
  if (!to_screen.empty())
    glUniformMatrix3fv(0, static_cast<GLsizei>(to_screen.size()), GL_FALSE,
                       glm::value_ptr(to_screen.front()));
  if (!layers.empty()) glUniform1iv(6, static_cast<GLsizei>(layers.size()), layers.data());
  if (features & feature_double_sided)
    glDisable(GL_CULL_FACE);
  else
    glEnable(GL_CULL_FACE);
  scene.gpu.bind_material(material);
  set_blending(is_blended(scene, material));
}

DrawCounts ScenePass::draw_items(const FrameScene& scene, std::span<const DrawItem> items,
                                 const glm::dmat3& to_screen, float style_scale) {
  const std::array matrix{glm::mat3(to_screen)};
  cull(scene, items, matrix[0], visible_);
  const bool pulled = scene.style == model::StyleKind::wireframe;
  glBindVertexArray(pulled ? empty_array_.id() : scene.gpu.vertex_array());
  DrawCounts counts;
  std::vector<GLsizei> index_counts;
  std::vector<const void*> offsets;
  for (std::size_t begin = 0; begin < visible_.size();) {
    const std::uint32_t material = visible_[begin].material;
    std::size_t end = begin;
    while (end < visible_.size() && visible_[end].material == material) ++end;
    bind_program(scene, VertexPath::direct, material, style_scale, matrix, {});
    index_counts.clear();
    offsets.clear();
    for (const Run& run : join_runs(std::span(visible_).subspan(begin, end - begin))) {
      counts.triangles += run.index_count / 3;
      if (pulled) {
        glDrawArrays(GL_TRIANGLES, static_cast<GLint>(run.first_index),
                     static_cast<GLsizei>(run.index_count));
        continue;
      }
      index_counts.push_back(static_cast<GLsizei>(run.index_count));
      offsets.push_back(reinterpret_cast<const void*>(run.first_index * sizeof(std::uint32_t)));
    }
    if (!index_counts.empty())
      glMultiDrawElements(GL_TRIANGLES, index_counts.data(), GL_UNSIGNED_INT, offsets.data(),
                          static_cast<GLsizei>(index_counts.size()));
    begin = end;
  }
  return counts;
}

DrawCounts ScenePass::draw_direct(const FrameScene& scene, const glm::dmat3& to_screen, float style_scale) {
  set_front_face(to_screen);
  DrawCounts counts = draw_items(scene, scene.list.opaque, to_screen, style_scale);
  counts += draw_items(scene, scene.list.blended, to_screen, style_scale);
  set_blending(false);
  return counts;
}

DrawCounts ScenePass::draw_layered(const FrameScene& scene, const std::array<glm::dmat3, 6>& to_screen,
                                   std::span<const int> layers, float style_scale) {
  if (layers.empty()) return {};
  set_front_face(to_screen[static_cast<std::size_t>(layers.front())]);
  std::vector<glm::mat3> matrices;
  for (const int layer : layers) matrices.emplace_back(to_screen[static_cast<std::size_t>(layer)]);
  const bool pulled = scene.style == model::StyleKind::wireframe;
  glBindVertexArray(pulled ? empty_array_.id() : scene.gpu.vertex_array());
  DrawCounts counts;
  const auto instances = static_cast<GLsizei>(layers.size());
  for (const auto* items : {&scene.list.opaque, &scene.list.blended})
    for (const Run& run : join_runs(*items)) {
      bind_program(scene, VertexPath::layered, run.material, style_scale, matrices, layers);
      const auto count = static_cast<GLsizei>(run.index_count);
      if (pulled)
        glDrawArraysInstanced(GL_TRIANGLES, static_cast<GLint>(run.first_index), count, instances);
      else
        glDrawElementsInstanced(GL_TRIANGLES, count, GL_UNSIGNED_INT,
                                reinterpret_cast<const void*>(run.first_index * sizeof(std::uint32_t)),
                                instances);
      counts.triangles += std::uint64_t{run.index_count} / 3 * layers.size();
    }
  set_blending(false);
  return counts;
}

DrawCounts ScenePass::draw_batches(const FrameScene& scene, const std::vector<EmittedBatch>& batches,
                                   float style_scale) {
  std::vector<std::size_t> vertex_start, index_start;
  std::size_t vertices = 0, indices = 0;
  DrawCounts counts;
  for (const EmittedBatch& batch : batches) {
    vertex_start.push_back(vertices);
    index_start.push_back(indices);
    vertices += batch.vertices.size();
    indices += batch.indices.size();
    counts.pairs += batch.pairs;
  }
  counts.triangles = indices / 3;
  if (indices == 0) return counts;
  auto* to_vertices =
      reinterpret_cast<EmittedVertex*>(emitted_vertices_.begin(vertices * sizeof(EmittedVertex)));
  auto* to_indices =
      reinterpret_cast<std::uint32_t*>(emitted_indices_.begin(indices * sizeof(std::uint32_t)));
  tbb::parallel_for(std::size_t{0}, batches.size(), [&](std::size_t i) {
    const EmittedBatch& batch = batches[i];
    std::copy(batch.vertices.begin(), batch.vertices.end(), to_vertices + vertex_start[i]);
    const auto base = static_cast<std::uint32_t>(vertex_start[i]);
    std::transform(batch.indices.begin(), batch.indices.end(), to_indices + index_start[i],
                   [base](std::uint32_t index) { return index + base; });
  });
  std::vector<Run> runs;
  for (std::size_t i = 0; i < batches.size(); ++i)
    for (const Run& run : batches[i].runs) {
      const auto first = static_cast<std::uint32_t>(index_start[i]) + run.first_index;
      if (!runs.empty() && runs.back().material == run.material)
        runs.back().index_count += run.index_count;
      else
        runs.push_back({run.material, first, run.index_count});
    }
  glBindVertexArray(emitted_array_.id());
  glVertexArrayVertexBuffer(emitted_array_.id(), 0, emitted_vertices_.id(), 0, sizeof(EmittedVertex));
  glVertexArrayElementBuffer(emitted_array_.id(), emitted_indices_.id());
  for (const Run& run : runs) {
    bind_program(scene, VertexPath::emitted, run.material, style_scale, {}, {});
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(run.index_count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(run.first_index * sizeof(std::uint32_t)));
  }
  emitted_vertices_.finish();
  emitted_indices_.finish();
  return counts;
}

DrawCounts ScenePass::draw_strips_cpu(const FrameScene& scene, const plan::PieceSet& set,
                                      const StripAzimuths& azimuths, std::uint64_t max_pairs,
                                      float style_scale) {
  set_front_face(set.pieces.front().to_screen);
  const StripView view{set,        azimuths,
                       scene.eye,  scene.view_from_world,
                       scene.near, scene.style == model::StyleKind::wireframe};
  DrawCounts counts;
  // In portions: memory stays below the ceiling, and nothing is ever missing.
  const std::uint64_t worst_portion = std::max<std::uint64_t>(max_pairs / 8, 1);
  for (const auto* items : {&scene.list.opaque, &scene.list.blended}) {
    std::span<const DrawItem> left(*items);
    while (!left.empty()) {
      std::uint64_t triangles = 0;
      std::size_t take = 0;
      while (take < left.size() && (take == 0 || triangles < worst_portion))
        triangles += left[take++].index_count / 3;
      distribute_strips(scene.geometry, left.first(take), view, batches_);
      counts += draw_batches(scene, batches_, style_scale);
      left = left.subspan(take);
    }
  }
  set_blending(false);
  counts.bytes = emitted_vertices_.bytes() + emitted_indices_.bytes();
  return counts;
}

} // namespace cupola::passes
