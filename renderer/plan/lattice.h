// A conforming mesh of right triangles that is refined by bisection (newest-vertex bisection, the "4-8"
// mesh): each triangle is halved across its longest side, together with the one beyond that side. Pure
// integers.
//
// Roots are rectangles of `across` × `down` times a power of two pixels, halved by a diagonal. Every sloped
// side is then a diagonal of such a rectangle, of whatever size: with `across` and `down` divisible by
// different powers of two, so are its dx and dy, and it keeps clear of all pixel centres.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace cupola::plan {

class Lattice {
public:
  static constexpr std::uint32_t none = 0xFFFFFFFF;

  struct Triangle {
    /// Corners; the first faces the longest side. Counter-clockwise on screen (y downwards: clockwise in x,
    /// y).
    std::array<std::uint32_t, 3> corners;
    std::array<std::uint32_t, 3> beyond; ///< neighbour across from each corner, or none
  };

  /// A part of the plane that roots of `root` pixels cover, from `origin`, at least `size` pixels.
  Lattice(glm::ivec2 origin, glm::ivec2 size, glm::ivec2 root);

  [[nodiscard]] const std::vector<glm::ivec2>& points() const { return points_; } ///< whole pixels
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

  /// Whether the triangle's longest side is still at least `shortest` pixels along x or y when halved, and
  /// its middle a whole pixel.
  [[nodiscard]] bool divisible(std::uint32_t triangle, int shortest) const;

  /// Halves a divisible triangle, and others as far as that needs. The numbers of all triangles that changed
  /// or are new are appended to `changed`; some may come twice.
  void bisect(std::uint32_t triangle, std::vector<std::uint32_t>& changed);

private:
  std::uint32_t halve(std::uint32_t triangle, std::uint32_t middle);
  void replace_neighbour(std::uint32_t of, std::uint32_t was, std::uint32_t is);

  std::vector<glm::ivec2> points_;
  std::vector<Triangle> triangles_;
};

} // namespace cupola::plan
