// The grid of a camera texture: where the vertices of a regular grid over a flat picture land, and both ways
// between a point of that picture and where it lands. Each cell is two triangles, linear in each: that, not
// what the vertices were sampled from, is the truth.
//
// Cells are numbered from the top left, row by row, as rows lie in files; each is halved from its top left to
// its bottom right corner, the lower left half first. Places are image coordinates: s right, t up, [-1,1].
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace cupola::projection {

class CameraGrid {
public:
  /// `landings`: of (rows + 1) · (columns + 1) vertices, from the top left, row by row; all finite.
  CameraGrid(int columns, int rows, std::vector<glm::dvec2> landings);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] std::uint32_t triangle_count() const;

  /// Vertices of a triangle, counter-clockwise in the flat picture.
  [[nodiscard]] std::array<std::uint32_t, 3> triangle(std::uint32_t index) const;
  /// Where a vertex stands in the flat picture, and where it lands.
  [[nodiscard]] glm::dvec2 place(std::uint32_t vertex) const;
  [[nodiscard]] glm::dvec2 landing(std::uint32_t vertex) const { return landings_[vertex]; }
  /// Twice the area that a triangle covers; negative where it is folded over, 0 where it is flat.
  [[nodiscard]] double twice_area(std::uint32_t triangle) const;

  /// The place that is seen at an image point, by the first triangle that covers it. nullopt where none does.
  [[nodiscard]] std::optional<glm::dvec2> seen_at(glm::dvec2 st) const;
  /// All triangles that cover an image point, in rising order; those that share a border meet there.
  [[nodiscard]] std::vector<std::uint32_t> covering(glm::dvec2 st) const;
  /// The place that is seen at an image point by one triangle, continued beyond its borders. Precondition: it
  /// is not flat.
  [[nodiscard]] glm::dvec2 seen_by(std::uint32_t triangle, glm::dvec2 st) const;
  /// Where a place of the flat picture lands. nullopt outside it.
  [[nodiscard]] std::optional<glm::dvec2> lands(glm::dvec2 place) const;

private:
  struct Bins {
    int columns = 1, rows = 1;
  };
  struct Range {
    int left, right, top, bottom; ///< bins, inclusive
  };
  [[nodiscard]] Range bins_of(std::uint32_t triangle, const Bins& bins) const;
  [[nodiscard]] int column_of(double s, const Bins& bins) const;
  [[nodiscard]] int row_of(double t, const Bins& bins) const;
  void sort_into_bins();
  /// Calls visit(triangle, shares) for each triangle that covers the point, until it returns false.
  template <class Visit>
  void visit_covering(glm::dvec2 st, const Visit& visit) const;
  /// Barycentric coordinates of corners 1 and 2; not finite where the triangle is flat.
  [[nodiscard]] glm::dvec2 shares(std::uint32_t triangle, glm::dvec2 st) const;
  [[nodiscard]] glm::dvec2 place_of(std::uint32_t triangle, glm::dvec2 shares) const;

  int columns_, rows_;
  std::vector<glm::dvec2> landings_;
  glm::dvec2 low_, high_; ///< of all landings
  Bins bins_;
  std::vector<std::uint32_t> first_, held_; ///< triangles by bin, each bin's in rising order
};

} // namespace cupola::projection
