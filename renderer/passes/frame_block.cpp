#include "renderer/passes/frame_block.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "renderer/content/lighting.h"

namespace cupola::passes {

FrameBlock make_frame_block(const model::Show& show, const plan::CameraPose& camera,
                            const std::vector<content::Light>& lights) {
  const model::Scene& scene = show.scene;
  FrameBlock block{};
  block.eye_near = glm::vec4(glm::vec3(camera.position), static_cast<float>(show.camera.near));
  const glm::mat3 view(glm::transpose(camera.orientation));
  for (int i = 0; i < 3; ++i) block.view_from_world[i] = glm::vec4(view[i], 0.0f);
  const content::shading::Lighting lighting = content::lighting_of(scene);
  block.sun_direction = glm::vec4(lighting.sun_direction, 0.0f);
  block.sun_color = glm::vec4(lighting.sun_color, 0.0f);
  block.zenith = glm::vec4(lighting.zenith, 0.0f);
  block.ground = glm::vec4(lighting.ground, 0.0f);
  block.fog = glm::vec4(lighting.fog_color, lighting.fog_density);
  const model::Style& style = scene.style;
  block.style = {static_cast<float>(style.line_width), static_cast<float>(style.line_spacing),
                 static_cast<float>(style.line_fade), 0.0f};
  const std::size_t count = std::min(lights.size(), max_lights);
  block.counts.x = static_cast<int>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const content::Light& light = lights[i];
    block.lights[i] = {
        glm::vec4(light.position, light.range), glm::vec4(light.direction, static_cast<float>(light.kind)),
        glm::vec4(light.radiance, 0.0f), glm::vec4(light.cos_inner, light.cos_outer, 0.0f, 0.0f)};
  }
  return block;
}

} // namespace cupola::passes
