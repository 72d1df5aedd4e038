#include "renderer/content/mipmap.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace cupola::content;

namespace {

Image image(int width, int height, bool srgb, const std::vector<std::uint8_t>& grey) {
  Image made;
  made.width = width;
  made.height = height;
  made.srgb = srgb;
  for (const std::uint8_t value : grey) made.rgba.insert(made.rgba.end(), {value, value, value, value});
  return made;
}

} // namespace

TEST_CASE("sRGB codes and linear light, against the formula of IEC 61966-2-1") {
  for (int code = 0; code < 256; ++code) {
    const double c = code / 255.0;
    const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    CHECK(srgb_to_linear(static_cast<std::uint8_t>(code)) == doctest::Approx(linear).epsilon(1e-6));
    CHECK(linear_to_srgb(static_cast<float>(linear)) == code);
  }
  CHECK(linear_to_srgb(-1.0f) == 0);
  CHECK(linear_to_srgb(7.0f) == 255);
  CHECK(linear_to_srgb(0.5f) == 188);
}

TEST_CASE("a coarser level is the mean of linear light") {
  const MipChain color = make_mipmaps(image(2, 2, true, {255, 0, 0, 255}));
  REQUIRE(color.levels.size() == 2);
  CHECK(color.levels[1].rgba[0] == 188); // half the light, not half the code
  CHECK(color.levels[1].rgba[3] == 128); // alpha is no light
  const MipChain data = make_mipmaps(image(2, 2, false, {255, 0, 0, 255}));
  CHECK(data.levels[1].rgba[0] == 128);
}

TEST_CASE("odd sizes are averaged by area") {
  // 3 to 1: each third; 5 to 2: texels 0, 1 and half of 2, then the other half, 3 and 4
  const MipChain three = make_mipmaps(image(3, 1, false, {0, 90, 180}));
  CHECK(three.levels[1].rgba[0] == 90);
  const MipChain five = make_mipmaps(image(5, 1, false, {10, 10, 200, 60, 60}));
  REQUIRE(five.levels[1].width == 2);
  CHECK(five.levels[1].rgba[0] == 48);
  CHECK(five.levels[1].rgba[4] == 88);
  CHECK(five.levels.back().width == 1);
}

TEST_CASE("sampling: texel centres, wrap modes, nearest, levels") {
  const MipChain chain = make_mipmaps(image(4, 1, false, {0, 100, 200, 40}));
  Texture texture;
  texture.image = 0;
  const auto grey = [&](float u, float lod = 0.0f) {
    return sample(chain, texture, {u, 0.5f}, lod).x * 255.0f;
  };
  CHECK(grey(0.375f) == doctest::Approx(100.0));
  CHECK(grey(0.5f) == doctest::Approx(150.0));
  CHECK(grey(0.0f) == doctest::Approx(20.0)); // repeats: between the last and the first
  CHECK(grey(1.375f) == doctest::Approx(100.0));
  CHECK(grey(-0.625f) == doctest::Approx(100.0));
  texture.wrap_s = Wrap::clamp;
  CHECK(grey(-3.0f) == doctest::Approx(0.0));
  CHECK(grey(9.0f) == doctest::Approx(40.0));
  texture.wrap_s = Wrap::mirror;
  CHECK(grey(-0.375f) == doctest::Approx(100.0));
  CHECK(grey(1.125f) == doctest::Approx(40.0));
  texture.wrap_s = Wrap::repeat;
  CHECK(grey(0.25f, 1.0f) == doctest::Approx(50.0));
  CHECK(grey(0.25f, 0.5f) == doctest::Approx(50.0)); // halfway from the finer level's 50 to 50
  CHECK(grey(0.3f, 40.0f) == doctest::Approx(85.0));
  texture.nearest = true;
  CHECK(grey(0.49f) == doctest::Approx(100.0));
  texture.mipmaps = false;
  CHECK(grey(0.375f, 5.0f) == doctest::Approx(100.0));
  CHECK(std::isfinite(grey(std::nanf(""))));
  CHECK(std::isfinite(grey(1e30f)));
}
