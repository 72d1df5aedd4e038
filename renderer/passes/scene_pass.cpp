#include "renderer/passes/scene_pass.h"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>
#include <tuple>

namespace cupola::passes {

namespace {

constexpr int max_group = 16; // scissors that OpenGL 4.5 guarantees

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
  attribute(0, 4, GL_FLOAT, GL_FALSE, offsetof(EmittedVertex, position));
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
  glUseProgram(
      programs_.get(path, {scene.style, scene.lights, scene.primitives, scene.shades_uncovered}, features));
  glUniform1f(12, style_scale);
  if (!to_screen.empty())
    glUniformMatrix3fv(0, static_cast<GLsizei>(to_screen.size()), GL_FALSE,
                       glm::value_ptr(to_screen.front()));
  if (!layers.empty()) glUniform1iv(6, static_cast<GLsizei>(layers.size()), layers.data());
  // The GPU engine has left out what is seen from behind, and its pieces may mirror.
  if (features & feature_double_sided || path == VertexPath::replicated)
    glDisable(GL_CULL_FACE);
  else
    glEnable(GL_CULL_FACE);
  scene.gpu.bind_material(material);
  set_blending(is_blended(scene, material));
}

bool ScenePass::bind_geometry(const FrameScene& scene) const {
  if (!scene.edges()) {
    glBindVertexArray(scene.gpu.vertex_array());
    return false;
  }
  glBindVertexArray(empty_array_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, scene.gpu.vertices());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, scene.gpu.indices());
  return true;
}

