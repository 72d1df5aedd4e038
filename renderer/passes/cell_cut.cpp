#include "renderer/passes/cell_cut.h"

namespace cupola::passes {

namespace {

/// Where the segment from the inside point p to the outside point q meets the border b[axis] = 0.
Point meet(const Point& p, const Point& q, int axis) {
  const float t = p.in_piece[axis] / (p.in_piece[axis] - q.in_piece[axis]);
  Point out;
  out.in_piece = p.in_piece + t * (q.in_piece - p.in_piece);
  out.in_piece[axis] = 0.0f;
  out.in_triangle = p.in_triangle + t * (q.in_triangle - p.in_triangle);
  out.edges = p.edges & q.edges;
  out.border = axis;
  return out;
}

} // namespace

void cut(const Polygon& in, int axis, Polygon& out) {
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const Point& p = in.points[static_cast<std::size_t>(i)];
    const Point& q = in.points[static_cast<std::size_t>(i + 1 == in.count ? 0 : i + 1)];
    const bool p_in = p.in_piece[axis] >= 0.0f, q_in = q.in_piece[axis] >= 0.0f;
    if (p_in) out.push(p);
    if (p_in != q_in) out.push(p_in ? meet(p, q, axis) : meet(q, p, axis));
  }
  if (out.count < 3) out.count = 0;
}

} // namespace cupola::passes
