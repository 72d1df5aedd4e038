// The show's light as the shading functions want it: one reading for all methods. Pure.
#pragma once

#include <glm/vec3.hpp>

#include "configs/model/show.h"
#include "renderer/content/shading.h"

namespace cupola::content {

/// Unit vector towards the sun, world axes: azimuth 0 is −z, 90° is +x; elevation upwards.
[[nodiscard]] glm::vec3 sun_direction(const model::Sun& sun);

[[nodiscard]] shading::Lighting lighting_of(const model::Scene& scene);

} // namespace cupola::content
