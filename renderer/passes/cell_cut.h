// A triangle's part in one triangular piece: cutting it at the piece's borders. Pure, no GL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace cupola::passes {

/// A corner of a part: barycentric coordinates in the piece's pyramid and in the triangle.
struct Point {
  glm::vec3 in_piece;
  glm::vec3 in_triangle; ///< sum 1
  std::uint8_t edges;    ///< bits of the triangle's edges it lies on
  int border;            ///< of the piece: 0, 1, 2 opposite that corner; -1: a corner of the triangle
};

struct Polygon {
  std::array<Point, 6> points;
  int count = 0;
  void push(const Point& point) { points[static_cast<std::size_t>(count++)] = point; }
};

/// Keeps b[axis] >= 0. Cuts go from the inside to the outside whichever way round the polygon runs, so that
/// the two triangles at an edge find the same point.
void cut(const Polygon& in, int axis, Polygon& out);

} // namespace cupola::passes
