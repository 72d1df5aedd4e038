// What can be counted of pieces: their borders and sizes, and how far from the truth they draw, with nothing
// but the true map and the matrices of the pieces. Pure, no GL, any thread.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "renderer/plan/plan.h"

namespace cupola::plan {

/// Corners of a piece's polygon on the screen, in pixels of the viewport, y downwards: three of a triangle,
/// which may hang over the viewport; four of a strip and of a perspective.
[[nodiscard]] std::vector<glm::dvec2> outline(const PieceSet& set, std::size_t piece, const PixelRect& rect);

/// The same for a triangle in normalised device coordinates, y up.
[[nodiscard]] std::array<glm::dvec2, 3> in_pixels(const std::array<glm::dvec2, 3>& screen,
                                                  const PixelRect& rect);

/// Pixels whose centres lie within the polygon of a piece and within the viewport.
void each_pixel(const std::vector<glm::dvec2>& polygon, const PixelRect& rect,
                const std::function<void(int x, int y)>& take);

struct Extent {
  double smallest = 0.0, mean = 0.0, largest = 0.0;
};

/// Pixels that outlines reach across and down.
struct Extents {
  Extent width, height;
};
[[nodiscard]] Extents extents(const PieceSet& set, const PixelRect& rect);

/// Counts are of pixels of the grid.
struct Measured {
  double largest = 0.0, rms = 0.0; ///< pixels between where a piece draws a ray and where the map shows it
  double least_w = 0.0;            ///< of what pieces draw
  long shown = 0;                  ///< of the projection
  long drawn = 0, looked_up = 0;   ///< by pieces, from a cubemap
  long uncovered = 0, covered_twice = 0; ///< shown and by none; by more than one
  long not_shown = 0;                    ///< in pieces that claim that all is shown
  long outside_bounds = 0;               ///< drawn beyond Piece::bounds
};

/// Every `step`-th pixel centre of every `step`-th row; 1: all.
[[nodiscard]] Measured measure(const PieceSet& set, const projection::Map& map, const PixelRect& rect,
                               int step = 1);

} // namespace cupola::plan
