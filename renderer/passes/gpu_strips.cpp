#include "renderer/passes/gpu_strips.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x4.hpp>
#include <glm/matrix.hpp>

#include "renderer/gl/shader.h"

namespace cupola::passes {

namespace {

// Twins of replication.glsl, std430.
struct GpuCluster {
  glm::vec4 sphere;
  glm::uvec4 range;
};
struct GpuPiece {
  glm::mat3x4 to_screen;
  std::array<glm::vec4, 3> planes;
};
struct GpuRun {
  glm::uvec4 range;
};
struct DrawCommand {
  std::uint32_t count, instances, first, base_instance;
};

constexpr GLuint work_groups_x = 32768; // a cluster each; twin of replicate.comp.glsl

model::Result<gl::Program> compute(const char* label, const char* file, std::vector<std::string> defines) {
  return gl::build_program({label, {{GL_COMPUTE_SHADER, file}}, std::move(defines)});
}

void refill(gl::Buffer& buffer, const void* data, std::size_t bytes) {
  if (!buffer) buffer = gl::Buffer::make();
  glNamedBufferData(buffer.id(), static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 64)), nullptr,
                    GL_STREAM_DRAW);
  if (bytes > 0) glNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(bytes), data);
}

void bind(GLuint binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}
void bind(GLuint binding, const gl::Buffer& buffer, std::size_t bytes) {
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, buffer.id(), 0,
                    static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 4)));
}

std::vector<GpuPiece> pieces_of(const plan::PieceSet& set) {
  std::vector<GpuPiece> pieces;
  for (const plan::Piece& piece : set.pieces) {
    GpuPiece made{};
    const glm::mat3 m(piece.to_screen);
    for (int i = 0; i < 3; ++i) made.to_screen[i] = glm::vec4(m[i], 0.0f);
    for (int i = 0; i < piece.plane_count; ++i)
      made.planes[static_cast<std::size_t>(i)] =
          glm::vec4(glm::vec3(piece.planes[static_cast<std::size_t>(i)]), 0.0f);
    pieces.push_back(made);
  }
  return pieces;
}

} // namespace

model::Result<GpuStrips> GpuStrips::make() {
  GpuStrips made;
  const std::string pull = "CUPOLA_PULL";
  auto count = compute("count pairs", "renderer/passes/replicate.comp.glsl", {pull});
  auto offsets = compute("pair offsets", "renderer/passes/offsets.comp.glsl", {});
  auto emit = compute("emit pairs", "renderer/passes/replicate.comp.glsl", {pull, "CUPOLA_EMIT"});
  model::Problems problems;
  for (const auto* result : {&count, &offsets, &emit})
    if (!*result) problems.insert(problems.end(), result->error().begin(), result->error().end());
  if (!problems.empty()) return tl::unexpected(problems);
  made.count_ = std::move(*count);
  made.offsets_ = std::move(*offsets);
  made.emit_ = std::move(*emit);
  made.empty_array_ = gl::VertexArray::make();
  return made;
}

void GpuStrips::upload(const FrameScene& scene, std::span<const DrawItem> items, const std::vector<Run>& runs,
                       List& list) {
  std::vector<GpuCluster> clusters;
  std::vector<GpuRun> gpu_runs;
  std::size_t item = 0;
  for (std::uint32_t run = 0; run < runs.size(); ++run) {
    const auto first_cluster = static_cast<std::uint32_t>(item);
    std::uint32_t indices = 0;
    for (; item < items.size() && indices < runs[run].index_count; ++item) {
      const DrawItem& it = items[item];
      const bool double_sided = scene.gpu.features(it.material) & feature_double_sided;
      clusters.push_back({glm::vec4(it.center, it.radius),
                          {it.first_index / 3, it.index_count / 3, double_sided ? 1u : 0u, run}});
      indices += it.index_count;
    }
    gpu_runs.push_back({{first_cluster, static_cast<std::uint32_t>(item) - first_cluster,
                         runs[run].first_index / 3, runs[run].index_count / 3}});
  }
  refill(list.clusters, clusters.data(), clusters.size() * sizeof(GpuCluster));
  refill(list.runs, gpu_runs.data(), gpu_runs.size() * sizeof(GpuRun));
  refill(list.offsets, nullptr, 0);
  glNamedBufferData(list.offsets.id(), static_cast<GLsizeiptr>(clusters.size() * sizeof(std::uint32_t)),
                    nullptr, GL_DYNAMIC_COPY);
  if (!list.commands) list.commands = gl::Buffer::make();
  glNamedBufferData(list.commands.id(), static_cast<GLsizeiptr>(runs.size() * 2 * sizeof(DrawCommand)),
                    nullptr, GL_DYNAMIC_COPY);
  list.cluster_count = clusters.size();
  list.run_count = runs.size();
}

