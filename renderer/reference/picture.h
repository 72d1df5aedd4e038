// A picture in linear light.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace cupola::reference {

/// Linear RGB and coverage, rows from the top, pixels[y · width + x]. RGB already has the background in it:
/// it is what is seen. Alpha is the share of the pixel in which a surface was hit; 0 outside a projection and
/// where nothing is.
struct Picture {
  int width = 0, height = 0;
  std::vector<glm::vec4> pixels;

  Picture() = default;
  /// All background, alpha 0.
  Picture(int picture_width, int picture_height, const glm::dvec3& background);

  [[nodiscard]] glm::vec4& at(int x, int y) { return pixels[index(x, y)]; }
  [[nodiscard]] const glm::vec4& at(int x, int y) const { return pixels[index(x, y)]; }
  /// The pixels as RGBA floats.
  [[nodiscard]] const float* data() const { return &pixels.front().x; }

private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// As displays take it: 8 bit RGBA, colour sRGB-encoded and rounded to the nearest step, alpha linear.
[[nodiscard]] std::vector<std::uint8_t> encoded(const Picture& picture);

} // namespace cupola::reference
