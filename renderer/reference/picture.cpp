#include "renderer/reference/picture.h"

#include <algorithm>
#include <cmath>

namespace cupola::reference {
namespace {

std::uint8_t byte(float value) {
  return value > 0.0f ? static_cast<std::uint8_t>(std::lround(255.0f * std::min(value, 1.0f)))
                      : std::uint8_t{0};
}

/// [IEC 61966-2-1]; NaN becomes 0.
std::uint8_t srgb_byte(float linear) {
  return byte(linear <= 0.0031308f ? 12.92f * linear
                                   : 1.055f * std::pow(std::min(linear, 1.0f), 1.0f / 2.4f) - 0.055f);
}

} // namespace

Picture::Picture(int picture_width, int picture_height, const glm::dvec3& background)
    : width(picture_width)
    , height(picture_height)
    , pixels(static_cast<std::size_t>(picture_width) * static_cast<std::size_t>(picture_height),
             glm::vec4(glm::vec3(background), 0.0f)) {}

std::vector<std::uint8_t> encoded(const Picture& picture) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * picture.pixels.size());
  for (const glm::vec4& pixel : picture.pixels) {
    for (int c = 0; c < 3; ++c) bytes.push_back(srgb_byte(pixel[c]));
    bytes.push_back(byte(pixel.a));
  }
  return bytes;
}

} // namespace cupola::reference
