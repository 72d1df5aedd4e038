// Textures and lines against figures from elsewhere: exact areas, brute force, widths measured in pixels.
#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "tests/renderer/reference/small_scene.h"

namespace cupola::reference {
namespace {

/// Black and white texels in turn, linear data.
int checkerboard(SmallScene& scene, int size) {
  std::vector<std::uint8_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const std::uint8_t value = (x + y) % 2 == 0 ? 255 : 0;
      texels.insert(texels.end(), {value, value, value, 255});
    }
  return scene.texture(size, size, std::move(texels), false);
}

/// The checkerboard with bilinear filtering, from its closed form: the product of two triangle waves about
/// 1/2.
double bilinear_checks(double x, double y) {
  const auto wave = [](double position) { // +1 and -1 in the middles of texels, straight between
    const double phase = std::abs(std::remainder(position - 0.5, 2.0));
    return 1.0 - 2.0 * phase;
  };
  return 0.5 + 0.5 * wave(x) * wave(y);
}

content::Material unlit_texture(int texture) {
  content::Material material;
  material.unlit = true;
  material.base_color_map.texture = texture;
  return material;
}

} // namespace

TEST_CASE("far from a fine checkerboard every pixel is its mean") {
  SmallScene scene;
  const int texture = checkerboard(scene, 64);
  scene.wall(scene.material(unlit_texture(texture)), -1.0f, 1.0f, 8.0f, 8.0f); // 512 texels over 32 pixels
  for (const int samples : {1, 16, 64}) {
    CAPTURE(samples);
    const Picture picture = render(scene, request(perspective(90.0), 32, 32, samples));
    for (const glm::vec4& pixel : picture.pixels) CHECK(pixel.g == doctest::Approx(0.5).epsilon(0.01));
  }
}

TEST_CASE("seen straight on, pixels near the mean of the filtered texture over their square") {
  SmallScene scene;
  scene.wall(scene.material(unlit_texture(checkerboard(scene, 32))), -1.0f,
             1.0f); // 32 texels over 20 pixels: 1.6 each
  const Picture picture = render(scene, request(perspective(90.0), 20, 20, 256));
  double worst = 0.0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      double sum = 0.0;
      constexpr int fine = 40;
      for (int i = 0; i < fine * fine; ++i)
        sum += bilinear_checks(1.6 * (x + (i % fine + 0.5) / fine), 1.6 * (y + (i / fine + 0.5) / fine));
      worst = std::max(worst, std::abs(picture.at(x, y).r - sum / (fine * fine)));
    }
  CHECK(worst <
        0.01); // 256 samples and a footprint of 1/16 pixel: bilinear exactly, but for the mean of the samples
}

TEST_CASE("on a floor seen at a grazing angle the mean over each pixel's footprint comes out too") {
  SmallScene scene;
  const int texture = checkerboard(scene, 64);
  // One texel is 1/16 m. The pixels below the horizon have footprints of up to 30 texels in length.
  scene.quad(scene.material(unlit_texture(texture)),
             {glm::vec3{-64, -1, 0}, {64, -1, 0}, {64, -1, -64}, {-64, -1, -64}}, 32.0f, 16.0f);
  const int size = 32;
  const Picture picture = render(scene, request(perspective(90.0), size, size, 256));
  double squares = 0.0;
  int count = 0;
  for (int y = size / 2 + 2; y < size; ++y)
    for (int x = 0; x < size; ++x, ++count) {
      constexpr int fine = 64;
      double sum = 0.0;
      for (int i = 0; i < fine * fine; ++i) {
        const double s = 2.0 * (x + (i % fine + 0.5) / fine) / size - 1.0;
        const double t = 1.0 - 2.0 * (y + (i / fine + 0.5) / fine) / size;
        const double depth = -1.0 / t;
        sum += bilinear_checks(16.0 * (64.0 + s * depth), 16.0 * (64.0 - depth));
      }
      const double difference = picture.at(x, y).r - sum / (fine * fine);
      squares += difference * difference;
    }
  CHECK(std::sqrt(squares / count) < 0.01);
}

TEST_CASE(
    "a texture lies as in its file: first row on top, first texel on the left; sRGB texels become linear") {
  SmallScene scene;
  const int texture =
      scene.texture(2, 2, {188, 0, 0, 255, 0, 188, 0, 255, 0, 0, 188, 255, 188, 188, 188, 255}, true);
  scene.scene.textures[0].wrap_s = scene.scene.textures[0].wrap_t = content::Wrap::clamp;
  scene.wall(scene.material(unlit_texture(texture)), -1.0f, 1.0f);
  const Picture picture = render(scene, request(perspective(90.0), 16, 16));
  const float half = 0.5029f; // 188 of the sRGB curve
  CHECK(picture.at(1, 1).r == doctest::Approx(half).epsilon(1e-3));
  CHECK(picture.at(1, 1).g == 0.0f);
  CHECK(picture.at(14, 1).g == doctest::Approx(half).epsilon(1e-3));
  CHECK(picture.at(1, 14).b == doctest::Approx(half).epsilon(1e-3));
  CHECK(picture.at(14, 14).r == doctest::Approx(half).epsilon(1e-3));
}

