// Pieces drawn by either engine without a show: a context, a target, a scene, a set of pieces.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "configs/model/show.h"
#include "renderer/content/scene.h"
#include "renderer/outputs/context.h"
#include "renderer/passes/frame_block.h"
#include "renderer/passes/gpu_pieces.h"
#include "renderer/passes/scene_pass.h"
#include "renderer/passes/targets.h"
#include "renderer/plan/plan.h"

namespace cupola::tests {

/// A headless context with the programs of both engines. One for a test program.
struct Engines {
  std::unique_ptr<outputs::Context> context;
  passes::ScenePrograms programs;
  std::optional<passes::ScenePass> pass;
  std::optional<passes::GpuPieces::Programs> compute;

  Engines() {
    auto made = outputs::Context::make_headless([](outputs::MessageLevel, std::string_view) {});
    REQUIRE(made);
    context = std::move(*made);
    REQUIRE(context->make_current());
    pass.emplace(programs);
    auto built = passes::GpuPieces::make_programs();
    REQUIRE(built);
    compute = std::move(*built);
  }
};

inline Engines& engines() {
  static Engines all;
  return all;
}

/// RGBA, GL's row 0 at the bottom.
using Bytes = std::vector<std::uint8_t>;

class PieceDrawing {
public:
  PieceDrawing(std::shared_ptr<const content::Scene> scene, plan::PieceSet set, int size,
               const plan::CameraPose& camera = {}, model::StyleKind style = model::StyleKind::textured)
      : engines_(engines())
      , scene_(std::move(scene))
      , gpu_scene_(scene_, 1)
      , set_(std::move(set))
      , table_(set_)
      , size_(size)
      , target_(size, size, 1, 1)
      , camera_(camera)
      , block_(gl::Buffer::make()) {
    while (!gpu_scene_.upload(1u << 24)) {}
    model::Show show;
    show.camera.near = near;
    show.scene.style.kind = style;
    const passes::FrameBlock block = passes::make_frame_block(show, camera_, scene_->lights);
    glNamedBufferData(block_.id(), sizeof block, &block, GL_STATIC_DRAW);
    const glm::vec3 eye(camera_.position);
    passes::order_for_eye(*scene_, scene_->geometry.clusters, {}, eye, list_);
    if (!list_.blended_indices.empty()) gpu_scene_.set_indices(list_.blended_first, list_.blended_indices);
    frame_.emplace(passes::FrameScene{gpu_scene_,
                                      list_,
                                      {scene_->geometry.vertices,
                                       {},
                                       scene_->geometry.indices,
                                       {list_.blended_indices, list_.blended_first},
                                       scene_->materials},
                                      eye,
                                      glm::mat3(glm::transpose(camera_.orientation)),
                                      near,
                                      style,
                                      !scene_->lights.empty(),
                                      false});
    gpu_.load_triangles(set_, table_, glm::dvec2(size));
  }

  Bytes by_cpu() {
    return drawn([&] { engines_.pass->draw_cells_cpu(*frame_, table_, occlusion_, 64'000'000, 1, [] {}); });
  }
  Bytes by_gpu(std::uint64_t max_pairs = 64'000'000) {
    return drawn([&] { counts = gpu_.draw(*engines_.compute, *engines_.pass, *frame_, max_pairs, 1.0f); });
  }

  /// The list that the GPU engine has filled last: (triangle, piece), in order.
  static std::vector<std::array<std::uint32_t, 2>> pairs() {
    const auto buffer = [](GLuint binding) {
      GLint id = 0;
      glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, binding, &id);
      return static_cast<GLuint>(id);
    };
    std::uint32_t total = 0;
    glGetNamedBufferSubData(buffer(5), 0, sizeof total, &total);
    std::vector<std::array<std::uint32_t, 2>> out(total);
    glGetNamedBufferSubData(buffer(4), 0, static_cast<GLsizeiptr>(total * sizeof out[0]), out.data());
    for (auto& [triangle, piece] : out) piece &= ~(1u << 31);
    return out;
  }

  [[nodiscard]] const plan::PieceSet& set() const { return set_; }
  [[nodiscard]] const content::Scene& scene() const { return *scene_; }
  [[nodiscard]] const plan::CameraPose& camera() const { return camera_; }

  passes::DrawCounts counts;
  glm::vec3 background{0.0f};
  static constexpr float near = 0.05f;

private:
  template <class F>
  Bytes drawn(const F& draw) {
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, block_.id());
    glBindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer());
    glViewport(0, 0, size_, size_);
    glScissor(0, 0, size_, size_);
    glEnable(GL_SCISSOR_TEST);
    passes::set_scene_state();
    glClearColor(background.r, background.g, background.b, 1.0f);
    glClearDepth(0.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw();
    CHECK(glGetError() == GL_NO_ERROR);
    Bytes bytes(static_cast<std::size_t>(size_ * size_) * 4);
    glReadPixels(0, 0, size_, size_, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    return bytes;
  }

  Engines& engines_;
  std::shared_ptr<const content::Scene> scene_;
  passes::GpuScene gpu_scene_;
  plan::PieceSet set_;
  passes::PieceTable table_;
  passes::Occlusion occlusion_;
  int size_;
  passes::OutputTarget target_;
  plan::CameraPose camera_;
  gl::Buffer block_;
  passes::DrawList list_;
  std::optional<passes::FrameScene> frame_;
  passes::GpuPieces gpu_;
};

} // namespace cupola::tests
