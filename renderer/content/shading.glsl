// How light meets a surface, and how styles are drawn. One source for two languages: shaders include this file as it
// is, C++ through shading.h. So it keeps to what GLSL 4.50 and GLM share: literals end in f, no inout, no array.
// All colours are linear. Order of use for one fragment:
//   lit:   apply_fog(tone(shade(s, l) + sum of shade_light(s, ...)), s.distance, l)
//   unlit: apply_fog(s.base + s.emissive, s.distance, l)
//   a material without fog (a sky) leaves apply_fog out.
#ifndef CUPOLA_FN
#define CUPOLA_FN
#endif

const float shading_pi = 3.14159265f;

/// What is known about the visible point; all vectors of unit length, in world space.
struct Surface {
  vec3 base;       // base colour, linear
  float alpha;     // coverage, 0 to 1
  float metallic;  // 0 to 1
  float roughness; // 0 to 1, as glTF: the square is the width of the highlight
  vec3 emissive;
  float occlusion; // 1: open to the sky
  vec3 normal;     // on the side of the eye
  vec3 to_eye;     // from the point to the eye
  float distance;  // metres to the eye
};

/// Light of the whole scene. An even white surface that faces the sun becomes as bright as sun_color.
struct Lighting {
  vec3 sun_direction; // towards the sun
  vec3 sun_color;     // colour times intensity
  vec3 zenith;        // ambient light from above
  vec3 ground;        // ambient light from below
  vec3 fog_color;
  float fog_density; // per metre
};

/// Reflectance of the surface seen at a right angle: 4 % for a dielectric, the colour for a metal.
CUPOLA_FN vec3 specular_color(Surface s) { return mix(vec3(0.04f), s.base, s.metallic); }

/// Light of one direction, reflected to the eye: Lambert and GGX (Smith's masking in Hammon's cheap form, Schlick's
/// Fresnel), as glTF 2.0 appendix B. radiance: lux of a directional light, candela times attenuation of a point light.
CUPOLA_FN vec3 shade_light(Surface s, vec3 toward_light, vec3 radiance) {
  float nl = dot(s.normal, toward_light);
  if (nl <= 0.0f) return vec3(0.0f);
  vec3 halfway = normalize(toward_light + s.to_eye);
  float nv = max(dot(s.normal, s.to_eye), 1e-3f);
  float nh = clamp(dot(s.normal, halfway), 0.0f, 1.0f);
  float vh = clamp(dot(s.to_eye, halfway), 0.0f, 1.0f);
  float a = max(s.roughness * s.roughness, 0.02f);
  float a2 = a * a;
  float d = nh * nh * (a2 - 1.0f) + 1.0f;
  float distribution = a2 / (d * d);
  float masking = 0.5f / mix(2.0f * nl * nv, nl + nv, a);
  float m = 1.0f - vh;
  float m2 = m * m;
  vec3 f0 = specular_color(s);
  vec3 fresnel = f0 + (vec3(1.0f) - f0) * (m2 * m2 * m);
  vec3 diffuse = s.base * (1.0f - s.metallic) * (vec3(1.0f) - fresnel);
  return radiance * (nl / shading_pi) * (diffuse + fresnel * (distribution * masking));
}

/// The hemisphere's light that arrives from a direction (or around a normal) with this height.
CUPOLA_FN vec3 hemisphere(float height, Lighting l) { return mix(l.ground, l.zenith, height * 0.5f + 0.5f); }

/// Sun, hemisphere (diffuse, and mirrored by what is smooth or metallic), and the surface's own light.
CUPOLA_FN vec3 shade(Surface s, Lighting l) {
  vec3 sun = shade_light(s, l.sun_direction, l.sun_color * shading_pi);
  float nv = clamp(dot(s.normal, s.to_eye), 0.0f, 1.0f);
  float m = 1.0f - nv;
  float m2 = m * m;
  vec3 f0 = specular_color(s);
  float smoothness = 1.0f - s.roughness;
  vec3 fresnel = f0 + (max(vec3(smoothness), f0) - f0) * (m2 * m2 * m);
  float mirrored = 2.0f * nv * s.normal.y - s.to_eye.y; // height of the mirrored ray
  vec3 glossy = fresnel * hemisphere(mix(mirrored, s.normal.y, s.roughness), l);
  vec3 diffuse = s.base * (1.0f - s.metallic) * (vec3(1.0f) - fresnel) * hemisphere(s.normal.y, l);
  return sun + (diffuse + glossy) * s.occlusion + s.emissive;
}

