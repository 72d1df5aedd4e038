#include "renderer/passes/gpu_pieces.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x4.hpp>
#include <utility>

#include "renderer/gl/shader.h"

namespace cupola::passes {

namespace {

// Twins of replication.glsl and cells.glsl, std430.
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
struct GpuGroup {
  glm::vec4 axis_sine;
  float cosine;
  std::uint32_t first, count, next;
};
struct DrawCommand {
  std::uint32_t count, instances, first, base_instance;
};

constexpr GLuint work_groups_x = 32768;             // a cluster each; twin of replicate.comp.glsl
constexpr std::uint32_t work_group = 64;            // items at a time; twin of replicate.comp.glsl
constexpr std::uint64_t most_capacity = 1ull << 29; // pairs of a list: numbers of vertices stay below 2^31
constexpr std::uint64_t most_pairs = 0xffffffffull; // of a frame: they are counted in 32 bits
constexpr std::uint64_t most_rounds = 256;
constexpr GLsizeiptr control_bytes = 16;

void refill(gl::Buffer& buffer, const void* data, std::size_t bytes) {
  if (!buffer) buffer = gl::Buffer::make();
  glNamedBufferData(buffer.id(), static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 64)), nullptr,
                    GL_STREAM_DRAW);
  if (bytes > 0 && data != nullptr)
    glNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(bytes), data);
}

void bind(GLuint binding, const gl::Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}
void bind(GLuint binding, const gl::Buffer& buffer, std::size_t bytes) {
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, buffer.id(), 0,
                    static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 4)));
}

/// Items of a cluster: see replicate.comp.glsl.
std::uint32_t items_of(std::uint32_t triangles) {
  return triangles * std::max(1u, work_group / std::max(triangles, 1u));
}

} // namespace

glm::dvec3 overlap_shares(const plan::PieceSet& set, std::size_t piece, const glm::dvec2& pixels) {
  std::array<const plan::Corner*, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) corners[i] = &set.corners[set.triangles[piece][i]];
  const auto place = [&](std::size_t i) { return corners[i % 3]->screen * 0.5 * pixels; };
  const glm::dvec2 a = place(1) - place(0), b = place(2) - place(0);
  const double area = std::abs(a.x * b.y - a.y * b.x);
  glm::dvec3 shares;
  for (std::size_t i = 0; i < 3; ++i) {
    // A pixel is 1 / height of the screen's barycentric coordinate bᵢ wᵢ / w of corner i.
    const double height = area / glm::distance(place(i + 1), place(i + 2));
    const double share = height > 20.0 * piece_overlap ? piece_overlap / height : 0.05;
    shares[static_cast<int>(i)] = share / corners[i]->weight;
  }
  return shares;
}

model::Result<GpuPieces::Programs> GpuPieces::make_programs() {
  const auto compute = [](const char* label, const char* file, std::vector<std::string> defines) {
    return gl::build_program({label, {{GL_COMPUTE_SHADER, file}}, std::move(defines)});
  };
  constexpr const char* replicate = "renderer/passes/replicate.comp.glsl";
  const std::string pull = "CUPOLA_PULL", emit = "CUPOLA_EMIT", strips = "CUPOLA_STRIPS";
  std::array made{compute("count pairs of strips", replicate, {pull, strips}),
                  compute("emit pairs of strips", replicate, {pull, strips, emit}),
                  compute("count pairs", replicate, {pull}), compute("emit pairs", replicate, {pull, emit}),
                  compute("pair offsets", "renderer/passes/offsets.comp.glsl", {})};
  model::Problems problems;
  for (const auto& result : made)
    if (!result) problems.insert(problems.end(), result.error().begin(), result.error().end());
  if (!problems.empty()) return tl::unexpected(problems);
  return Programs{{std::move(*made[0]), std::move(*made[1])},
                  {std::move(*made[2]), std::move(*made[3])},
                  std::move(*made[4])};
}

GpuPieces::GpuPieces()
    : empty_array_(gl::VertexArray::make()) {}

/// `overlaps`: none, or by piece.
void GpuPieces::load_pieces(const plan::PieceSet& set, std::span<const glm::dvec3> overlaps) {
  std::vector<GpuPiece> pieces;
  pieces.reserve(set.pieces.size());
  for (std::size_t i = 0; i < set.pieces.size(); ++i) {
    GpuPiece made{};
    const glm::mat3 m(set.pieces[i].to_screen);
    for (int column = 0; column < 3; ++column) made.to_screen[column] = glm::vec4(m[column], 0.0f);
    for (std::size_t plane = 0; plane < static_cast<std::size_t>(set.pieces[i].plane_count); ++plane)
      made.planes[plane] = glm::vec4(set.pieces[i].planes[plane],
                                     overlaps.empty() ? 0.0 : overlaps[i][static_cast<int>(plane)]);
    pieces.push_back(made);
  }
  refill(pieces_, pieces.data(), pieces.size() * sizeof(GpuPiece));
  piece_count_ = pieces.size();
}

