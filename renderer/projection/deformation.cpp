#include "renderer/projection/deformation.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace cupola::projection {

namespace {

/// From 1 at 0 to 0 at 1 and beyond; its first two derivatives vanish at both ends.
double falling(double d) { return d < 1.0 ? 1.0 - d * d * d * (10.0 - d * (15.0 - 6.0 * d)) : 0.0; }

struct Bend {
  glm::dvec2 arm;  ///< from the centre
  double distance; ///< of it, over the radius

  [[nodiscard]] double bell() const { return std::exp(-distance * distance); }

  glm::dvec2 operator()(const model::RadialZoom& zoom) const { return arm * (1.0 + zoom.strength * bell()); }
  glm::dvec2 operator()(const model::Swirl& swirl) const {
    const double turn = swirl.angle.radians() * bell(), c = std::cos(turn), s = std::sin(turn);
    return {c * arm.x - s * arm.y, s * arm.x + c * arm.y};
  }
  glm::dvec2 operator()(const model::Lens& lens) const {
    return arm * (1.0 + lens.strength * falling(distance));
  }
  glm::dvec2 operator()(const model::Ripple& ripple) const {
    const double length = glm::length(arm);
    if (length == 0.0) return arm;
    const double wave = std::sin(2.0 * std::numbers::pi * length / ripple.wavelength);
    return arm * (1.0 + ripple.amplitude * wave * bell() / length);
  }
};

} // namespace

glm::dvec2 deformed(const model::Deformation& deformation, glm::dvec2 st, glm::dvec2 circle) {
  const glm::dvec2 center(deformation.center_s, deformation.center_t);
  const glm::dvec2 arm = (st - center) * circle;
  const Bend bend{arm, glm::length(arm) / deformation.radius};
  return center + std::visit(bend, deformation.bend) / circle;
}

} // namespace cupola::projection
