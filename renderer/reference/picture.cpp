#include "renderer/reference/picture.h"

#include <algorithm>
#include <cmath>

#include "renderer/content/mipmap.h"

namespace cupola::reference {

Picture::Picture(int picture_width, int picture_height, const glm::dvec3& background)
    : width(picture_width)
    , height(picture_height)
    , pixels(static_cast<std::size_t>(picture_width) * static_cast<std::size_t>(picture_height),
             glm::vec4(glm::vec3(background), 0.0f)) {}

std::vector<std::uint8_t> encoded(const Picture& picture) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * picture.pixels.size());
  for (const glm::vec4& pixel : picture.pixels) {
    for (int c = 0; c < 3; ++c) bytes.push_back(content::linear_to_srgb(pixel[c]));
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(pixel.a, 0.0f, 1.0f))));
  }
  return bytes;
}

} // namespace cupola::reference
