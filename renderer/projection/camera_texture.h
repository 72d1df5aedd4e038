// A camera texture: a grid of offsets over a perspective [Lorenz & Döllner, sec. 3.2]. A forward map: a point
// of the perspective's picture lands beside where it was; the grid is linear in each of its triangles.
//
// Rays are the perspective's, so that a grid without offsets is that perspective, as far as its picture
// reaches; what no triangle covers shows nothing. Where the grid folds, several places land on one image
// point, and what is nearest there is seen; the one ray that camera_texture_ray() knows is that of the first
// triangle in the grid's order. Zoom magnifies the picture after it is deformed.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "configs/model/show.h"
#include "renderer/projection/camera_grid.h"
#include "renderer/projection/perspective.h"

namespace cupola::projection {

struct CameraTextureMap {
  PerspectiveMap base;
  std::shared_ptr<const CameraGrid> grid; ///< never null
};

/// The grid's vertices: offsets first, then the deformations by order and name. `aspect`: of the viewport.
[[nodiscard]] CameraTextureMap make_camera_texture(const model::CameraTexture& texture, double aspect);

/// The point of the plane z = -1 that an image point shows, in the shape's axes.
[[nodiscard]] std::optional<glm::dvec3> camera_texture_ray(const CameraTextureMap& map, glm::dvec2 st,
                                                           double zoom);

/// The same by one triangle of the grid, continued beyond its borders. Precondition: it is not flat.
[[nodiscard]] std::optional<glm::dvec3>
camera_texture_ray_by(const CameraTextureMap& map, std::uint32_t triangle, glm::dvec2 st, double zoom);

/// Inverse, seen from `eye`: the image point where the direction's place in the perspective lands; in a fold
/// another place may be seen there. nullopt outside the perspective's picture.
[[nodiscard]] std::optional<glm::dvec2> camera_texture_point(const CameraTextureMap& map,
                                                             const glm::dvec3& eye,
                                                             const glm::dvec3& direction, double zoom);

/// The perspective's own: what the deformation magnifies holds no more detail than the picture that it bends.
[[nodiscard]] double camera_texture_density(const CameraTextureMap& map, glm::dvec2 size_px);

} // namespace cupola::projection
