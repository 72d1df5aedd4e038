#include "renderer/outputs/readback.h"

#include <doctest/doctest.h>
#include <epoxy/gl.h>

#include <cmath>

#include "tests/renderer/outputs/picture.h"

using namespace cupola;

namespace {

struct Surfaceless {
  Surfaceless() {
    auto made = outputs::Context::make_headless({});
    REQUIRE(made);
    context = std::move(*made);
    REQUIRE(context->make_current());
  }
  ~Surfaceless() { context->release(); }
  std::unique_ptr<outputs::Context> context;
};

outputs::Pixels finish(outputs::Readback& readback) {
  glFinish();
  auto pixels = readback.take();
  REQUIRE(pixels);
  return *pixels;
}

} // namespace

TEST_CASE("a picture comes back byte for byte, top row first") {
  const Surfaceless gl;
  const tests::TestPicture picture(37, 21); // rows of no round length
  outputs::Readback readback(2);
  REQUIRE(readback.start(picture.frame, std::nullopt, 5));
  const outputs::Pixels pixels = finish(readback);
  CHECK(pixels.tag == 5);
  REQUIRE(pixels.width == 37);
  REQUIRE(pixels.height == 21);
  const auto rgb = outputs::to_rgb(pixels);
  REQUIRE(rgb.size() == 37 * 21 * 3);
  int wrong = 0;
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 37; ++x) {
      const std::size_t at = static_cast<std::size_t>(y * 37 + x) * 3;
      if (tests::Rgb{rgb[at], rgb[at + 1], rgb[at + 2]} != tests::pattern(x, y)) ++wrong;
    }
  CHECK(wrong == 0);
}

TEST_CASE("no buffer, no read: until one is let go") {
  const Surfaceless gl;
  const tests::TestPicture picture(8, 8);
  outputs::Readback readback(2);
  CHECK(readback.start(picture.frame, std::nullopt, 1));
  CHECK(readback.start(picture.frame, std::nullopt, 2));
  CHECK_FALSE(readback.start(picture.frame, std::nullopt, 3));
  {
    const outputs::Pixels first = finish(readback);
    CHECK(first.tag == 1);                                       // in the order started
    CHECK_FALSE(readback.start(picture.frame, std::nullopt, 4)); // read, but still held
  }
  CHECK(readback.start(picture.frame, std::nullopt, 5));
  CHECK(finish(readback).tag == 2);
  CHECK(finish(readback).tag == 5);
  CHECK_FALSE(readback.pending());
}

TEST_CASE("scaled down in linear light, whatever scissor the renderer left") {
  const Surfaceless gl;
  GLuint texture = 0;
  constexpr int width = 256, height = 128;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_SRGB8_ALPHA8, width, height);
  std::vector<std::uint8_t> columns;
  for (int i = 0; i < width * height; ++i)
    columns.insert(columns.end(), 4, static_cast<std::uint8_t>(i % 2 ? 255 : 0));
  glTextureSubImage2D(texture, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, columns.data());
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);

  outputs::Readback readback(1);
  REQUIRE(readback.start({texture, width, height, 1}, 32, 0));
  CHECK(glIsEnabled(GL_SCISSOR_TEST));
  CHECK_FALSE(glIsEnabled(GL_FRAMEBUFFER_SRGB));
  const outputs::Pixels pixels = finish(readback);
  CHECK(pixels.width == 32);
  CHECK(pixels.height == 16);
  const auto rgb = outputs::to_rgb(pixels);
  // Half the light is 188 of 255 encoded [IEC 61966-2-1]: averaging the bytes would give 128.
  int wrong = 0;
  for (const std::uint8_t value : rgb)
    if (std::abs(value - 188) > 2) ++wrong;
  CHECK(wrong == 0);
  glDeleteTextures(1, &texture);
}
