// Painting textures by program. Places are in units of the whole picture's edge chosen by the painter
// (metres, as a rule), x right, y down from the top; colours are sRGB, 0 to 1. Shapes are anti-aliased;
// everything repeats at the borders when wrapped. Pure, and the same bits on every machine.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::content {

using Color = glm::vec3;

/// 0xRRGGBB.
[[nodiscard]] constexpr Color rgb(std::uint32_t code) {
  return {static_cast<float>((code >> 16) & 255) / 255.0f, static_cast<float>((code >> 8) & 255) / 255.0f,
          static_cast<float>(code & 255) / 255.0f};
}

/// Smooth noise of mean 0 within about -1..1 that repeats every `period` cells; x, y in cells.
[[nodiscard]] float value_noise(float x, float y, int period, std::uint32_t seed);
/// Octaves of it, each half as strong.
[[nodiscard]] float fractal_noise(float x, float y, int period, int octaves, std::uint32_t seed);

class Canvas {
public:
  /// pixels: edge of the square image; extent: the same edge in the painter's units.
  Canvas(int pixels, float extent, Color fill);

  void rectangle(float left, float top, float right, float bottom, Color color, float opacity = 1.0f);
  /// From `upper` at the top edge to `lower` at the bottom edge.
  void gradient(float left, float top, float right, float bottom, Color upper, Color lower);
  void disc(float x, float y, float radius, Color color, float opacity = 1.0f);
  /// Adds noise to the lightness; `cells` of its coarsest octave along the edge.
  void grain(int cells, int octaves, float strength, std::uint32_t seed);
  /// The same within a rectangle only.
  void grain(float left, float top, float right, float bottom, int cells, int octaves, float strength,
             std::uint32_t seed);

  [[nodiscard]] int pixels() const { return pixels_; }
  [[nodiscard]] float extent() const { return extent_; }
  [[nodiscard]] Color& at(int x, int y) {
    return texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels_) +
                   static_cast<std::size_t>(x)];
  }
  [[nodiscard]] Image image(std::string name) const;

private:
  struct Reach {
    int first, last;
  };
  [[nodiscard]] Reach reach(float low, float high) const;
  [[nodiscard]] float cover(int pixel, float low, float high) const;

  int pixels_;
  float extent_;
  std::vector<Color> texels_;
};

} // namespace cupola::content
