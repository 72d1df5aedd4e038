// The unit sphere that fisheye and equirectangular pictures lie on.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

/// Where the ray from `eye` inside the unit sphere meets it. nullopt when the eye is not inside or the
/// direction is zero.
[[nodiscard]] std::optional<glm::dvec3> sphere_hit(const glm::dvec3& eye, const glm::dvec3& direction);

} // namespace cupola::projection
