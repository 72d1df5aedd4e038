// The six faces of a cube as a horizontal cross, four faces wide and three high:
//
//        top
//   left front right back
//        bottom
//
// Each face is a perspective of 90° as seen from inside, its neighbours in the cross meeting it without a
// turn: top stands upright above front, back is what right turns to. The rest of the picture shows nothing.
// Between faces the map bends: breaks.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace cupola::projection {

struct CubeCrossMap {};

/// The point of the cube, half an edge from its centre to a face being 1, that an image point shows, in the
/// shape's axes.
[[nodiscard]] std::optional<glm::dvec3> cube_cross_ray(const CubeCrossMap& map, glm::dvec2 st, double zoom);

/// The plane of the face that `inside` lies on, without an end. nullopt where `inside` shows nothing.
[[nodiscard]] std::optional<glm::dvec3> cube_cross_beyond(const CubeCrossMap& map, glm::dvec2 st, double zoom,
                                                          glm::dvec2 inside);

/// Inverse, seen from `eye` inside the cube. On an edge of the cube one of the image points that show it.
[[nodiscard]] std::optional<glm::dvec2> cube_cross_point(const CubeCrossMap& map, const glm::dvec3& eye,
                                                         const glm::dvec3& direction, double zoom);

/// Pixels per radian in the middle of a face, the greater of both directions, without zoom and off-axis
/// vector.
[[nodiscard]] double cube_cross_density(const CubeCrossMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
