// The scene's programs, one per combination of vertex path, style and material features; built when first
// wanted. Render thread only.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/gl/handle.h"

namespace cupola::passes {

/// How vertices reach the screen; see scene.vert.glsl.
enum class VertexPath : std::uint8_t { direct, layered, emitted, replicated };

/// The driver lets a vertex program choose among 16 scissors, so 16 strips go into one draw; without, each
/// strip is a draw of its own.
[[nodiscard]] bool per_strip_scissors();

/// What all programs of a frame have in common.
struct FrameVariant {
  model::StyleKind style = model::StyleKind::textured;
  bool lights = false;     ///< the scene has punctual lights
  bool primitives = false; ///< thick edges of the scene's triangles over what is drawn
  /// Multisampled, by a driver that also shades pixels of which no sample is left: see uncovered.glsl.
  bool shades_uncovered = false;
};

class ScenePrograms {
public:
  /// `features`: MaterialFeature bits.
  /// Fails only when the driver refuses a shader; the problem is kept and given once by take_problems().
  [[nodiscard]] GLuint get(VertexPath path, const FrameVariant& frame, std::uint32_t features);
  [[nodiscard]] model::Problems take_problems();

private:
  std::unordered_map<std::uint32_t, gl::Program> programs_;
  model::Problems problems_;
};

} // namespace cupola::passes
