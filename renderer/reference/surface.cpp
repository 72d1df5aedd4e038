#include "renderer/reference/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace cupola::reference {
namespace {

namespace shading = content::shading;

constexpr float max_probes = 16.0f; ///< along the longer axis of a footprint, as 16x anisotropic filtering
constexpr float flat_derivative = 1e-9f;

/// A texture's coordinates at a crossing, and their change per output pixel.
struct Mapped {
  glm::vec2 uv, per_x, per_y;
};

Mapped mapped(const std::array<glm::vec2, 3>& uvs, const Crossing& crossing, const glm::mat3& transform) {
  glm::dvec2 uv(0.0), per_x(0.0), per_y(0.0);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec2 corner(uvs[static_cast<std::size_t>(i)]);
    uv += crossing.weights[i] * corner;
    per_x += crossing.per_x[i] * corner;
    per_y += crossing.per_y[i] * corner;
  }
  return {glm::vec2(transform * glm::vec3(glm::vec2(uv), 1.0f)),
          glm::vec2(transform * glm::vec3(glm::vec2(per_x), 0.0f)),
          glm::vec2(transform * glm::vec3(glm::vec2(per_y), 0.0f))};
}

/// The footprint of a sample on a texture: an ellipse; its longer axis, and texels across its shorter one.
struct Footprint {
  glm::vec2 axis; ///< the whole longer diameter, in uv
  float longer, shorter;
};

Footprint footprint(const Mapped& at, glm::vec2 texels, float sample_width) {
  const glm::vec2 x = at.per_x * texels * sample_width, y = at.per_y * texels * sample_width;
  const float a = x.x * x.x + y.x * y.x, b = x.x * x.y + y.x * y.y, c = x.y * x.y + y.y * y.y;
  const float middle = 0.5f * (a + c);
  const float spread = std::sqrt(0.25f * (a - c) * (a - c) + b * b);
  const float longer = std::sqrt(middle + spread);
  const float shorter = std::sqrt(std::max(middle - spread, 0.0f));
  // The eigenvector of the larger eigenvalue, from the row that is farther from zero.
  glm::vec2 direction = a >= c ? glm::vec2(middle + spread - c, b) : glm::vec2(b, middle + spread - a);
  const float length = glm::length(direction);
  direction = length > 0.0f ? direction / length : glm::vec2(1.0f, 0.0f);
  return {direction * longer / texels, longer, shorter};
}

glm::vec4 sample_texture(const World& world, const Shading& how, const content::TextureUse& use,
                         const std::array<glm::vec2, 3>& uvs, const Crossing& crossing) {
  const content::Texture& texture = world.scene->textures[static_cast<std::size_t>(use.texture)];
  const content::MipChain& image = world.images[static_cast<std::size_t>(texture.image)];
  if (image.levels.empty()) return glm::vec4(1.0f);
  const Mapped at = mapped(uvs, crossing, use.transform);
  const glm::vec2 texels(image.levels.front().width, image.levels.front().height);
  const Footprint print = footprint(at, texels, how.sample_width);
  if (!(print.longer > 1.0f) ||
      !std::isfinite(print.longer)) // magnified; or an edge-on triangle: the smallest level
    return content::sample(image, texture, at.uv,
                           std::isfinite(print.longer) && print.longer <= 1.0f ? 0.0f : 32.0f);
  const float width = std::max({print.shorter, print.longer / max_probes, 1.0f});
  const auto probes = static_cast<int>(std::ceil(print.longer / width - 1e-3f));
  const float lod = std::log2(width);
  if (probes <= 1) return content::sample(image, texture, at.uv, lod);
  glm::vec4 sum(0.0f);
  for (int i = 0; i < probes; ++i) {
    const float place = (static_cast<float>(i) + 0.5f) / static_cast<float>(probes) - 0.5f;
    sum += content::sample(image, texture, at.uv + place * print.axis, lod);
  }
  return sum / static_cast<float>(probes);
}

struct Corners {
  std::array<const content::Vertex*, 3> vertices;
  std::array<glm::vec2, 3> uvs;
};

Corners corners_of(const World& world, std::uint32_t triangle) {
  Corners corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    corners.vertices[i] = &world.vertices()[world.scene->geometry.indices[3 * std::size_t{triangle} + i]];
    corners.uvs[i] = corners.vertices[i]->uv;
  }
  return corners;
}

