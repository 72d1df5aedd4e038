// Lights a surface point. The same for every method; variants by define for what a material has.
#include "renderer/passes/uncovered.glsl"
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/material.glsl"
#include "renderer/content/shading.glsl"

in vec3 v_offset;
in vec3 v_normal;
in vec2 v_uv;
in vec4 v_color;
#ifdef CUPOLA_EDGES
in vec3 v_corner;
#endif
#if defined(CUPOLA_REPLICATED) && defined(CUPOLA_DOUBLE_SIDED)
flat in uint v_back;
#endif

layout(binding = 0) uniform sampler2D base_color_map;
layout(binding = 1) uniform sampler2D metallic_roughness_map;
layout(binding = 2) uniform sampler2D normal_map;
layout(binding = 3) uniform sampler2D emissive_map;
layout(binding = 4) uniform sampler2D occlusion_map;

/// Pixels of this target per output pixel: lines keep their width in output pixels.
layout(location = 12) uniform float style_scale;

layout(location = 0) out vec4 out_color;

vec2 mapped(mat3 transform) { return uncovered_quad() ? vec2(0.0) : (transform * vec3(v_uv, 1.0)).xy; }

#ifdef CUPOLA_NORMAL_MAP
/// The surface normal tilted by the normal map, in the frame in which u and v rise over the triangle.
vec3 mapped_normal(vec3 normal) {
  vec2 uv = mapped(material.normal_uv);
  vec3 dp1 = dFdx(v_offset), dp2 = dFdy(v_offset);
  vec2 duv1 = dFdx(uv), duv2 = dFdy(uv);
  // Tangents perpendicular to the normal along which u and v rise; their lengths keep their ratio.
  vec3 across2 = cross(dp2, normal), across1 = cross(normal, dp1);
  vec3 tangent = across2 * duv1.x + across1 * duv2.x;
  vec3 bitangent = across2 * duv1.y + across1 * duv2.y;
  float scale = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-30));
  vec3 tilt = texture(normal_map, uv).xyz * 2.0 - 1.0;
  tilt.xy *= material.factors.z;
  return normalize(tangent * scale * tilt.x + bitangent * scale * tilt.y + normal * tilt.z);
}
#endif

Lighting frame_lighting() {
  Lighting lighting;
  lighting.sun_direction = frame.sun_direction.xyz;
  lighting.sun_color = frame.sun_color.rgb;
  lighting.zenith = frame.zenith.rgb;
  lighting.ground = frame.ground.rgb;
  lighting.fog_color = frame.fog.rgb;
  lighting.fog_density = frame.fog.w;
  return lighting;
}

#ifdef CUPOLA_LIGHTS
vec3 punctual_lights(Surface surface, vec3 position) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < frame.counts.x; ++i) {
    PunctualLight light = frame.lights[i];
    int kind = int(light.direction_kind.w);
    vec3 toward = -light.direction_kind.xyz;
    float attenuation = 1.0;
    if (kind != 0) {
      vec3 path = light.position_range.xyz - position;
      float distance = length(path);
      toward = path / max(distance, 1e-6);
      attenuation = punctual_attenuation(distance, light.position_range.w);
      if (kind == 2) attenuation *= spot_attenuation(toward, light.direction_kind.xyz, light.cone.x, light.cone.y);
    }
    sum += shade_light(surface, toward, light.radiance.rgb * attenuation);
  }
  return sum;
}
#endif

#ifdef CUPOLA_EDGES
/// Distances in output pixels to the three edges of the scene's triangle.
vec3 edge_pixels() {
  vec3 dx = dFdx(v_corner), dy = dFdy(v_corner);
  return v_corner / max(sqrt(dx * dx + dy * dy), vec3(1e-9)) / style_scale;
}
#endif

void main() {
  vec4 base = material.base_color * v_color;
#ifdef CUPOLA_BASE_COLOR_MAP
  base *= texture(base_color_map, mapped(material.base_color_uv));
#endif
#ifdef CUPOLA_MASK
  if (base.a < material.emissive_cutoff.w) discard;
  base.a = 1.0;
#endif

  Surface surface;
  surface.base = base.rgb;
  surface.alpha = base.a;
  surface.metallic = material.factors.x;
  surface.roughness = material.factors.y;
  surface.emissive = material.emissive_cutoff.rgb;
  surface.occlusion = 1.0;
  surface.distance = length(v_offset);
  surface.to_eye = v_offset / -surface.distance;
  surface.normal = normalize(v_normal);
#ifdef CUPOLA_DOUBLE_SIDED
#ifdef CUPOLA_REPLICATED
  if (v_back != 0u) surface.normal = -surface.normal;
#else
  if (!gl_FrontFacing) surface.normal = -surface.normal;
#endif
#endif
#ifdef CUPOLA_METALLIC_ROUGHNESS_MAP
  vec4 metal_rough = texture(metallic_roughness_map, mapped(material.metallic_roughness_uv));
  surface.roughness *= metal_rough.g;
  surface.metallic *= metal_rough.b;
#endif
#ifdef CUPOLA_NORMAL_MAP
  surface.normal = mapped_normal(surface.normal);
#endif
#ifdef CUPOLA_EMISSIVE_MAP
  surface.emissive *= texture(emissive_map, mapped(material.emissive_uv)).rgb;
#endif
#ifdef CUPOLA_OCCLUSION_MAP
  surface.occlusion = mix(1.0, texture(occlusion_map, mapped(material.occlusion_uv)).r, material.factors.w);
#endif

  Lighting lighting = frame_lighting();
#ifdef CUPOLA_UNLIT
  vec3 color = surface.base + surface.emissive;
#else
  vec3 color = shade(surface, lighting);
#ifdef CUPOLA_LIGHTS
  color += punctual_lights(surface, v_offset + frame.eye_near.xyz);
#endif
  color = tone(color);
#endif

#ifndef CUPOLA_FOGLESS
  color = apply_fog(color, surface.distance, lighting);
#endif

#ifdef CUPOLA_HATCHING
  color = hatch(gl_FragCoord.xy / style_scale, luminance(color), frame.style.y, frame.style.x, 1.0 / style_scale);
#endif
#ifdef CUPOLA_WIREFRAME
  color = wireframe(luminance(color), wire_coverage(edge_pixels(), frame.style.x, 1.0 / style_scale),
                    surface.distance, frame.style.z);
#endif
#ifdef CUPOLA_PRIMITIVES
  const float primitive_width = 2.5; // output pixels
  color = mix(color, vec3(1.0), wire_coverage(edge_pixels(), primitive_width, 1.0 / style_scale));
#endif
  out_color = vec4(color, surface.alpha);
}
