#include "renderer/content/shading.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>
#include <initializer_list>

using namespace cupola::content::shading;

namespace {

Surface white() {
  Surface s{};
  s.base = vec3(1.0f);
  s.alpha = 1.0f;
  s.roughness = 1.0f;
  s.occlusion = 1.0f;
  s.normal = vec3(0, 1, 0);
  s.to_eye = vec3(0, 1, 0);
  s.distance = 10.0f;
  return s;
}

Lighting dark() {
  Lighting l{};
  l.sun_direction = vec3(0, 1, 0);
  return l;
}

} // namespace

TEST_CASE("a white surface that faces the sun is about as bright as the sun's colour") {
  Lighting l = dark();
  l.sun_color = vec3(0.5f, 0.25f, 0.125f);
  const vec3 lit = shade(white(), l);
  CHECK(lit.x == doctest::Approx(0.5).epsilon(0.05));
  CHECK(lit.y == doctest::Approx(0.25).epsilon(0.05));
  CHECK(lit.z == doctest::Approx(0.125).epsilon(0.05));
}

TEST_CASE("light falls with the cosine, and not on what is turned away") {
  Surface s = white();
  Lighting l = dark();
  l.sun_color = vec3(1.0f);
  const float facing = shade(s, l).x;
  l.sun_direction = glm::normalize(vec3(1, 1, 0));
  CHECK(shade(s, l).x == doctest::Approx(facing * 0.7071).epsilon(0.05));
  l.sun_direction = vec3(0, -1, 0);
  CHECK(shade(s, l).x == 0.0f);
}

TEST_CASE("no more light is reflected than arrives") {
  // the integral over all directions of light, for several angles of view and roughnesses
  for (const float roughness : {0.3f, 0.6f, 1.0f}) {
    for (const float metallic : {0.0f, 1.0f}) {
      for (const float tilt : {0.0f, 0.6f, 1.2f}) {
        Surface s = white();
        s.roughness = roughness;
        s.metallic = metallic;
        s.to_eye = vec3(std::sin(tilt), std::cos(tilt), 0.0f);
        double sum = 0.0;
        const int rows = 256;
        const int columns = 256;
        for (int row = 0; row < rows; ++row) {
          for (int column = 0; column < columns; ++column) {
            const float y = (static_cast<float>(row) + 0.5f) / rows;
            const float turn = (static_cast<float>(column) + 0.5f) / columns * 2.0f * shading_pi;
            const float flat = std::sqrt(1.0f - y * y);
            sum += shade_light(s, vec3(flat * std::cos(turn), y, flat * std::sin(turn)), vec3(1.0f)).x;
          }
        }
        const double reflected = sum * 2.0 * glm::pi<double>() / (rows * columns);
        CAPTURE(roughness);
        CAPTURE(metallic);
        CAPTURE(tilt);
        CHECK(reflected <=
              1.08); // the cheap masking and the split of diffuse and mirrored light are not exact
        CHECK(reflected >= 0.3);
      }
    }
  }
}

TEST_CASE("the sky lights from above, the ground from below, and occlusion takes only their light") {
  Surface s = white();
  Lighting l = dark();
  l.zenith = vec3(0.6f);
  l.ground = vec3(0.2f);
  const float up = shade(s, l).x;
  s.normal = vec3(0, -1, 0);
  s.to_eye = vec3(0, -1, 0);
  const float down = shade(s, l).x;
  CHECK(up == doctest::Approx(0.6).epsilon(0.02));
  CHECK(down == doctest::Approx(0.2).epsilon(0.02));
  s.occlusion = 0.0f;
  s.emissive = vec3(0.1f);
  CHECK(shade(s, l).x == doctest::Approx(0.1));
}

TEST_CASE("tone keeps what is displayable and never passes 1") {
  CHECK(tone(vec3(0.0f, 0.4f, 0.8f)) == vec3(0.0f, 0.4f, 0.8f));
  float before = 0.8f;
  for (float x = 0.81f; x < 50.0f; x *= 1.1f) {
    const float y = tone(vec3(x)).x;
    CHECK(y > before);
    CHECK(y < 1.0f);
    before = y;
  }
  CHECK((tone(vec3(0.801f)).x - 0.8f) / 0.001f == doctest::Approx(1.0).epsilon(0.02)); // no kink
}

