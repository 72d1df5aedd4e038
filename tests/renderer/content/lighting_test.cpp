#include "renderer/content/lighting.h"

#include <doctest/doctest.h>

using namespace cupola;
using namespace cupola::content;

TEST_CASE("the sun's compass") {
  model::Sun sun;
  sun.elevation = {0.0};
  sun.azimuth = {0.0};
  CHECK(sun_direction(sun).z == doctest::Approx(-1.0));
  sun.azimuth = {90.0};
  CHECK(sun_direction(sun).x == doctest::Approx(1.0));
  sun.elevation = {30.0};
  CHECK(sun_direction(sun).y == doctest::Approx(0.5));
  CHECK(sun_direction(sun).x == doctest::Approx(0.8660254));
}

TEST_CASE("intensities multiply colours") {
  model::Scene scene;
  scene.sun.color = {1.0, 0.5, 0.25};
  scene.sun.intensity = 2.0;
  scene.sky.zenith = {0.2, 0.4, 0.6};
  scene.sky.intensity = 0.5;
  scene.fog.density = 0.125;
  const shading::Lighting l = lighting_of(scene);
  CHECK(l.sun_color == glm::vec3(2.0f, 1.0f, 0.5f));
  CHECK(l.zenith.z == doctest::Approx(0.3));
  CHECK(l.fog_density == 0.125f);
}
