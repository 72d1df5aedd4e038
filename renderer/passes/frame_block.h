// The uniform block of a frame: eye, light and style, for all programs. Render thread only.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat3x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "configs/model/show.h"
#include "renderer/content/scene.h"
#include "renderer/gl/handle.h"
#include "renderer/plan/camera.h"

namespace cupola::passes {

inline constexpr std::size_t max_lights = 16;

/// Twin of renderer/shaders/frame.glsl, std140.
struct FrameBlock {
  glm::vec4 eye_near;
  glm::mat3x4 view_from_world;
  glm::vec4 sun_direction, sun_color, zenith, ground, fog, style;
  glm::ivec4 counts;
  struct Light {
    glm::vec4 position_range, direction_kind, radiance, cone;
  };
  std::array<Light, max_lights> lights;
};

/// `lights` beyond max_lights are left out (the scene's loader has said so).
[[nodiscard]] FrameBlock make_frame_block(const model::Show& show, const plan::CameraPose& camera,
                                          const std::vector<content::Light>& lights);

} // namespace cupola::passes
