#include "renderer/projection/camera_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "renderer/projection/deformation.h"

namespace cupola::projection {

namespace {

std::vector<const model::Deformation*> in_order(const model::CameraTexture& texture) {
  std::vector<const model::Deformation*> out;
  for (const auto& [name, deformation] : texture.deformations) out.push_back(&deformation);
  std::stable_sort(out.begin(), out.end(), [](const auto* a, const auto* b) { return a->order < b->order; });
  return out;
}

} // namespace

CameraTextureMap make_camera_texture(const model::CameraTexture& texture, double aspect) {
  const double across = std::tan(texture.horizontal_fov.radians() / 2);
  const PerspectiveMap base{across, texture.vertical_fov ? std::tan(texture.vertical_fov->radians() / 2)
                                                         : across / aspect};
  const glm::dvec2 circle(std::max(aspect, 1.0), std::max(1.0 / aspect, 1.0));
  const auto deformations = in_order(texture);
  const auto columns = static_cast<std::size_t>(texture.columns),
             rows = static_cast<std::size_t>(texture.rows);
  std::vector<glm::dvec2> landings;
  landings.reserve((columns + 1) * (rows + 1));
  for (std::size_t row = 0; row <= rows; ++row)
    for (std::size_t column = 0; column <= columns; ++column) {
      glm::dvec2 at(2.0 * double(column) / double(columns) - 1.0, 1.0 - 2.0 * double(row) / double(rows));
      if (row < texture.offsets.size() && column < texture.offsets[row].size())
        at += texture.offsets[row][column];
      for (const model::Deformation* deformation : deformations) at = deformed(*deformation, at, circle);
      landings.push_back(at);
    }
  return {base, std::make_shared<const CameraGrid>(texture.columns, texture.rows, std::move(landings))};
}

std::optional<glm::dvec3> camera_texture_ray(const CameraTextureMap& map, glm::dvec2 st, double zoom) {
  const auto place = map.grid->seen_at(st / zoom);
  if (!place) return std::nullopt;
  return perspective_ray(map.base, *place, 1.0);
}

std::optional<glm::dvec3> camera_texture_ray_by(const CameraTextureMap& map, std::uint32_t triangle,
                                                glm::dvec2 st, double zoom) {
  return perspective_ray(map.base, map.grid->seen_by(triangle, st / zoom), 1.0);
}

std::optional<glm::dvec2> camera_texture_point(const CameraTextureMap& map, const glm::dvec3& eye,
                                               const glm::dvec3& direction, double zoom) {
  const auto place = perspective_point(map.base, eye, direction, 1.0);
  const auto landing = place ? map.grid->lands(*place) : std::nullopt;
  if (!landing) return std::nullopt;
  return *landing * zoom;
}

double camera_texture_density(const CameraTextureMap& map, glm::dvec2 size_px) {
  return perspective_density(map.base, size_px);
}

} // namespace cupola::projection
