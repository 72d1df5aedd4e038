// Which strips of a cylinder a triangle touches [Lorenz & Döllner, sec. 3.1]. Pure, no GL; twin of
// strips.glsl.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/plan/plan.h"

namespace cupola::passes {

/// Strips first … first + count − 1, counted modulo the number of strips.
struct StripRange {
  int first = 0, count = 0;
};

/// The strips of a viewport as intervals of azimuth about the cylinder's axis, seen from the eye.
/// Azimuth 0 is −z of the cylinder's axes and rises to the right; radians.
class StripAzimuths {
public:
  /// Precondition: `set.strips`, with at least one piece of two planes. `axes`: cylinder axes to view axes.
  StripAzimuths(const plan::PieceSet& set, const glm::dmat3& axes);

  [[nodiscard]] const glm::mat3& axes_from_view() const { return axes_from_view_; }
  [[nodiscard]] const std::vector<float>& borders() const { return borders_; } ///< count() + 1, rising
  [[nodiscard]] int count() const { return static_cast<int>(borders_.size()) - 1; }
  [[nodiscard]] bool full_turn() const { return full_turn_; }

  /// Strips that the azimuths from `from` to `to` touch, to − from < 2π.
  [[nodiscard]] StripRange between(float from, float to) const;
  /// Strips that a triangle may touch, by its corners' azimuths. All strips when the axis pierces it.
  [[nodiscard]] StripRange triangle(float a, float b, float c) const;
  /// Strips that a sphere may touch; centre in cylinder axes.
  [[nodiscard]] StripRange sphere(const glm::vec3& center, float radius) const;

  [[nodiscard]] static float azimuth(const glm::vec3& p);

private:
  [[nodiscard]] int strip_at(float azimuth) const;

  glm::mat3 axes_from_view_;
  std::vector<float> borders_;
  bool full_turn_ = false;
};

} // namespace cupola::passes
