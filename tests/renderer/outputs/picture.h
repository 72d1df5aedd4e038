// A picture to present: a texture as the renderer makes them, with a colour of its own at every pixel.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <vector>

#include "renderer/outputs/output.h"

namespace cupola::tests {

struct Rgb {
  int r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// What the test picture shows at a pixel; y counts from the top.
inline Rgb pattern(int x, int y, int seed = 0) {
  return {(x * 7 + seed) % 256, (y * 5 + 2 * seed) % 256, (x + y * 3 + 40) % 256};
}

class TestPicture {
public:
  TestPicture(int width, int height, int seed = 0)
      : frame{0, width, height, 1} {
    std::vector<std::uint8_t> rgba;
    for (int row = height - 1; row >= 0; --row) // GL's row 0 is at the bottom
      for (int x = 0; x < width; ++x) {
        const Rgb color = pattern(x, row, seed);
        rgba.insert(rgba.end(), {static_cast<std::uint8_t>(color.r), static_cast<std::uint8_t>(color.g),
                                 static_cast<std::uint8_t>(color.b), 255});
      }
    glCreateTextures(GL_TEXTURE_2D, 1, &frame.texture);
    glTextureStorage2D(frame.texture, 1, GL_SRGB8_ALPHA8, width, height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(frame.texture, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }
  ~TestPicture() { glDeleteTextures(1, &frame.texture); }
  TestPicture(const TestPicture&) = delete;
  TestPicture& operator=(const TestPicture&) = delete;

  outputs::Frame frame;
};

} // namespace cupola::tests
