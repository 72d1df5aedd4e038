#include "renderer/passes/scene_programs.h"

#include <array>
#include <string>

#include "renderer/gl/shader.h"
#include "renderer/passes/gpu_scene.h"

namespace cupola::passes {

namespace {

std::vector<std::string> defines_of(VertexPath path, const FrameVariant& frame, std::uint32_t features) {
  static constexpr std::array path_names{"CUPOLA_DIRECT", "CUPOLA_LAYERED", "CUPOLA_EMITTED",
                                         "CUPOLA_REPLICATED"};
  static constexpr std::array<const char*, material_feature_count> feature_names{
      "CUPOLA_BASE_COLOR_MAP", "CUPOLA_METALLIC_ROUGHNESS_MAP", "CUPOLA_NORMAL_MAP",
      "CUPOLA_EMISSIVE_MAP",   "CUPOLA_OCCLUSION_MAP",          "CUPOLA_UNLIT",
      "CUPOLA_MASK",           "CUPOLA_DOUBLE_SIDED",           "CUPOLA_FOGLESS"};
  std::vector<std::string> defines{path_names[static_cast<std::size_t>(path)]};
  for (std::size_t bit = 0; bit < feature_names.size(); ++bit)
    if (features & (1u << bit)) defines.emplace_back(feature_names[bit]);
  if (frame.lights) defines.emplace_back("CUPOLA_LIGHTS");
  if (frame.shades_uncovered) defines.emplace_back("CUPOLA_UNCOVERED");
  if (path == VertexPath::emitted && per_strip_scissors()) defines.emplace_back("CUPOLA_SCISSORS");
  const bool wireframe = frame.style == model::StyleKind::wireframe;
  const bool edges = wireframe || frame.primitives;
  if (edges) defines.emplace_back("CUPOLA_EDGES");
  if (wireframe) defines.emplace_back("CUPOLA_WIREFRAME");
  if (frame.primitives) defines.emplace_back("CUPOLA_PRIMITIVES");
  if (frame.style == model::StyleKind::hatching) defines.emplace_back("CUPOLA_HATCHING");
  // Edges need corners told apart, so vertices are fetched by number instead of shared by index.
  if (path == VertexPath::replicated || (edges && path != VertexPath::emitted))
    defines.emplace_back("CUPOLA_PULL");
  return defines;
}

} // namespace

bool per_strip_scissors() { return epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array"); }

GLuint ScenePrograms::get(VertexPath path, const FrameVariant& frame, std::uint32_t features) {
  const std::uint32_t key = features | static_cast<std::uint32_t>(frame.lights) << 16 |
                            static_cast<std::uint32_t>(frame.shades_uncovered) << 17 |
                            static_cast<std::uint32_t>(frame.primitives) << 18 |
                            static_cast<std::uint32_t>(frame.style) << 20 |
                            static_cast<std::uint32_t>(path) << 24;
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second.id();
  model::Result<gl::Program> made =
      gl::build_program({"scene",
                         {{GL_VERTEX_SHADER, "renderer/passes/scene.vert.glsl"},
                          {GL_FRAGMENT_SHADER, "renderer/passes/scene.frag.glsl"}},
                         defines_of(path, frame, features)});
  if (!made) {
    problems_.insert(problems_.end(), made.error().begin(), made.error().end());
    return programs_.emplace(key, gl::Program()).first->second.id();
  }
  return programs_.emplace(key, std::move(*made)).first->second.id();
}

model::Problems ScenePrograms::take_problems() { return std::exchange(problems_, {}); }

} // namespace cupola::passes