void GpuPieces::load_strips(const plan::PieceSet& set, const StripAzimuths& azimuths) {
  strips_ = true;
  load_pieces(set, {});
  refill(search_, azimuths.borders().data(), azimuths.borders().size() * sizeof(float));
  axes_from_view_ = azimuths.axes_from_view();
  full_turn_ = azimuths.full_turn();
}

void GpuPieces::load_triangles(const plan::PieceSet& set, const PieceTable& table, const glm::dvec2& pixels) {
  strips_ = false;
  std::vector<glm::dvec3> overlaps;
  std::vector<glm::vec4> rays;
  overlaps.reserve(set.pieces.size());
  rays.reserve(set.pieces.size() * 3);
  for (std::size_t i = 0; i < set.pieces.size(); ++i) {
    overlaps.push_back(overlap_shares(set, i, pixels));
    for (const std::uint32_t corner : set.triangles[i]) rays.emplace_back(set.corners[corner].ray, 0.0);
  }
  load_pieces(set, overlaps);
  refill(rays_, rays.data(), rays.size() * sizeof(glm::vec4));
  std::vector<GpuGroup> groups;
  groups.reserve(table.groups().size());
  for (const PieceTable::Group& group : table.groups())
    groups.push_back({glm::vec4(group.axis, group.sine), group.cosine, group.first, group.count, group.next});
  refill(search_, groups.data(), groups.size() * sizeof(GpuGroup));
}

void GpuPieces::upload(const FrameScene& scene, std::span<const DrawItem> items, const std::vector<Run>& runs,
                       List& list) {
  std::vector<GpuCluster> clusters;
  std::vector<GpuRun> gpu_runs;
  std::size_t item = 0;
  std::uint32_t counts = 0;
  for (const Run& run : runs) {
    const auto first_cluster = static_cast<std::uint32_t>(item);
    std::uint32_t indices = 0;
    for (; item < items.size() && indices < run.index_count; ++item) {
      const DrawItem& it = items[item];
      const bool double_sided = scene.gpu.features(it.material) & feature_double_sided;
      clusters.push_back({glm::vec4(it.center, it.radius),
                          {it.first_index / 3, it.index_count / 3, double_sided ? 1u : 0u, counts}});
      counts += items_of(it.index_count / 3);
      indices += it.index_count;
    }
    gpu_runs.push_back({{first_cluster, static_cast<std::uint32_t>(item) - first_cluster, run.first_index / 3,
                         run.index_count / 3}});
  }
  refill(list.clusters, clusters.data(), clusters.size() * sizeof(GpuCluster));
  refill(list.runs, gpu_runs.data(), gpu_runs.size() * sizeof(GpuRun));
  refill(list.offsets, nullptr, clusters.size() * sizeof(std::uint32_t));
  refill(list.counts, nullptr, counts * sizeof(std::uint32_t));
  refill(list.commands, nullptr, runs.size() * (list.rounds + 1) * sizeof(DrawCommand));
  list.cluster_count = clusters.size();
  list.run_count = runs.size();
}

/// Space for more pairs than the last frame known had. Where the ceiling forbids it, rounds instead.
void GpuPieces::make_room(List& list, std::uint64_t triangles, std::uint64_t max_pairs) const {
  if (!list.control) {
    list.control = gl::Buffer::make();
    glNamedBufferStorage(list.control.id(), control_bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
    list.read_back = gl::Buffer::make();
    constexpr GLbitfield flags = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glNamedBufferStorage(list.read_back.id(), control_bytes, nullptr, flags);
    list.mapped = static_cast<const std::uint32_t*>(
        glMapNamedBufferRange(list.read_back.id(), 0, control_bytes, flags));
    list.pairs = gl::Buffer::make();
  }
  if (list.mapped != nullptr && list.fence.ended()) list.last_total = list.mapped[0];
  // Before the first count is known, and after a leap: each triangle twice, and some that fill all pieces.
  const std::uint64_t guess = 2 * triangles + 32 * piece_count_;
  const std::uint64_t needed = std::max(guess, list.last_total + list.last_total / 4);
  const std::uint64_t wanted = std::max(guess, 2 * list.last_total);
  const std::uint64_t ceiling = std::min(max_pairs, most_capacity);
  if (std::min(needed, ceiling) > list.pair_capacity || list.pair_capacity > ceiling) {
    list.pair_capacity = std::min(wanted, ceiling);
    glNamedBufferData(list.pairs.id(), static_cast<GLsizeiptr>(list.pair_capacity * 8), nullptr,
                      GL_DYNAMIC_COPY);
  }
  const std::uint64_t all = std::min(wanted, most_pairs - list.pair_capacity);
  list.rounds = needed <= list.pair_capacity
                    ? 1
                    : static_cast<std::uint32_t>(
                          std::min(most_rounds, (all + list.pair_capacity - 1) / list.pair_capacity));
}

void GpuPieces::bind_buffers(const FrameScene& scene, const List& list) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, scene.gpu.vertices());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, scene.gpu.indices());
  bind(2, list.clusters, list.cluster_count * sizeof(GpuCluster));
  bind(3, pieces_);
  bind(4, list.pairs);
  bind(5, list.control);
  bind(6, search_);
  bind(7, list.offsets);
  bind(8, list.runs, list.run_count * sizeof(GpuRun));
  bind(9, list.commands);
  if (!strips_) bind(10, rays_);
  bind(11, list.counts);
}

