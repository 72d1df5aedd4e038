// Where the camera is at a time. Pure.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "configs/model/show.h"

namespace cupola::plan {

struct CameraPose {
  glm::dvec3 position{0.0};
  glm::dmat3 orientation{1.0}; ///< view axes to world axes: world = orientation · view + position
};

/// `time` in seconds of show time. On a path: smooth through the key frames (position by Catmull–Rom,
/// orientation by spherical interpolation the short way round), held before the first and after the last
/// unless it loops.
[[nodiscard]] CameraPose camera_at(const model::Camera& camera, double time);

} // namespace cupola::plan
