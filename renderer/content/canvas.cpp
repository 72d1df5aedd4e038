#include "renderer/content/canvas.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "renderer/content/random.h"

namespace cupola::content {
namespace {

float lattice(int x, int y, int period, std::uint32_t seed) {
  const auto wrap = [period](int v) { return static_cast<std::uint64_t>(((v % period) + period) % period); };
  const std::uint64_t bits = mix_bits(wrap(x) | (wrap(y) << 20) | (std::uint64_t{seed} << 40));
  return static_cast<float>(bits >> 40) * (2.0f / 16777216.0f) - 1.0f;
}

float ease(float t) { return t * t * (3.0f - 2.0f * t); }

} // namespace

float value_noise(float x, float y, int period, std::uint32_t seed) {
  const float left = std::floor(x);
  const float top = std::floor(y);
  const int i = static_cast<int>(left);
  const int j = static_cast<int>(top);
  const float u = ease(x - left);
  const float v = ease(y - top);
  const float upper = lattice(i, j, period, seed) * (1.0f - u) + lattice(i + 1, j, period, seed) * u;
  const float lower = lattice(i, j + 1, period, seed) * (1.0f - u) + lattice(i + 1, j + 1, period, seed) * u;
  return upper * (1.0f - v) + lower * v;
}

float fractal_noise(float x, float y, int period, int octaves, std::uint32_t seed) {
  float sum = 0.0f;
  float strength = 0.6f;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += strength * value_noise(x, y, period, seed + static_cast<std::uint32_t>(octave) * 101U);
    x *= 2.0f;
    y *= 2.0f;
    period *= 2;
    strength *= 0.5f;
  }
  return sum;
}

Canvas::Canvas(int pixels, float extent, Color fill)
    : pixels_(pixels)
    , extent_(extent)
    , texels_(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels), fill) {}

Canvas::Reach Canvas::reach(float low, float high) const {
  const float scale = static_cast<float>(pixels_) / extent_;
  return {std::max(0, static_cast<int>(std::floor(low * scale))),
          std::min(pixels_ - 1, static_cast<int>(std::ceil(high * scale)))};
}

float Canvas::cover(int pixel, float low, float high) const {
  const float scale = static_cast<float>(pixels_) / extent_;
  const auto begin = static_cast<float>(pixel);
  return std::clamp(std::min(begin + 1.0f, high * scale) - std::max(begin, low * scale), 0.0f, 1.0f);
}

void Canvas::rectangle(float left, float top, float right, float bottom, Color color, float opacity) {
  const Reach columns = reach(left, right);
  const Reach rows = reach(top, bottom);
  for (int y = rows.first; y <= rows.last; ++y) {
    const float vertical = cover(y, top, bottom) * opacity;
    if (vertical <= 0.0f) continue;
    for (int x = columns.first; x <= columns.last; ++x)
      at(x, y) = glm::mix(at(x, y), color, vertical * cover(x, left, right));
  }
}

void Canvas::gradient(float left, float top, float right, float bottom, Color upper, Color lower) {
  const Reach columns = reach(left, right);
  const Reach rows = reach(top, bottom);
  for (int y = rows.first; y <= rows.last; ++y) {
    const float vertical = cover(y, top, bottom);
    const float place = (static_cast<float>(y) + 0.5f) * extent_ / static_cast<float>(pixels_);
    const Color color = glm::mix(upper, lower, std::clamp((place - top) / (bottom - top), 0.0f, 1.0f));
    for (int x = columns.first; x <= columns.last; ++x)
      at(x, y) = glm::mix(at(x, y), color, vertical * cover(x, left, right));
  }
}

void Canvas::disc(float x, float y, float radius, Color color, float opacity) {
  const float scale = static_cast<float>(pixels_) / extent_;
  const int low_x = static_cast<int>(std::floor((x - radius) * scale)) - 1;
  const int low_y = static_cast<int>(std::floor((y - radius) * scale)) - 1;
  const int size = static_cast<int>(2.0f * radius * scale) + 3;
  const auto wrapped = [this](int v) { return ((v % pixels_) + pixels_) % pixels_; };
  for (int j = low_y; j <= low_y + size; ++j) {
    for (int i = low_x; i <= low_x + size; ++i) {
      const float dx = static_cast<float>(i) + 0.5f - x * scale;
      const float dy = static_cast<float>(j) + 0.5f - y * scale;
      const float inside = std::clamp(radius * scale + 0.5f - std::sqrt(dx * dx + dy * dy), 0.0f, 1.0f);
      if (inside <= 0.0f) continue;
      Color& texel = at(wrapped(i), wrapped(j));
      texel = glm::mix(texel, color, inside * opacity);
    }
  }
}

void Canvas::grain(int cells, int octaves, float strength, std::uint32_t seed) {
  grain(0.0f, 0.0f, extent_, extent_, cells, octaves, strength, seed);
}

void Canvas::grain(float left, float top, float right, float bottom, int cells, int octaves, float strength,
                   std::uint32_t seed) {
  const Reach columns = reach(left, right);
  const Reach rows = reach(top, bottom);
  const float step = static_cast<float>(cells) / static_cast<float>(pixels_);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const float inside = cover(y, top, bottom) * cover(x, left, right);
      if (inside <= 0.0f) continue;
      const float noise = fractal_noise((static_cast<float>(x) + 0.5f) * step,
                                        (static_cast<float>(y) + 0.5f) * step, cells, octaves, seed);
      at(x, y) *= 1.0f + strength * inside * noise;
    }
  }
}

Image Canvas::image(std::string name) const {
  Image made;
  made.name = std::move(name);
  made.width = made.height = pixels_;
  made.rgba.reserve(texels_.size() * 4);
  for (const Color& texel : texels_) {
    for (int c = 0; c < 3; ++c)
      made.rgba.push_back(static_cast<std::uint8_t>(std::clamp(texel[c], 0.0f, 1.0f) * 255.0f + 0.5f));
    made.rgba.push_back(255);
  }
  return made;
}

} // namespace cupola::content
