// How steep the edges of a picture are beside those of the picture that it should be. Pure, any thread.
#pragma once

#include <optional>

#include "renderer/reference/compare.h"

namespace cupola::reference {

/// Edge sharpness: over the pixels at which `wanted` has its steepest tenth of luma gradients (Sobel, of
/// those that are not 0), the part of got's gradient along wanted's, summed, over wanted's own sum. 1: as
/// steep; below: blurred or displaced; above: steeper, as without antialiasing. Pixels whose 3 × 3
/// neighbours are not all inside the picture, and with `mask` all opaque in `wanted`, are left out. Absent
/// where there is no edge. Precondition as compare's.
[[nodiscard]] std::optional<double> edge_sharpness(const Pixels& got, const Pixels& wanted,
                                                   bool mask = false);

} // namespace cupola::reference