TEST_CASE("fog by distance") {
  Lighting l = dark();
  l.fog_color = vec3(0.5f);
  CHECK(apply_fog(vec3(1.0f), 1e6f, l) == vec3(1.0f));
  l.fog_density = 0.01f;
  CHECK(apply_fog(vec3(1.0f), 0.0f, l).x == doctest::Approx(1.0));
  CHECK(apply_fog(vec3(1.0f), 69.3147f, l).x == doctest::Approx(0.75)); // half of the way
  CHECK(apply_fog(vec3(1.0f), 1e6f, l).x == doctest::Approx(0.5));
}

TEST_CASE("punctual lights fall off as KHR_lights_punctual says") {
  CHECK(punctual_attenuation(2.0f, 0.0f) == doctest::Approx(0.25));
  CHECK(punctual_attenuation(2.0f, 4.0f) == doctest::Approx(0.25 * (1.0 - 1.0 / 16.0)));
  CHECK(punctual_attenuation(4.0f, 4.0f) == 0.0f);
  CHECK(punctual_attenuation(9.0f, 4.0f) == 0.0f);
  const vec3 shines(0, -1, 0);
  CHECK(spot_attenuation(vec3(0, 1, 0), shines, 0.9f, 0.8f) == doctest::Approx(1.0));
  CHECK(spot_attenuation(vec3(std::sqrt(1 - 0.85f * 0.85f), 0.85f, 0), shines, 0.9f, 0.8f) ==
        doctest::Approx(0.25));
  CHECK(spot_attenuation(vec3(0.8f, 0.6f, 0), shines, 0.9f, 0.8f) == 0.0f);
}

TEST_CASE("a wire is as wide as asked, half of it on each side, however large the samples are") {
  for (const float width : {0.4f, 1.2f, 3.0f})
    for (const float footprint : {0.125f, 0.5f, 1.0f}) {
      CAPTURE(width);
      CAPTURE(footprint);
      float covered = 0.0f;
      for (float d = 0.005f; d < 6.0f; d += 0.01f)
        covered += 0.01f * wire_coverage(vec3(d, 9, 9), width, footprint);
      CHECK(covered == doctest::Approx(width / 2).epsilon(0.02));
      CHECK(wire_coverage(vec3(0.0f, 9, 9), width, footprint) ==
            doctest::Approx(std::min(width / footprint, 1.0f)));
      CHECK(wire_coverage(vec3(9, 9, (width + footprint) / 2 + 0.01f), width, footprint) == 0.0f);
    }
}

TEST_CASE("one sample covers what many small ones in its place do") {
  for (float d = 0.0f; d < 2.0f; d += 0.11f) {
    float mean = 0.0f;
    for (int i = 0; i < 64; ++i)
      mean += wire_coverage(vec3(std::abs(d + (i + 0.5f) / 64.0f - 0.5f), 9, 9), 1.2f, 1.0f / 64.0f) / 64.0f;
    CHECK(wire_coverage(vec3(d, 9, 9), 1.2f, 1.0f) == doctest::Approx(mean).epsilon(0.02));
  }
}

TEST_CASE("hatching puts more ink where it is darker, none where it is bright") {
  const auto ink = [](float luma) {
    float sum = 0.0f;
    for (int y = 0; y < 70; ++y)
      for (int x = 0; x < 70; ++x) sum += luminance(hatch(vec2(x + 0.5f, y + 0.5f), luma, 7.0f, 1.2f, 1.0f));
    return 1.0f - sum / 4900.0f;
  };
  const float paper = ink(1.0f);
  CHECK(ink(0.9f) == doctest::Approx(paper).epsilon(1e-4));
  float before = paper;
  for (const float luma : {0.6f, 0.35f, 0.2f, 0.1f, 0.02f}) {
    CHECK(ink(luma) > before + 0.01f);
    before = ink(luma);
  }
}
