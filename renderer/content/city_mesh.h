// The triangles of a planned city. Private to the city.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/content/city_plan.h"
#include "renderer/content/scene.h"

namespace cupola::content::city {

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::vector<std::uint32_t>> triangles; ///< by group
};

[[nodiscard]] Mesh build(const Plan& plan);

} // namespace cupola::content::city