void GpuPieces::draw_round(ScenePass& pass, const FrameScene& scene, const std::vector<Run>& runs,
                           const List& list, std::uint32_t round, float style_scale) const {
  constexpr GLint location_rest = 13, location_overlap = 14;
  glBindVertexArray(empty_array_.id());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, list.commands.id());
  const auto command = [&](std::size_t run, std::size_t number) {
    return reinterpret_cast<const void*>((run * (list.rounds + 1) + number) * sizeof(DrawCommand));
  };
  for (std::size_t run = 0; run < runs.size(); ++run) {
    pass.bind_program(scene, VertexPath::replicated, runs[run].material, style_scale, {}, {});
    const bool blended =
        scene.gpu.scene().materials[runs[run].material].alpha_mode == content::AlphaMode::blend;
    glUniform1f(location_overlap, blended ? 0.0f : 1.0f);
    glUniform1i(location_rest, 0);
    glDrawArraysIndirect(GL_TRIANGLES, command(run, round));
    if (round + 1 < list.rounds) continue;
    glUniform1i(location_rest, 1);
    glDrawArraysIndirect(GL_TRIANGLES, command(run, list.rounds));
  }
}

void GpuPieces::draw_list(const Programs& programs, ScenePass& pass, const FrameScene& scene,
                          std::span<const DrawItem> items, List& list, std::uint64_t max_pairs,
                          float style_scale) {
  if (items.empty()) {
    list.last_total = 0;
    return;
  }
  std::uint64_t triangles = 0;
  for (const DrawItem& item : items) triangles += item.index_count / 3;
  make_room(list, triangles, max_pairs);
  const std::vector<Run> runs = join_runs(items);
  upload(scene, items, runs, list);
  bind_buffers(scene, list);

  const Programs::Binning& binning = strips_ ? programs.strips : programs.triangles;
  const auto capacity = static_cast<GLuint>(list.pair_capacity);
  const auto groups = static_cast<GLuint>(list.cluster_count);
  const GLuint across = std::min(groups, work_groups_x), down = (groups + work_groups_x - 1) / work_groups_x;
  glUseProgram(binning.count.id());
  glDispatchCompute(across, down, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glUseProgram(programs.offsets.id());
  glUniform1ui(0, capacity);
  glUniform1ui(1, static_cast<GLuint>(piece_count_));
  glUniform1ui(2, list.rounds);
  glUniform1ui(3, capacity * list.rounds);
  glDispatchCompute(1, 1, 1);
  for (std::uint32_t round = 0; round < list.rounds; ++round) {
    // Also behind the draws of the round before, which read the list.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glUseProgram(binning.emit.id());
    glUniform1ui(4, capacity);
    glUniform1ui(5, round * capacity);
    glDispatchCompute(across, down, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    draw_round(pass, scene, runs, list, round, style_scale);
  }
  if (list.fence.ended()) {
    glCopyNamedBufferSubData(list.control.id(), list.read_back.id(), 0, 0, control_bytes);
    list.fence = gl::Fence::insert();
  }
}

DrawCounts GpuPieces::draw(const Programs& programs, ScenePass& pass, const FrameScene& scene,
                           std::uint64_t max_pairs, float style_scale) {
  if (strips_)
    for (const gl::Program* program : {&programs.strips.count, &programs.strips.emit}) {
      glProgramUniformMatrix3fv(program->id(), 0, 1, GL_FALSE, glm::value_ptr(axes_from_view_));
      glProgramUniform1i(program->id(), 2, static_cast<GLint>(piece_count_));
      glProgramUniform1i(program->id(), 3, full_turn_ ? 1 : 0);
    }
  for (GLenum plane = 0; plane < 3; ++plane) glEnable(GL_CLIP_DISTANCE0 + plane);
  DrawCounts counts;
  const std::array lists{std::span<const DrawItem>(scene.list.opaque),
                         std::span<const DrawItem>(scene.list.blended)};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    draw_list(programs, pass, scene, lists[i], lists_[i], max_pairs, style_scale);
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