glm::vec4 unpacked(std::uint32_t color) {
  return glm::vec4(color & 255u, color >> 8 & 255u, color >> 16 & 255u, color >> 24) / 255.0f;
}

glm::vec4 base_color(const World& world, const Shading& how, const content::Material& material,
                     const Corners& corners, const Crossing& crossing) {
  glm::vec4 color(0.0f);
  for (int i = 0; i < 3; ++i)
    color += static_cast<float>(crossing.weights[i]) *
             unpacked(corners.vertices[static_cast<std::size_t>(i)]->color);
  color *= material.base_color;
  if (material.base_color_map.texture >= 0)
    color *= sample_texture(world, how, material.base_color_map, corners.uvs, crossing);
  return color;
}

/// Change of the place on the triangle per output pixel.
glm::vec3 moved(const SeenTriangle& triangle, const glm::dvec3& weights) {
  return glm::vec3(weights.x * triangle.corners[0] + weights.y * triangle.corners[1] +
                   weights.z * triangle.corners[2]);
}

/// The normal tilted by the normal map, in the frame in which u and v rise over the triangle: twin of
/// mapped_normal in renderer/passes/scene.frag.glsl.
glm::vec3 mapped_normal(const World& world, const Shading& how, const content::Material& material,
                        const SeenTriangle& triangle, const Corners& corners, const Crossing& crossing,
                        const glm::vec3& normal) {
  const Mapped at = mapped(corners.uvs, crossing, material.normal_map.transform);
  const glm::vec3 across2 = glm::cross(moved(triangle, crossing.per_y), normal);
  const glm::vec3 across1 = glm::cross(normal, moved(triangle, crossing.per_x));
  const glm::vec3 tangent = across2 * at.per_x.x + across1 * at.per_y.x;
  const glm::vec3 bitangent = across2 * at.per_x.y + across1 * at.per_y.y;
  const float scale =
      1.0f / std::sqrt(std::max({glm::dot(tangent, tangent), glm::dot(bitangent, bitangent), 1e-30f}));
  glm::vec3 tilt =
      glm::vec3(sample_texture(world, how, material.normal_map, corners.uvs, crossing)) * 2.0f - 1.0f;
  tilt.x *= material.normal_scale;
  tilt.y *= material.normal_scale;
  return glm::normalize(tangent * scale * tilt.x + bitangent * scale * tilt.y + normal * tilt.z);
}

shading::Surface surface_at(const World& world, const Shading& how, const SeenTriangle& triangle,
                            const Crossing& crossing, const Corners& corners,
                            const content::Material& material) {
  const glm::vec4 base = base_color(world, how, material, corners, crossing);
  const glm::vec3 offset = moved(triangle, crossing.weights);
  glm::vec3 normal(0.0f);
  for (int i = 0; i < 3; ++i)
    normal += static_cast<float>(crossing.weights[i]) * corners.vertices[static_cast<std::size_t>(i)]->normal;
  shading::Surface surface;
  surface.base = glm::vec3(base);
  surface.alpha = base.a;
  surface.metallic = material.metallic;
  surface.roughness = material.roughness;
  surface.emissive = material.emissive;
  surface.occlusion = 1.0f;
  surface.distance = std::max(glm::length(offset), 1e-20f);
  surface.to_eye = offset / -surface.distance;
  if (!(glm::dot(normal, normal) > 0.0f))
    normal = glm::vec3(glm::normalize(triangle.plane)); // the mesh has none
  surface.normal = glm::normalize(normal);
  if (material.double_sided && !crossing.front) surface.normal = -surface.normal;
  if (material.metallic_roughness_map.texture >= 0) {
    const glm::vec4 value =
        sample_texture(world, how, material.metallic_roughness_map, corners.uvs, crossing);
    surface.roughness *= value.g;
    surface.metallic *= value.b;
  }
  if (material.normal_map.texture >= 0)
    surface.normal = mapped_normal(world, how, material, triangle, corners, crossing, surface.normal);
  if (material.emissive_map.texture >= 0)
    surface.emissive *= glm::vec3(sample_texture(world, how, material.emissive_map, corners.uvs, crossing));
  if (material.occlusion_map.texture >= 0)
    surface.occlusion =
        glm::mix(1.0f, sample_texture(world, how, material.occlusion_map, corners.uvs, crossing).r,
                 material.occlusion_strength);
  return surface;
}