DrawCounts ScenePass::draw_items(const FrameScene& scene, std::span<const DrawItem> items,
                                 const glm::dmat3& to_screen, float style_scale) {
  const std::array matrix{glm::mat3(to_screen)};
  cull(scene, items, matrix[0], visible_);
  const bool pulled = bind_geometry(scene);
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
  const bool pulled = bind_geometry(scene);
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

namespace {

/// Portions of all batches that are drawn together: one material, one group of strips.
struct EmittedDraw {
  std::uint32_t material, group;
  std::size_t first_index, index_count;
};

/// Where a portion's indices go.
struct Move {
  std::size_t batch, portion, to;
};

/// Joins the portions of all batches: by run, then by group. Inside a group the order of the batches is kept.
std::vector<EmittedDraw> arrange(const std::vector<EmittedBatch>& batches, std::vector<Move>& moves) {
  struct Key {
    std::uint32_t run, group;
    std::size_t batch, portion;
    bool operator<(const Key& other) const {
      return std::tie(run, group, batch, portion) <
             std::tie(other.run, other.group, other.batch, other.portion);
    }
  };
  std::vector<Key> keys;
  for (std::size_t batch = 0; batch < batches.size(); ++batch)
    for (std::size_t i = 0; i < batches[batch].portions.size(); ++i)
      keys.push_back({batches[batch].portions[i].run, batches[batch].portions[i].group, batch, i});
  std::sort(keys.begin(), keys.end());
  std::vector<EmittedDraw> draws;
  std::size_t to = 0;
  const Key* before = nullptr;
  for (const Key& key : keys) {
    const EmittedPortion& portion = batches[key.batch].portions[key.portion];
    if (!before || before->run != key.run || before->group != key.group)
      draws.push_back({portion.material, portion.group, to, 0});
    draws.back().index_count += portion.index_count;
    moves.push_back({key.batch, key.portion, to});
    to += portion.index_count;
    before = &key;
  }
  return draws;
}

} // namespace

std::vector<std::size_t> ScenePass::upload_vertices(const std::vector<EmittedBatch>& batches) {
  std::vector<std::size_t> starts;
  std::size_t vertices = 0;
  for (const EmittedBatch& batch : batches) {
    starts.push_back(vertices);
    vertices += batch.vertices.size();
  }
  auto* to = reinterpret_cast<EmittedVertex*>(emitted_vertices_.begin(vertices * sizeof(EmittedVertex)));
  tbb::parallel_for(std::size_t{0}, batches.size(), [&](std::size_t i) {
    std::copy(batches[i].vertices.begin(), batches[i].vertices.end(), to + starts[i]);
  });
  return starts;
}

DrawCounts ScenePass::draw_batches(const FrameScene& scene, const std::vector<EmittedBatch>& batches,
                                   const StripTarget& target) {
  DrawCounts counts;
  std::vector<Move> moves;
  const std::vector<EmittedDraw> draws = arrange(batches, moves);
  if (draws.empty()) return counts;
  const std::size_t indices = draws.back().first_index + draws.back().index_count;
  for (const EmittedBatch& batch : batches) counts.pairs += batch.pairs - batch.hidden;
  counts.triangles = indices / 3;

  const std::vector<std::size_t> starts = upload_vertices(batches);
  auto* to_indices =
      reinterpret_cast<std::uint32_t*>(emitted_indices_.begin(indices * sizeof(std::uint32_t)));
  tbb::parallel_for(std::size_t{0}, moves.size(), [&](std::size_t i) {
    const Move& move = moves[i];
    const EmittedPortion& portion = batches[move.batch].portions[move.portion];
    const std::uint32_t* from = batches[move.batch].indices.data() + portion.first_index;
    const auto base = static_cast<std::uint32_t>(starts[move.batch]);
    std::transform(from, from + portion.index_count, to_indices + move.to,
                   [base](std::uint32_t index) { return index + base; });
  });

  glBindVertexArray(emitted_array_.id());
  glVertexArrayVertexBuffer(emitted_array_.id(), 0, emitted_vertices_.id(), 0, sizeof(EmittedVertex));
  glVertexArrayElementBuffer(emitted_array_.id(), emitted_indices_.id());
  std::uint32_t bound = ~0u;
  for (const EmittedDraw& draw : draws) {
    if (draw.material != bound)
      bind_program(scene, VertexPath::emitted, draw.material, static_cast<float>(target.scale), {}, {});
    bound = draw.material;
    const std::size_t first = std::size_t{draw.group} * 4 * static_cast<std::size_t>(target.group_size);
    const std::size_t count =
        std::min(static_cast<std::size_t>(target.group_size), (target.scissors.size() - first) / 4);
    glScissorArrayv(0, static_cast<GLsizei>(count), target.scissors.data() + first);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(draw.index_count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(draw.first_index * sizeof(std::uint32_t)));
  }
  emitted_vertices_.finish();
  emitted_indices_.finish();
  return counts;
}

template <class F>
DrawCounts ScenePass::draw_distributed(const FrameScene& scene, std::span<const DrawItem> items,
                                       std::uint64_t max_pairs, const StripTarget& target,
                                       const F& distribute) {
  DrawCounts counts;
  // In portions: memory stays below the ceiling, and nothing is ever missing.
  const std::uint64_t worst_portion = std::max<std::uint64_t>(max_pairs / 8, 1);
  while (!items.empty()) {
    std::uint64_t triangles = 0;
    std::size_t take = 0;
    while (take < items.size() && (take == 0 || triangles < worst_portion))
      triangles += items[take++].index_count / 3;
    distribute(items.first(take));
    counts += draw_batches(scene, batches_, target);
    items = items.subspan(take);
  }
  set_blending(false);
  return counts;
}

DrawCounts ScenePass::draw_strips_cpu(const FrameScene& scene, const plan::PieceSet& set,
                                      const StripAzimuths& azimuths, std::uint64_t max_pairs, int scale) {
  set_front_face(set.pieces.front().to_screen);
  StripTarget target{scale, per_strip_scissors() ? max_group : 1, {}};
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  for (const plan::Piece& piece : set.pieces)
    target.scissors.insert(target.scissors.end(),
                           {piece.bounds.x * scale, viewport[1], piece.bounds.width * scale, viewport[3]});
  const StripView view{set,        azimuths,          scene.eye,    scene.view_from_world,
                       scene.near, target.group_size, scene.edges()};
  const auto distribute = [&](std::span<const DrawItem> items) {
    distribute_strips(scene.geometry, items, view, batches_);
  };
  DrawCounts counts = draw_distributed(scene, scene.list.opaque, max_pairs, target, distribute);
  counts += draw_distributed(scene, scene.list.blended, max_pairs, target, distribute);
  counts.bytes = emitted_vertices_.bytes() + emitted_indices_.bytes();
  return counts;
}

DrawCounts ScenePass::draw_cells_cpu(const FrameScene& scene, const PieceTable& pieces, Occlusion& occlusion,
                                     std::uint64_t max_pairs, int scale,
                                     const std::function<void()>& background) {
  glFrontFace(GL_CCW);
  std::array<GLint, 4> scissor{};
  glGetIntegerv(GL_SCISSOR_BOX, scissor.data());
  const StripTarget target{scale, 1, {scissor.begin(), scissor.end()}};
  const CellView view{pieces, scene.eye, scene.view_from_world, scene.near, scene.edges()};
  occlusion.reset(pieces);
  const auto distribute = [&](std::span<const DrawItem> items) {
    distribute_cells(scene.geometry, items, view, occlusion, batches_);
  };
  DrawCounts counts = draw_distributed(scene, scene.list.opaque, max_pairs, target, distribute);
  background();
  counts += draw_distributed(scene, scene.list.blended, max_pairs, target, distribute);
  counts.bytes = emitted_vertices_.bytes() + emitted_indices_.bytes();
  return counts;
}

} // namespace cupola::passes
