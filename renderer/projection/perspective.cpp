#include "renderer/projection/perspective.h"

#include <algorithm>

namespace cupola::projection {

std::optional<glm::dvec3> perspective_ray(const PerspectiveMap& map, glm::dvec2 st, double zoom) {
  return glm::dvec3(st.x / zoom * map.tan_half_h, st.y / zoom * map.tan_half_v, -1.0);
}

std::optional<glm::dvec2> perspective_point(const PerspectiveMap& map, const glm::dvec3& eye,
                                            const glm::dvec3& direction, double zoom) {
  const double ahead = -direction.z, distance = 1.0 + eye.z;
  if (!(ahead > 0.0) || !(distance > 0.0)) return std::nullopt;
  const double reach = distance / ahead;
  return glm::dvec2((eye.x + reach * direction.x) * zoom / map.tan_half_h,
                    (eye.y + reach * direction.y) * zoom / map.tan_half_v);
}

double perspective_density(const PerspectiveMap& map, glm::dvec2 size_px) {
  return std::max(0.5 * size_px.x / map.tan_half_h, 0.5 * size_px.y / map.tan_half_v);
}

} // namespace cupola::projection
