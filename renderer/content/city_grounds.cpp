// Streets, roofs, ground, trees and the sky.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "renderer/content/canvas.h"
#include "renderer/content/city_pictures.h"
#include "renderer/content/mipmap.h"
#include "renderer/content/random.h"

namespace cupola::content::city {
namespace {

constexpr Color asphalt = {0.30f, 0.30f, 0.31f};
constexpr Color paint_white = {0.84f, 0.84f, 0.80f};

Color to_srgb(const glm::vec3& linear) {
  return Color(linear_to_srgb(linear.x), linear_to_srgb(linear.y), linear_to_srgb(linear.z)) / 255.0f;
}

/// Clouds as a function of direction, so that there is no seam and no pinched pole.
float cloud_noise(float x, float y, float z, std::uint32_t seed) {
  const float below = std::floor(z);
  const float t = z - below;
  const auto layer = [&](float level) {
    return value_noise(x, y, 4096, seed + static_cast<std::uint32_t>(static_cast<int>(level) + 64) * 7919U);
  };
  const float smooth = t * t * (3.0f - 2.0f * t);
  return layer(below) * (1.0f - smooth) + layer(below + 1.0f) * smooth;
}

} // namespace

Image paint_street() { // 14 m across, 14 m along
  Canvas canvas(512, 14.0f, asphalt);
  canvas.grain(7, 5, 0.16f, 61);
  canvas.rectangle(3.0f, 0, 4.6f, 14.0f, Color(0.24f), 0.25f); // worn tracks
  canvas.rectangle(9.4f, 0, 11.0f, 14.0f, Color(0.24f), 0.25f);
  for (const float gutter : {0.0f, 13.6f})
    canvas.rectangle(gutter, 0, gutter + 0.4f, 14.0f, rgb(0x5c5a56), 0.8f);
  for (int i = 0; i < 2; ++i) { // dashes of 4 m in the middle, a line beside each parking lane
    const float y = static_cast<float>(i) * 7.0f;
    canvas.rectangle(6.92f, y + 1.5f, 7.08f, y + 5.5f, paint_white, 0.9f);
    for (const float x : {2.2f, 11.66f}) canvas.rectangle(x, y, x + 0.14f, y + 7.0f, paint_white, 0.75f);
    for (const float x : {0.4f, 11.8f}) canvas.rectangle(x, y, x + 1.8f, y + 0.12f, paint_white, 0.6f);
  }
  return canvas.image("street");
}

Image paint_crossing() { // 24 m: the square of 14 m at the top left, stripes in the rows from 16 m to 20 m
  Canvas canvas(1024, 24.0f, asphalt);
  canvas.grain(12, 5, 0.16f, 71);
  canvas.disc(4.2f, 5.0f, 0.42f, rgb(0x35332f));
  canvas.disc(4.2f, 5.0f, 0.34f, rgb(0x57534d));
  canvas.disc(9.6f, 8.8f, 0.42f, rgb(0x35332f));
  canvas.disc(9.6f, 8.8f, 0.34f, rgb(0x57534d));
  for (int i = 0; i < 12; ++i) {
    const float x = 1.25f + static_cast<float>(i);
    canvas.rectangle(x, 16.6f, x + 0.5f, 19.4f, paint_white, 0.88f);
  }
  for (const float gutter : {0.0f, 13.6f})
    canvas.rectangle(gutter, 15.0f, gutter + 0.4f, 21.0f, rgb(0x5c5a56), 0.8f);
  return canvas.image("crossing");
}

Image paint_pavement() { // slabs of 1 m by 0.75 m
  Canvas canvas(512, 12.0f, rgb(0x9a958c));
  for (int row = 0; row < 16; ++row) {
    for (int i = 0; i < 12; ++i) {
      Random random{19, row, i};
      const float y = static_cast<float>(row) * 0.75f;
      const float x = static_cast<float>(i);
      canvas.rectangle(x, y, x + 1.0f, y + 0.75f, Color(static_cast<float>(random.between(0.5, 0.68))), 0.5f);
      const float joint = x + (row % 2 == 0 ? 0.0f : 0.5f);
      canvas.rectangle(joint - 0.015f, y, joint + 0.015f, y + 0.75f, rgb(0x55524c), 0.8f);
      canvas.rectangle(x, y - 0.015f, x + 1.0f, y + 0.015f, rgb(0x55524c), 0.8f);
    }
  }
  canvas.grain(12, 4, 0.14f, 81);
  return canvas.image("pavement");
}

Image paint_flat_roof() { // bitumen sheets with gravel
  Canvas canvas(512, 12.0f, rgb(0x77736c));
  canvas.grain(24, 4, 0.16f, 91);
  for (int i = 0; i < 12; ++i) {
    const float x = static_cast<float>(i);
    canvas.rectangle(x - 0.02f, 0, x + 0.03f, 12.0f, rgb(0x4b4843), 0.7f);
    canvas.rectangle(x + 0.03f, 0, x + 0.08f, 12.0f, rgb(0x969189), 0.4f);
  }
  for (const float y : {3.0f, 9.0f}) canvas.rectangle(0, y, 12.0f, y + 0.05f, rgb(0x4b4843), 0.6f);
  return canvas.image("flat roof");
}

Image paint_tiled_roof() { // pantiles, 0.3 m by 0.375 m
  Canvas canvas(512, 12.0f, rgb(0x8e4a33));
  for (int row = 0; row < 32; ++row) {
    const float y = static_cast<float>(row) * 0.375f;
    for (int i = 0; i < 40; ++i) {
      Random random{20, row, i};
      const float x = static_cast<float>(i) * 0.3f;
      const auto shade = static_cast<float>(random.between(0.85, 1.15));
      canvas.gradient(x, y, x + 0.3f, y + 0.375f, rgb(0x7a3b28) * shade, rgb(0xa85a3e) * shade);
      canvas.rectangle(x + 0.24f, y, x + 0.3f, y + 0.375f, rgb(0x4c2419), 0.55f);
    }
    canvas.rectangle(0, y + 0.33f, 12.0f, y + 0.375f, rgb(0x3d1d14), 0.7f);
  }
  canvas.grain(6, 4, 0.14f, 101);
  return canvas.image("tiled roof");
}

Image paint_grass() {
  Canvas canvas(512, 12.0f, rgb(0x4f6a36));
  canvas.grain(4, 5, 0.14f, 111);
  canvas.grain(64, 3, 0.22f, 112);
  return canvas.image("grass");
}

Image paint_tree() { // leaves above, bark in the lowest quarter
  Canvas canvas(512, 4.0f, rgb(0x3f5f2b));
  canvas.grain(8, 4, 0.35f, 121);
  Random random{21};
  for (int i = 0; i < 900; ++i) {
    const auto x = static_cast<float>(random.between(0.0, 4.0));
    const auto y = static_cast<float>(random.between(0.0, 2.9));
    const auto radius = static_cast<float>(random.between(0.03, 0.1));
    canvas.disc(x, y, radius, random.chance(0.55) ? rgb(0x6b8c3f) : rgb(0x2c451f), 0.5f);
  }
  canvas.rectangle(0, 2.98f, 4.0f, 4.0f, rgb(0x5b4836));
  canvas.grain(0, 2.98f, 4.0f, 4.0f, 32, 3, 0.3f, 122);
  return canvas.image("tree");
}

Image paint_sky() {                             // v: 0 zenith, 0.9 horizon, 1 nadir; u: a full turn
  const glm::vec3 horizon{0.62f, 0.70f, 0.80f}; // the fog's default colour
  const glm::vec3 zenith{0.10f, 0.24f, 0.58f};
  const glm::vec3 nadir{0.10f, 0.10f, 0.09f};
  Canvas canvas(1024, 1.0f, Color(0.0f));
  for (int row = 0; row < canvas.pixels(); ++row) {
    const float v = (static_cast<float>(row) + 0.5f) / static_cast<float>(canvas.pixels());
    const float height = std::max(0.0f, 1.0f - v / 0.9f); // 1 zenith, 0 horizon
    const auto rise = static_cast<float>(sine_of_turns(height * 0.25));
    const auto flat = static_cast<float>(cosine_of_turns(height * 0.25));
    const float haze = (1.0f - rise) * (1.0f - rise) * (1.0f - rise);
    const float below = std::clamp((v - 0.9f) * 20.0f, 0.0f, 1.0f);
    const glm::vec3 clear = glm::mix(glm::mix(zenith, horizon, haze), nadir, below);
    for (int column = 0; column < canvas.pixels(); ++column) {
      const double turn = (column + 0.5) / canvas.pixels();
      const float x = flat * static_cast<float>(cosine_of_turns(turn));
      const float z = flat * static_cast<float>(sine_of_turns(turn));
      float density = 0.0f;
      if (height > 0.0f) { // a layer overhead, flattened towards the horizon
        const float spread = 2.2f / (rise + 0.35f);
        float strength = 0.55f;
        float scale = spread;
        for (std::uint32_t octave = 0; octave < 5; ++octave) {
          density += strength * cloud_noise(x * scale + 31.0f, z * scale + 57.0f, rise * scale, octave);
          strength *= 0.5f;
          scale *= 2.1f;
        }
        density = std::clamp((density - 0.02f) * 2.2f, 0.0f, 1.0f);
        density *= density * (3.0f - 2.0f * density) * std::min(1.0f, rise * 6.0f);
      }
      canvas.at(column, row) = to_srgb(glm::mix(clear, glm::vec3(0.86f, 0.88f, 0.92f), density * 0.8f));
    }
  }
  return canvas.image("sky");
}

} // namespace cupola::content::city
