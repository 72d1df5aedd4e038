// A rectangle of pixels cut into triangles exactly, every sloped border keeping clear of all pixel centres.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <vector>

#include "renderer/plan/plan.h"

namespace cupola::plan {

/// Corners in pixels, counter-clockwise on the screen. Whole pixels, but for one corner of a single pixel
/// where width and height are both odd: no cut on whole pixels keeps clear of all centres then (colour
/// points by whether x and y are odd: some border would join the colours (even, odd) and (odd, even), or
/// (even, even) and (odd, odd), halfway between which a centre lies).
[[nodiscard]] std::vector<std::array<glm::dvec2, 3>> tile_triangles(const PixelRect& rect);

} // namespace cupola::plan
