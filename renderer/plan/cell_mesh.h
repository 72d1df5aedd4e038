// Triangular pieces of a map on a lattice, refined where the map bends and balanced: the rays of the corners
// are those a fraction of a pixel beside them, chosen so that the error swings to both sides of zero. A
// piece's error is then half of what exact corners give, and pieces are twice as large.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/plan/corner.h"
#include "renderer/plan/lattice.h"
#include "renderer/plan/plan.h"
#include "renderer/plan/shown_rows.h"

namespace cupola::plan {

/// Pixels of error, where more than that is allowed nowhere, above which the smallest cells are looked up in
/// a cubemap rather than drawn.
inline constexpr double worst_drawn = 0.25;

class CellMesh {
public:
  /// Of a picture of `picture` pixels, what `rows` says is shown; `rows` must outlive the mesh. At most
  /// `budget` pieces.
  CellMesh(const projection::Map& map, glm::ivec2 picture, const ShownRows& rows, double max_error,
           std::size_t budget);

  /// Appends what is shown: pieces, and what must be looked up.
  void append_to(PieceSet& set) const;

private:
  enum class Coverage : std::uint8_t { none, some, whole }; ///< of its pixels, by what is shown

  struct Node {
    bool fit = false; ///< has a ray and a weight
    glm::dvec3 ray{0.0};
    double weight = 1.0;
    glm::dvec2 shift{0.0}; ///< pixels from the corner to the image point whose ray it has
  };

  struct Sample {
    std::array<double, 3> share; ///< barycentric coordinates on the screen
    glm::dvec2 at;               ///< pixels of the picture, y downwards
    glm::dvec3 ray;              ///< that is truly seen there
    glm::dvec2 error{0.0};       ///< where the piece draws it − at
  };

  struct Cell {
    Coverage coverage = Coverage::none;
    double error = 0.0; ///< pixels; infinite where its pyramid cannot be drawn
    std::uint32_t first_sample = 0, sample_count = 0;
  };

  void refine();
  void balance();
  bool split_bad();
  void measure_all();
  void grow();
  void add_node(glm::dvec2 at);
  void aim(Node& node, glm::dvec2 at);
  [[nodiscard]] Coverage coverage(std::uint32_t triangle) const;
  [[nodiscard]] bool splittable(std::uint32_t triangle) const;
  [[nodiscard]] double balanced_error(std::uint32_t triangle);
  void sample(std::uint32_t triangle);
  void sample_shown(std::uint32_t triangle);
  bool add_sample(std::uint32_t triangle, glm::dvec2 at, const std::array<double, 3>& share);
  void measure(std::uint32_t triangle);
  void relax(int sweeps);
  template <class Row>
  void each_row(std::uint32_t triangle, Row row) const;

  PictureMap picture_;
  const ShownRows& rows_;
  double limit_; ///< what samples must keep to, a little below the error allowed
  std::size_t budget_;
  Lattice lattice_;
  std::vector<Node> nodes_; ///< by point of the lattice
  std::vector<Cell> cells_; ///< by triangle of the lattice
  std::vector<Sample> samples_;
};

} // namespace cupola::plan
