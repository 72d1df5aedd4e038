#include "renderer/plan/corner.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace cupola::plan {

namespace {
constexpr double flattest = 1e-4; ///< determinant of a pyramid over the square of its longest side
} // namespace

glm::dvec2 PictureMap::image(glm::dvec2 at) const {
  return {-1.0 + 2.0 * at.x / size.x, 1.0 - 2.0 * at.y / size.y};
}

std::optional<glm::dvec3> PictureMap::ray(glm::dvec2 at) const {
  return projection::beyond(map, image(at), inside);
}

std::optional<double> PictureMap::weight(glm::dvec2 at) const {
  constexpr double reach = 0.5;
  const auto here = ray(at);
  if (!here) return std::nullopt;
  const glm::dvec3 middle = glm::normalize(*here);
  const auto slope = [&](glm::dvec2 step) {
    const auto plus = ray(at + step), minus = ray(at - step);
    if (!plus && !minus) return glm::dvec3(0.0);
    return ((plus ? glm::normalize(*plus) : middle) - (minus ? glm::normalize(*minus) : middle)) /
           (reach * ((plus ? 1.0 : 0.0) + (minus ? 1.0 : 0.0)));
  };
  const glm::dvec3 across = slope({reach, 0.0}), down = slope({0.0, reach});
  const double scale = 0.5 * std::max(size.x, size.y); // so that weights are near 1
  const double found = std::cbrt(std::abs(glm::dot(glm::cross(across, down), middle)) * scale * scale);
  if (!std::isfinite(found) || !(found > 0.0)) return std::nullopt;
  return found;
}

Drawing::Drawing(const std::array<Corner, 3>& corners, const std::array<glm::dvec2, 3>& at)
    : at_(at) {
  const auto& [a, b, c] = corners;
  const auto square = [](const glm::dvec3& v) { return glm::dot(v, v); };
  const double longest = std::max({square(a.ray - b.ray), square(b.ray - c.ray), square(c.ray - a.ray)});
  const double determinant = glm::dot(a.ray, glm::cross(b.ray, c.ray));
  fit_ = longest > 0.0 && std::abs(determinant) >= flattest * longest;
  const double turn = determinant < 0.0 ? -1.0 : 1.0;
  shares_ = {turn * a.weight * glm::cross(b.ray, c.ray), turn * b.weight * glm::cross(c.ray, a.ray),
             turn * c.weight * glm::cross(a.ray, b.ray)};
}

glm::dvec2 Drawing::operator()(const glm::dvec3& ray) const {
  const double a = glm::dot(shares_[0], ray), b = glm::dot(shares_[1], ray), c = glm::dot(shares_[2], ray);
  return (a * at_[0] + b * at_[1] + c * at_[2]) / (a + b + c);
}

} // namespace cupola::plan