void GpuStrips::collect_total(List& list) {
  if (list.mapped == nullptr || !list.fence.ended()) return;
  list.last_total = list.mapped[1];
}

void GpuStrips::draw_list(ScenePass& pass, const FrameScene& scene, std::span<const DrawItem> items,
                          List& list, std::size_t strips, std::uint64_t max_pairs, float style_scale) {
  if (items.empty()) {
    list.last_total = 0;
    return;
  }
  if (!list.control) {
    list.control = gl::Buffer::make();
    glNamedBufferStorage(list.control.id(), 8, nullptr, GL_DYNAMIC_STORAGE_BIT);
    list.read_back = gl::Buffer::make();
    constexpr GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glNamedBufferStorage(list.read_back.id(), 8, nullptr, flags);
    list.mapped = static_cast<const std::uint32_t*>(glMapNamedBufferRange(list.read_back.id(), 0, 8, flags));
    list.pairs = gl::Buffer::make();
  }
  std::uint64_t triangles = 0;
  for (const DrawItem& item : items) triangles += item.index_count / 3;
  const std::uint64_t wanted =
      std::min(max_pairs, std::max(list.last_total + list.last_total / 2, triangles));
  if (wanted > list.pair_capacity) {
    list.pair_capacity = wanted;
    glNamedBufferData(list.pairs.id(), static_cast<GLsizeiptr>(wanted * 8), nullptr, GL_DYNAMIC_COPY);
  }
  const std::vector<Run> runs = join_runs(items);
  upload(scene, items, runs, list);

  const std::size_t clusters = list.cluster_count;
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, scene.gpu.vertices());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, scene.gpu.indices());
  bind(2, list.clusters, clusters * sizeof(GpuCluster));
  bind(3, pieces_);
  bind(4, list.pairs);
  bind(5, list.control);
  bind(6, borders_);
  bind(7, list.offsets);
  bind(8, list.runs, list.run_count * sizeof(GpuRun));
  bind(9, list.commands);
  const auto capacity = static_cast<GLuint>(std::min<std::uint64_t>(list.pair_capacity, ~0u));
  const auto groups = static_cast<GLuint>(clusters);
  const GLuint across = std::min(groups, work_groups_x), down = (groups + work_groups_x - 1) / work_groups_x;
  glUseProgram(count_.id());
  glDispatchCompute(across, down, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glUseProgram(offsets_.id());
  glUniform1ui(0, capacity);
  glUniform1ui(1, static_cast<GLuint>(strips));
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glUseProgram(emit_.id());
  glUniform1ui(4, capacity);
  glDispatchCompute(across, down, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);

  glBindVertexArray(empty_array_.id());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, list.commands.id());
  for (std::size_t run = 0; run < runs.size(); ++run) {
    pass.bind_program(scene, VertexPath::replicated, runs[run].material, style_scale, {}, {});
    glMultiDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(run * 2 * sizeof(DrawCommand)), 2,
                              0);
  }
  if (list.fence.ended()) {
    glCopyNamedBufferSubData(list.control.id(), list.read_back.id(), 0, 0, 8);
    list.fence = gl::Fence::insert();
  }
}

DrawCounts GpuStrips::draw(ScenePass& pass, const FrameScene& scene, const plan::PieceSet& set,
                           const StripAzimuths& azimuths, std::uint64_t max_pairs, float style_scale) {
  const std::vector<GpuPiece> pieces = pieces_of(set);
  refill(pieces_, pieces.data(), pieces.size() * sizeof(GpuPiece));
  refill(borders_, azimuths.borders().data(), azimuths.borders().size() * sizeof(float));
  for (const gl::Program* program : {&count_, &emit_}) {
    glProgramUniformMatrix3fv(program->id(), 0, 1, GL_FALSE, glm::value_ptr(azimuths.axes_from_view()));
    glProgramUniform1i(program->id(), 2, azimuths.count());
    glProgramUniform1i(program->id(), 3, azimuths.full_turn() ? 1 : 0);
  }
  glFrontFace(glm::determinant(set.pieces.front().to_screen) < 0.0 ? GL_CCW : GL_CW);
  for (GLenum plane = 0; plane < 3; ++plane) glEnable(GL_CLIP_DISTANCE0 + plane);
  DrawCounts counts;
  const std::array lists{std::span<const DrawItem>(scene.list.opaque),
                         std::span<const DrawItem>(scene.list.blended)};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    collect_total(lists_[i]);
    draw_list(pass, scene, lists[i], lists_[i], pieces.size(), max_pairs, style_scale);
    counts.pairs += lists_[i].last_total;
    counts.bytes += lists_[i].pair_capacity * 8;
  }
  counts.triangles = counts.pairs;
  for (GLenum plane = 0; plane < 3; ++plane) glDisable(GL_CLIP_DISTANCE0 + plane);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  return counts;
}

} // namespace cupola::passes
