#include "renderer/plan/tiles.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace cupola::plan;

TEST_CASE("tiles cover a rectangle exactly, borders clear of all pixel centres") {
  constexpr struct {
    int width, height;
  } sizes[] = {{1, 1}, {2, 2}, {3, 3}, {1, 100}, {256, 256}, {341, 341}, {512, 384}, {340, 342}, {97, 16}};
  for (const auto& size : sizes) {
    const int width = size.width, height = size.height;
    CAPTURE(width);
    CAPTURE(height);
    const PixelRect rect{5, 9, width, height};
    const auto triangles = tile_triangles(rect);
    CHECK(triangles.size() < 400);
    std::vector<int> covered(static_cast<std::size_t>(width * height), 0);
    double nearest = 1.0, area = 0.0;
    for (const auto& triangle : triangles) {
      const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
      const double doubled = -cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
      REQUIRE(doubled > 0.0); // counter-clockwise on the screen
      area += 0.5 * doubled;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          double least = 1e9;
          for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 a = triangle[i], side = triangle[(i + 1) % 3] - a;
            least = std::min(least, -cross(side, glm::dvec2(rect.x + x + 0.5, rect.y + y + 0.5) - a) /
                                        glm::length(side));
          }
          nearest = std::min(nearest, std::abs(least));
          if (least > 0.0) ++covered[static_cast<std::size_t>(y * width + x)];
        }
    }
    CHECK(area == doctest::Approx(width * height));
    CHECK(std::count(covered.begin(), covered.end(), 1) == width * height);
    CHECK(nearest > 0.015); // 4 of the 256 steps to a pixel in which corners are placed
  }
}

TEST_CASE("an empty rectangle has no tiles") { CHECK(tile_triangles({0, 0, 0, 5}).empty()); }
