// Cylinder viewports for the tests of this room.
#pragma once

#include "renderer/passes/strip_range.h"
#include "renderer/plan/plan.h"

namespace cupola::tests {

struct CylinderView {
  plan::PieceSet set;
  projection::Map map;
};

/// 800 × 400 pixels.
inline CylinderView cylinder_view(double fov, double vertical_fov = 100.0,
                                  glm::dvec3 off_axis = glm::dvec3(0.0), model::Orientation turn = {}) {
  model::Projection projection;
  projection.shape = model::Cylinder{{fov}, {vertical_fov}};
  projection.off_axis = off_axis;
  projection.orientation = turn;
  CylinderView made;
  made.map = projection::make_map(projection, 2.0);
  made.set = *plan::make_strips(made.map, {0, 0, 800, 400}, 0.25);
  return made;
}

} // namespace cupola::tests
