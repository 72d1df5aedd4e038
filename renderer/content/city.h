// The generated city. Streets in a grid, the origin in the middle of a crossing at street level (y = 0),
// towers around it, lower houses outwards, parks, trees; meadows to the horizon and a closed sky around
// everything. Metres. The same seed and size give the same bytes on every machine.
#pragma once

#include "configs/model/show.h"
#include "renderer/content/scene.h"

namespace cupola::content {

/// Fourteen materials, and triangles within 2 % of what is asked (500 to 5,000,000). On two cores it
/// takes about a second for the pictures and a microsecond for each triangle; 5,000,000 need 0.9 GB
/// meanwhile.
[[nodiscard]] Scene make_city(const model::City& city);

} // namespace cupola::content
