// Corners of triangular pieces: rays and weights of a map.
#pragma once

#include <optional>

#include "renderer/plan/plan.h"

namespace cupola::plan {

/// A picture and the part of it between breaks that is looked at; places are pixels, y downwards.
struct PictureMap {
  const projection::Map& map;
  glm::ivec2 size;
  glm::dvec2 inside{0.0}; ///< image coordinates of a point of the part that shows something

  [[nodiscard]] glm::dvec2 image(glm::dvec2 at) const;
  /// What is seen at a place; continued beyond what is shown.
  [[nodiscard]] std::optional<glm::dvec3> ray(glm::dvec2 at) const;
  /// The weight of a corner there: the cube root of the solid angle of a pixel, up to a factor. It is the one
  /// with which the second derivatives of the map, less those of a perspective, have no trace [T. Y. Thomas,
  /// On the projective and equi-projective geometries of paths, 1925]: −ray.z for a perspective, the
  /// horizontal length for a cylinder. nullopt where there is none above 0.
  [[nodiscard]] std::optional<double> weight(glm::dvec2 at) const;
};

/// Where a triangular piece draws a ray, in the pixels of its corners.
class Drawing {
public:
  /// `corners`: their `screen` is not used but `at`, pixels.
  Drawing(const std::array<Corner, 3>& corners, const std::array<glm::dvec2, 3>& at);

  [[nodiscard]] glm::dvec2 operator()(const glm::dvec3& ray) const;
  /// Whether the pyramid is wide enough for its planes to be told apart.
  [[nodiscard]] bool fit() const { return fit_; }

private:
  std::array<glm::dvec3, 3> shares_; ///< times a ray: bᵢ wᵢ, but for a common factor
  std::array<glm::dvec2, 3> at_;
  bool fit_;
};

} // namespace cupola::plan