/// Keeps sums of light displayable: unchanged to 0.8, then a shoulder that nears 1 (slope continuous).
CUPOLA_FN vec3 tone(vec3 color) {
  vec3 over = max(color - vec3(0.8f), vec3(0.0f)) * 5.0f;
  return min(color, vec3(0.8f)) + 0.2f * over / (vec3(1.0f) + over);
}

CUPOLA_FN vec3 apply_fog(vec3 color, float distance, Lighting l) {
  if (l.fog_density <= 0.0f) return color;
  return mix(l.fog_color, color, exp(-l.fog_density * distance));
}

/// Falling off with the square of the distance, to nothing at `range` (0: no bound) [KHR_lights_punctual].
CUPOLA_FN float punctual_attenuation(float distance, float range) {
  float d2 = max(distance * distance, 1e-4f);
  if (range <= 0.0f) return 1.0f / d2;
  float q = distance / range;
  float q2 = q * q;
  return clamp(1.0f - q2 * q2, 0.0f, 1.0f) / d2;
}

/// The cone of a spot light: 1 inside the inner angle, 0 outside the outer one. shines: the spot's direction.
CUPOLA_FN float spot_attenuation(vec3 toward_light, vec3 shines, float cos_inner, float cos_outer) {
  float scale = 1.0f / max(cos_inner - cos_outer, 1e-3f);
  float cone = clamp((-dot(toward_light, shines) - cos_outer) * scale, 0.0f, 1.0f);
  return cone * cone;
}

CUPOLA_FN float luminance(vec3 color) { return dot(color, vec3(0.2126f, 0.7152f, 0.0722f)); }

// ---- styles: all lengths in output pixels -------------------------------------------------------------------------

/// How much a line covers of a sample's square, which is `footprint` wide, at a distance from the line's middle:
/// exact where the line is straight and runs along the square's sides.
CUPOLA_FN float line_coverage(float distance, float half_width, float footprint) {
  float half_print = 0.5f * footprint;
  float inside = min(distance + half_print, half_width) - max(distance - half_print, -half_width);
  return clamp(inside / footprint, 0.0f, 1.0f);
}

/// How much of a sample a triangle's edges cover. edge_px: distances of its place to the three edges. width: of the
/// whole line, of which each of the two triangles at an edge draws its half.
CUPOLA_FN float wire_coverage(vec3 edge_px, float width, float footprint) {
  return line_coverage(min(edge_px.x, min(edge_px.y, edge_px.z)), 0.5f * width, footprint);
}

/// Solid wireframe: dark lines over a pale surface that keeps its shape by its luminance; lines fade with distance
/// (half as strong at `cue` metres), so that near edges stand out and far ones do not turn the picture black.
CUPOLA_FN vec3 wireframe(float luma, float coverage, float distance, float cue) {
  vec3 fill = mix(vec3(0.30f, 0.34f, 0.40f), vec3(0.93f, 0.94f, 0.95f), clamp(luma * 1.4f, 0.0f, 1.0f));
  float strength = cue / (cue + distance);
  return mix(fill, vec3(0.02f, 0.03f, 0.05f), coverage * strength);
}

/// One family of parallel strokes: coverage of the sample at `across` (pixels across the strokes) and `along`.
CUPOLA_FN float strokes(float across, float along, float spacing, float width, float footprint) {
  float row = floor(across / spacing);
  float waver = 0.08f * spacing * sin(along * 0.045f + row * 2.4f);
  float offset = abs(across + waver - (row + 0.5f) * spacing);
  return line_coverage(offset, 0.5f * width, footprint);
}

/// Pen and ink: strokes that thicken with darkness, a second direction across them in the dark parts.
/// pixel: position in the output; luma: linear luminance of the lit surface, 0 black to 1 white; footprint: of a
/// sample.
CUPOLA_FN vec3 hatch(vec2 pixel, float luma, float spacing, float width, float footprint) {
  float darkness = 1.0f - sqrt(clamp(luma, 0.0f, 1.0f));
  float u = (pixel.x + pixel.y) * 0.70710678f;
  float v = (pixel.x - pixel.y) * 0.70710678f;
  float first = clamp((darkness - 0.12f) * 2.0f, 0.0f, 1.0f);
  float second = clamp((darkness - 0.45f) * 2.4f, 0.0f, 1.0f);
  float ink = strokes(u, v, spacing, width * first * 1.6f, footprint);
  ink = max(ink, strokes(v, u, spacing, width * second * 1.6f, footprint));
  return mix(vec3(0.92f, 0.89f, 0.82f), vec3(0.03f, 0.03f, 0.06f), ink);
}
