#include "renderer/projection/cube_cross.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace cupola::projection {

namespace {

constexpr double border = 1e-12; // a point that was computed to lie on the cross's border belongs to it

/// Where a face stands in the cross, from the top left, and its axes: to the right, up, outwards.
struct Face {
  double column, row;
  glm::dvec3 right, up, out;
};
constexpr std::array<Face, 6> faces{{{1, 1, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
                                     {2, 1, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                                     {0, 1, {0, 0, -1}, {0, 1, 0}, {-1, 0, 0}},
                                     {3, 1, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                     {1, 0, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                     {1, 2, {1, 0, 0}, {0, 0, -1}, {0, -1, 0}}}};

/// Places in the cross, x to the right and y down from its top left corner, a face being 1.
glm::dvec2 place(glm::dvec2 st, double zoom) {
  return {(st.x / zoom + 1.0) * 2.0, (1.0 - st.y / zoom) * 1.5};
}

const Face* face_at(glm::dvec2 at) {
  for (const Face& face : faces)
    if (at.x >= face.column - border && at.x <= face.column + 1.0 + border && at.y >= face.row - border &&
        at.y <= face.row + 1.0 + border)
      return &face;
  return nullptr;
}

glm::dvec3 on_face(const Face& face, glm::dvec2 at) {
  return face.out + (2.0 * (at.x - face.column) - 1.0) * face.right +
         (1.0 - 2.0 * (at.y - face.row)) * face.up;
}

} // namespace

std::optional<glm::dvec3> cube_cross_ray(const CubeCrossMap& map, glm::dvec2 st, double zoom) {
  return cube_cross_beyond(map, st, zoom, st);
}

std::optional<glm::dvec3> cube_cross_beyond(const CubeCrossMap&, glm::dvec2 st, double zoom,
                                            glm::dvec2 inside) {
  const Face* face = face_at(place(inside, zoom));
  if (!face) return std::nullopt;
  return on_face(*face, place(st, zoom));
}

std::optional<glm::dvec2> cube_cross_point(const CubeCrossMap&, const glm::dvec3& eye,
                                           const glm::dvec3& direction, double zoom) {
  const Face* face = nullptr;
  double reach = std::numeric_limits<double>::infinity();
  for (const Face& one : faces) {
    const double ahead = glm::dot(one.out, direction), distance = 1.0 - glm::dot(one.out, eye);
    if (!(distance > 0.0)) return std::nullopt;
    if (!(ahead > 0.0) || !(distance < reach * ahead)) continue;
    reach = distance / ahead;
    face = &one;
  }
  if (!face) return std::nullopt;
  const glm::dvec3 hit = eye + reach * direction;
  const glm::dvec2 at(face->column + 0.5 * (1.0 + glm::dot(face->right, hit)),
                      face->row + 0.5 * (1.0 - glm::dot(face->up, hit)));
  return glm::dvec2((at.x / 2.0 - 1.0) * zoom, (1.0 - at.y / 1.5) * zoom);
}

double cube_cross_density(const CubeCrossMap&, glm::dvec2 size_px) {
  return std::max(size_px.x / 8.0, size_px.y / 6.0);
}

} // namespace cupola::projection
