// The painted pictures of the city's fourteen groups. Private to the city.
#pragma once

#include "renderer/content/city_plan.h"
#include "renderer/content/scene.h"

namespace cupola::content::city {

[[nodiscard]] Image paint_glass();
[[nodiscard]] Image paint_office();
[[nodiscard]] Image paint_stone();
[[nodiscard]] Image paint_brick();
[[nodiscard]] Image paint_plaster();
[[nodiscard]] Image paint_shop();
[[nodiscard]] Image paint_flat_roof();
[[nodiscard]] Image paint_tiled_roof();
[[nodiscard]] Image paint_street();
[[nodiscard]] Image paint_crossing();
[[nodiscard]] Image paint_pavement();
[[nodiscard]] Image paint_grass();
[[nodiscard]] Image paint_tree();
[[nodiscard]] Image paint_sky();

} // namespace cupola::content::city
