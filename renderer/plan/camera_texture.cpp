// The pieces of a camera texture: its triangles, each one perspective, exactly [Lorenz & Döllner, sec. 3.2].
//
// A triangle of the flat picture is three rays of length 1/ω that end on one plane, and its map to where it
// lands is affine. With weight ω at each corner the piece's map is the product of both: no error.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "renderer/plan/plan.h"

namespace cupola::plan {

namespace {

using projection::CameraGrid;

/// Smaller than the square of a float's step across the picture: covers no sample of any size.
constexpr double flat_area = 1e-14;

/// The grid's outline, counter-clockwise in the flat picture.
std::vector<glm::dvec2> outline(const CameraGrid& grid) {
  const auto columns = static_cast<std::uint32_t>(grid.columns()),
             rows = static_cast<std::uint32_t>(grid.rows());
  const auto vertex = [&](std::uint32_t column, std::uint32_t row) {
    return grid.landing(row * (columns + 1) + column);
  };
  std::vector<glm::dvec2> out;
  for (std::uint32_t row = 0; row < rows; ++row) out.push_back(vertex(0, row));
  for (std::uint32_t column = 0; column < columns; ++column) out.push_back(vertex(column, rows));
  for (std::uint32_t row = rows; row > 0; --row) out.push_back(vertex(columns, row));
  for (std::uint32_t column = columns; column > 0; --column) out.push_back(vertex(column, 0));
  return out;
}

/// Whether a line meets the box of half-width `reach` about the centre.
bool meets(glm::dvec2 from, glm::dvec2 to, glm::dvec2 reach) {
  double low = 0.0, high = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = to[axis] - from[axis];
    if (step == 0.0) {
      if (std::abs(from[axis]) > reach[axis]) return false;
      continue;
    }
    const double a = (-reach[axis] - from[axis]) / step, b = (reach[axis] - from[axis]) / step;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  return low <= high;
}

/// Every pixel centre is covered for certain: the outline goes round all of them and meets the box about
/// none. How often it goes round a point is how often the grid covers it, each folded cover counting against.
bool covers_all(const CameraGrid& grid, double zoom, const PixelRect& rect) {
  const glm::dvec2 reach(1.0 - 1.0 / rect.width, 1.0 - 1.0 / rect.height);
  const std::vector<glm::dvec2> points = outline(grid);
  double turned = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 from = points[i] * zoom, to = points[(i + 1) % points.size()] * zoom;
    if (meets(from, to, reach)) return false;
    turned += std::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
  }
  return std::abs(turned) > 1.0;
}

/// Whether a triangle lies beyond one edge of the picture.
bool outside(const std::array<glm::dvec2, 3>& at) {
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0})
      if (side * at[0][axis] >= 1.0 && side * at[1][axis] >= 1.0 && side * at[2][axis] >= 1.0) return true;
  return false;
}

} // namespace

std::optional<PieceSet> make_camera_texture_pieces(const projection::Map& map, const PixelRect& rect) {
  const auto* texture = std::get_if<projection::CameraTextureMap>(&map.shape);
  if (!texture || rect.width <= 0 || rect.height <= 0 || !projection::inside(map)) return std::nullopt;
  const CameraGrid& grid = *texture->grid;
  const projection::Map flat = projection::before_bending(map);
  PieceSet set;
  const auto vertices =
      static_cast<std::uint32_t>(grid.columns() + 1) * static_cast<std::uint32_t>(grid.rows() + 1);
  set.corners.reserve(vertices);
  for (std::uint32_t i = 0; i < vertices; ++i) {
    const auto ray = projection::ray(flat, grid.place(i));
    if (!ray) return std::nullopt;
    const double length = glm::length(*ray);
    set.corners.push_back({*ray / length, 1.0 / length, grid.landing(i) * map.zoom});
  }
  for (std::uint32_t i = 0; i < grid.triangle_count(); ++i) {
    const auto triangle = grid.triangle(i);
    if (std::abs(grid.twice_area(i)) * map.zoom * map.zoom < flat_area) continue;
    if (outside({set.corners[triangle[0]].screen, set.corners[triangle[1]].screen,
                 set.corners[triangle[2]].screen}))
      continue;
    set.triangles.push_back(triangle);
  }
  if (set.triangles.empty()) return std::nullopt;
  set.shown.assign(set.triangles.size(), Shown::all);
  set.fills = covers_all(grid, map.zoom, rect);
  finish_triangles(set, rect);
  return set;
}

std::optional<Fold> first_fold(const projection::Map& map) {
  const auto* texture = std::get_if<projection::CameraTextureMap>(&map.shape);
  if (!texture) return std::nullopt;
  const CameraGrid& grid = *texture->grid;
  std::optional<Fold> first;
  for (std::uint32_t i = 0; i < grid.triangle_count(); ++i) {
    const double area = grid.twice_area(i);
    if (area >= flat_area) continue;
    const int cell = static_cast<int>(i / 2);
    if (!first) first = Fold{cell % grid.columns(), cell / grid.columns(), area > -flat_area, 0};
    ++first->triangles;
  }
  return first;
}

} // namespace cupola::plan
