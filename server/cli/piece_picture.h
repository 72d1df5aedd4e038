// Borders of pieces as lines: drawn into a picture, or as SVG.
#pragma once

#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "renderer/outputs/image_file.h"
#include "renderer/plan/plan.h"

namespace cupola::cli {

/// Viewports whose pieces are drawn, of one output. They must have pieces.
using PiecedViewports = std::vector<const plan::ViewportPlan*>;

/// Draws the borders into the picture, of the output's size and opaque: black lines one pixel wide on a light
/// halo, dashes where triangles are looked up. A border between two columns or rows of pixels blackens the
/// right or lower one.
void draw_borders(outputs::ByteImage& picture, const PiecedViewports& viewports);

/// A polygon a piece, and a dashed path a triangle that is looked up, in pixels of the output, over the
/// picture as embedded PNG.
[[nodiscard]] model::Result<std::string> borders_as_svg(const outputs::ByteImage& picture,
                                                        const PiecedViewports& viewports);

} // namespace cupola::cli
