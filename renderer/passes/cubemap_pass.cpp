#include "renderer/passes/cubemap_pass.h"

#include <array>
#include <glm/matrix.hpp>

namespace cupola::passes {

glm::dmat3 cube_face_matrix(int face) {
  return glm::transpose(plan::cube_face_axes()[static_cast<std::size_t>(face)]);
}

bool layered_rendering_available() { return epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array"); }

namespace {

void clear_current(const glm::vec3& background) {
  glClearColor(background.r, background.g, background.b, 1.0f);
  glClearDepth(0.0);
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

DrawCounts draw_faces_layered(ScenePass& pass, const FrameScene& scene, const plan::CubemapPlan& plan,
                              const CubemapTarget& target, const glm::vec3& background, float style_scale) {
  std::array<glm::dmat3, 6> matrices;
  std::vector<int> layers;
  for (int face = 0; face < 6; ++face) {
    const auto at = static_cast<std::size_t>(face);
    matrices[at] = cube_face_matrix(face);
    if (!plan.faces[at].seen) continue;
    layers.push_back(face);
    const plan::PixelRect& crop = plan.faces[at].crop;
    const auto index = static_cast<GLuint>(face);
    glViewportIndexedf(index, 0, 0, static_cast<float>(plan.size), static_cast<float>(plan.size));
    glScissorIndexed(index, crop.x, crop.y, crop.width, crop.height);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer(0));
  glDisable(GL_SCISSOR_TEST);
  clear_current(background);
  glEnable(GL_SCISSOR_TEST);
  const DrawCounts counts = pass.draw_layered(scene, matrices, layers, style_scale);
  glDisable(GL_SCISSOR_TEST); // it would cut the resolving blits
  for (const int face : layers) target.resolve(face);
  return counts;
}

} // namespace

DrawCounts draw_cubemap(ScenePass& pass, const FrameScene& scene, const plan::CubemapPlan& plan,
                        const CubemapTarget& target, const glm::vec3& background, float style_scale) {
  DrawCounts counts;
  if (target.layered()) {
    counts = draw_faces_layered(pass, scene, plan, target, background, style_scale);
  } else {
    for (int face = 0; face < 6; ++face) {
      const plan::CubeFace& seen = plan.faces[static_cast<std::size_t>(face)];
      if (!seen.seen) continue;
      glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer(face));
      glViewport(0, 0, plan.size, plan.size);
      glEnable(GL_SCISSOR_TEST);
      glScissor(seen.crop.x, seen.crop.y, seen.crop.width, seen.crop.height);
      clear_current(background);
      counts += pass.draw_direct(scene, cube_face_matrix(face), style_scale);
      glDisable(GL_SCISSOR_TEST);
      target.resolve(face);
    }
  }
  glDisable(GL_SCISSOR_TEST);
  target.finish();
  return counts;
}

} // namespace cupola::passes
