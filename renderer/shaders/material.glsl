// One material; bound anew for each draw. Twin of MaterialBlock in passes/gpu_scene.cpp.

layout(std140, binding = 1) uniform MaterialBlock {
  vec4 base_color;
  vec4 emissive_cutoff;    // rgb, alpha cutoff
  vec4 factors;            // metallic, roughness, normal scale, occlusion strength
  mat3 base_color_uv;
  mat3 metallic_roughness_uv;
  mat3 normal_uv;
  mat3 emissive_uv;
  mat3 occlusion_uv;
} material;
