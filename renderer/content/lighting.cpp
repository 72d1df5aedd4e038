#include "renderer/content/lighting.h"

#include <cmath>

namespace cupola::content {

glm::vec3 sun_direction(const model::Sun& sun) {
  const double azimuth = sun.azimuth.radians(), elevation = sun.elevation.radians();
  return glm::vec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                   -std::cos(azimuth) * std::cos(elevation));
}

shading::Lighting lighting_of(const model::Scene& scene) {
  shading::Lighting lighting{};
  lighting.sun_direction = sun_direction(scene.sun);
  lighting.sun_color = glm::vec3(scene.sun.color * scene.sun.intensity);
  lighting.zenith = glm::vec3(scene.sky.zenith * scene.sky.intensity);
  lighting.ground = glm::vec3(scene.sky.ground * scene.sky.intensity);
  lighting.fog_color = glm::vec3(scene.fog.color);
  lighting.fog_density = static_cast<float>(scene.fog.density);
  return lighting;
}

} // namespace cupola::content
