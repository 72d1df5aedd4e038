#include "renderer/projection/sphere.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace cupola::projection {

std::optional<glm::dvec3> sphere_hit(const glm::dvec3& eye, const glm::dvec3& direction) {
  const double a = glm::dot(direction, direction);
  const double b = glm::dot(eye, direction);
  const double inside = 1.0 - glm::dot(eye, eye);
  if (!(a > 0.0) || !(inside > 0.0)) return std::nullopt;
  const double root = std::sqrt(b * b + a * inside);
  const double reach = b > 0.0 ? inside / (root + b) : (root - b) / a; // without cancellation
  return eye + reach * direction;
}

} // namespace cupola::projection