TEST_CASE("a texture transform turns and shifts as KHR_texture_transform says") {
  SmallScene scene;
  content::Material material = unlit_texture(scene.texture(2, 1, {255, 0, 0, 255, 0, 255, 0, 255}, false));
  scene.scene.textures[0].nearest = true;
  material.base_color_map.transform[2] = glm::vec3(0.5f, 0.0f, 1.0f); // half a turn of the repeating picture
  scene.wall(scene.material(material), -1.0f, 1.0f);
  const Picture picture = render(scene, request(perspective(90.0), 8, 8));
  CHECK(picture.at(1, 4).g == 1.0f);
  CHECK(picture.at(6, 4).r == 1.0f);
}

TEST_CASE("a normal map tilts the light: +x of the map towards rising u, +y towards falling v") {
  SmallScene scene;
  content::Material material;
  material.base_color = glm::vec4(0.5f);
  // (0.6, 0, 0.8) as bytes.
  material.normal_map.texture = scene.texture(1, 1, {204, 128, 230, 255}, false);
  scene.wall(scene.material(material), -2.0f);
  Request asked = request(perspective(60.0), 5, 5);
  asked.scene.sky.intensity = 0.0;
  const auto brightness = [&](double azimuth) {
    asked.scene.sun = {{azimuth}, {0.0}, {1.0, 1.0, 1.0}, 1.0};
    return render(scene, asked).at(2, 2).r;
  };
  const double tilt =
      36.87; // the normal leans towards +x: the sun at azimuth 180° - 36.87° meets it straight on
  CHECK(brightness(180.0 - tilt) > brightness(180.0));
  CHECK(brightness(180.0) > brightness(180.0 + tilt));
  CHECK(brightness(180.0 + 60.0) < 0.01f); // 96.87° from the tilted normal
  CHECK(brightness(180.0 - tilt) == doctest::Approx(0.49).epsilon(0.02));
}

TEST_CASE("wireframe lines have their width in output pixels, near and far, for any projection") {
  for (const float depth : {2.0f, 30.0f}) {
    SmallScene scene;
    // Two walls that meet at x = 0; each draws its half of the line. Their diagonals stay away from the row
    // measured.
    const int grey = scene.plain({0.5f, 0.5f, 0.5f, 1.0f});
    const float size = 100.0f;
    scene.quad(
        grey,
        {glm::vec3{-size, -size, -depth}, {0, -size, -depth}, {0, size, -depth}, {-size, size, -depth}});
    scene.quad(grey,
               {glm::vec3{0, -size, -depth}, {size, -size, -depth}, {size, size, -depth}, {0, size, -depth}});
    for (const model::Projection& projection :
         {perspective(20.0), of(model::Cylinder{{20.0}, {20.0}}), of(model::Fisheye{{20.0}}),
          of(model::Equirectangular{{20.0}, {20.0}})}) {
      for (const double width : {2.0, 5.0}) {
        CAPTURE(depth);
        CAPTURE(projection.shape.index());
        CAPTURE(width);
        Request asked = request(projection, 100, 100, 64);
        asked.scene.style = {model::StyleKind::wireframe, width};
        const Picture picture = render(scene, asked);
        const int row = 40;
        const float fill = picture.at(40, row).r;
        const float strength = 150.0f / (150.0f + depth); // lines fade: half as strong at 150 m
        const float ink = fill + (0.02f - fill) * strength;
        double covered = 0.0;
        for (int x = 40; x < 60; ++x) covered += (fill - picture.at(x, row).r) / (fill - ink);
        CHECK(covered == doctest::Approx(width).epsilon(0.03));
      }
    }
  }
}

TEST_CASE("hatching keeps its spacing in output pixels") {
  SmallScene scene;
  scene.wall(scene.plain({0.25f, 0.25f, 0.25f, 1.0f}), -3.0f); // half dark: one family of strokes
  Request asked = request(perspective(60.0), 160, 40, 16);
  asked.scene.style = {model::StyleKind::hatching, 1.2, 8.0};
  const Picture picture = render(scene, asked);
  // Strokes run at 45°: along a row they return every 8 · √2 pixels.
  int strokes = 0;
  for (int x = 1; x < 159; ++x) {
    const float here = picture.at(x, 20).r;
    if (here < 0.6f && here <= picture.at(x - 1, 20).r && here < picture.at(x + 1, 20).r) ++strokes;
  }
  CHECK(std::abs(strokes - 160.0 / (8.0 * std::sqrt(2.0))) <= 1.5);
}

} // namespace cupola::reference
