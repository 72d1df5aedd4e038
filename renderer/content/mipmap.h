// Smaller versions of an image and reading them as a GPU does, on the CPU. Pure; any thread.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::content {

/// An image and all its halvings down to 1×1; levels[0] is the image. Sizes are rounded down, as OpenGL's.
struct MipChain {
  bool srgb = true;
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
  };
  std::vector<Level> levels;
};

/// Each texel is the mean of what it covers (exact areas, also for odd sizes), in linear light for srgb
/// images.
[[nodiscard]] MipChain make_mipmaps(const Image& image);

/// Linear colour (alpha as stored, 0 to 1) at `uv`; texel centres at half integers, the wrap modes of
/// `texture`. lod: log2 of texels of level 0 per pixel. Trilinear above 0, bilinear (or nearest, as the
/// texture asks) at lod <= 0; without mipmaps always level 0.
[[nodiscard]] glm::vec4 sample(const MipChain& image, const Texture& texture, glm::vec2 uv, float lod);

/// 8 bit sRGB code to linear light, 0 to 1.
[[nodiscard]] float srgb_to_linear(std::uint8_t code);
/// Linear light to the nearest sRGB code.
[[nodiscard]] std::uint8_t linear_to_srgb(float linear);

} // namespace cupola::content
