#include "renderer/plan/shown_rows.h"

#include <doctest/doctest.h>

using namespace cupola;
using namespace cupola::plan;

namespace {

long wrong_pixels(const projection::Map& map, glm::ivec2 size, const PixelRect& part) {
  const ShownRows rows(map, size, part);
  long wrong = 0, shown = 0;
  for (int y = part.y; y < part.y + part.height; ++y)
    for (int x = part.x; x < part.x + part.width; ++x) {
      const glm::dvec2 st(-1.0 + (2.0 * x + 1.0) / size.x, 1.0 - (2.0 * y + 1.0) / size.y);
      const bool truly = projection::ray(map, st).has_value();
      shown += truly ? 1 : 0;
      if (rows.shows(x, y) != truly) ++wrong;
    }
  CHECK(rows.count() == shown);
  return wrong;
}

} // namespace

TEST_CASE("rows say what asking every pixel says") {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {2, 3}, {64, 64}, {201, 333}, {700, 90}}) {
    CAPTURE(size.x);
    for (const double zoom : {0.4, 1.0, 3.0}) {
      CAPTURE(zoom);
      for (const model::Shape& shape :
           {model::Shape(model::Fisheye{}), model::Shape(model::Fisheye{{350.0}}),
            model::Shape(model::Perspective{}), model::Shape(model::Cylinder{{300.0}, {60.0}}),
            model::Shape(model::Equirectangular{}), model::Shape(model::Orthographic{}),
            model::Shape(model::Panini{})}) {
        CAPTURE(shape.index());
        model::Projection projection;
        projection.shape = shape;
        projection.zoom = zoom;
        const auto map = projection::make_map(projection, double(size.x) / size.y);
        CHECK(wrong_pixels(map, size, {0, 0, size.x, size.y}) == 0);
      }
    }
  }
}

TEST_CASE("a part without anything shown, and none outside a part") {
  model::Projection projection;
  projection.shape = model::Fisheye{};
  const auto map = projection::make_map(projection, 1.0);
  const ShownRows corner(map, {100, 100}, {0, 0, 10, 10});
  CHECK(corner.count() == 0);
  CHECK(corner.row(50).end == 0);
  CHECK(wrong_pixels(map, {100, 100}, {30, 0, 40, 20}) == 0);
}