glm::vec3 punctual_light(const content::Light& light, const shading::Surface& surface,
                         const glm::vec3& position) {
  glm::vec3 toward = -light.direction;
  float attenuation = 1.0f;
  if (light.kind != content::LightKind::directional) {
    const glm::vec3 path = light.position - position;
    const float distance = glm::length(path);
    toward = path / std::max(distance, 1e-6f);
    attenuation = shading::punctual_attenuation(distance, light.range);
    if (light.kind == content::LightKind::spot)
      attenuation *= shading::spot_attenuation(toward, light.direction, light.cos_inner, light.cos_outer);
  }
  return shading::shade_light(surface, toward, light.radiance * attenuation);
}

/// Distances in output pixels to the three edges.
glm::vec3 edge_pixels(const Crossing& crossing) {
  const glm::vec3 x(crossing.per_x), y(crossing.per_y);
  return glm::vec3(crossing.weights) / glm::max(glm::sqrt(x * x + y * y), glm::vec3(flat_derivative));
}

} // namespace

SeenTriangle see_triangle(const World& world, std::uint32_t triangle, const glm::dvec3& eye) {
  SeenTriangle seen;
  seen.triangle = triangle;
  for (std::size_t i = 0; i < 3; ++i)
    seen.corners[i] =
        glm::dvec3(world.vertices()[world.scene->geometry.indices[3 * std::size_t{triangle} + i]].position) -
        eye;
  for (std::size_t i = 0; i < 3; ++i)
    seen.planes[i] = glm::cross(seen.corners[(i + 1) % 3], seen.corners[(i + 2) % 3]);
  // Not the sum of the three, which cancels for a small triangle far away.
  seen.plane = glm::cross(seen.corners[1] - seen.corners[0], seen.corners[2] - seen.corners[0]);
  return seen;
}

Crossing cross_triangle(const SeenTriangle& triangle, const Ray& ray) {
  Crossing crossing{};
  const double whole = glm::dot(triangle.plane, ray.direction);
  crossing.front = whole < 0.0;
  const double inverse = whole != 0.0 ? 1.0 / whole : 0.0;
  const double whole_x = glm::dot(triangle.plane, ray.per_x) * inverse;
  const double whole_y = glm::dot(triangle.plane, ray.per_y) * inverse;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3& plane = triangle.planes[static_cast<std::size_t>(i)];
    crossing.weights[i] = glm::dot(plane, ray.direction) * inverse;
    crossing.per_x[i] = glm::dot(plane, ray.per_x) * inverse - crossing.weights[i] * whole_x;
    crossing.per_y[i] = glm::dot(plane, ray.per_y) * inverse - crossing.weights[i] * whole_y;
  }
  return crossing;
}

float base_alpha(const World& world, const Shading& how, const SeenTriangle& triangle,
                 const Crossing& crossing) {
  return base_color(world, how, world.material(triangle.triangle), corners_of(world, triangle.triangle),
                    crossing)
      .a;
}

glm::vec4 surface_color(const World& world, const Shading& how, const SeenTriangle& triangle,
                        const Crossing& crossing, glm::vec2 pixel) {
  const content::Material& material = world.material(triangle.triangle);
  const Corners corners = corners_of(world, triangle.triangle);
  const shading::Surface surface = surface_at(world, how, triangle, crossing, corners, material);

  glm::vec3 color = surface.base + surface.emissive;
  if (!material.unlit) {
    color = shading::shade(surface, how.lighting);
    const glm::vec3 position = moved(triangle, crossing.weights) + glm::vec3(how.eye);
    for (const content::Light& light : world.lights()) color += punctual_light(light, surface, position);
    color = shading::tone(color);
  }
  if (!material.fogless) color = shading::apply_fog(color, surface.distance, how.lighting);

  const auto width = static_cast<float>(how.style.line_width);
  if (how.style.kind == model::StyleKind::hatching)
    color = shading::hatch(pixel, shading::luminance(color), static_cast<float>(how.style.line_spacing),
                           width, how.sample_width);
  if (how.style.kind == model::StyleKind::wireframe)
    color = shading::wireframe(shading::luminance(color),
                               shading::wire_coverage(edge_pixels(crossing), width, how.sample_width),
                               surface.distance, static_cast<float>(how.style.line_fade));
  return {color,
          material.alpha_mode == content::AlphaMode::blend ? std::clamp(surface.alpha, 0.0f, 1.0f) : 1.0f};
}

} // namespace cupola::reference
