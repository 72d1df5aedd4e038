#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "renderer/projection/deformation.h"
#include "renderer/projection/map.h"

using namespace cupola;
using namespace cupola::projection;

namespace {

constexpr double aspect = 4.0 / 3;

model::Projection projection_of(model::CameraTexture texture, double zoom = 1.0) {
  model::Projection p;
  p.shape = std::move(texture);
  p.zoom = zoom;
  return p;
}

model::CameraTexture grid_of(int columns, int rows) {
  model::CameraTexture texture;
  texture.columns = columns;
  texture.rows = rows;
  return texture;
}

model::CameraTexture swirled(int columns, int rows) {
  model::CameraTexture texture = grid_of(columns, rows);
  texture.deformations["bulge"] = {model::RadialZoom{0.6}, 0.1, -0.05, 0.9, 0};
  texture.deformations["turn"] = {model::Swirl{{40.0}}, 0.0, 0.0, 0.8, 1};
  return texture;
}

const CameraGrid& grid(const Map& map) { return *std::get<CameraTextureMap>(map.shape).grid; }

glm::dvec2 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  const double s = anywhere(random);
  return {s, anywhere(random)};
}

/// seen_at without bins.
std::optional<glm::dvec2> first_triangle(const CameraGrid& grid, glm::dvec2 st) {
  for (std::uint32_t i = 0; i < grid.triangle_count(); ++i) {
    const auto [a, b, c] = grid.triangle(i);
    const glm::dmat2 sides(grid.landing(b) - grid.landing(a), grid.landing(c) - grid.landing(a));
    if (grid.twice_area(i) == 0.0) continue;
    const glm::dvec2 shares = glm::inverse(sides) * (st - grid.landing(a));
    if (shares.x < 0.0 || shares.y < 0.0 || shares.x + shares.y > 1.0) continue;
    return grid.place(a) + shares.x * (grid.place(b) - grid.place(a)) +
           shares.y * (grid.place(c) - grid.place(a));
  }
  return std::nullopt;
}

} // namespace

TEST_CASE("a grid without offsets is its perspective, as far as the picture reaches") {
  model::Projection flat;
  flat.shape = model::Perspective{{75.0}, {}};
  const Map perspective = make_map(flat, aspect), bent = make_map(projection_of(grid_of(17, 9)), aspect);
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 st = random_point(random);
    const auto direction = ray(bent, st);
    REQUIRE(direction);
    CHECK(glm::length(*direction - *ray(perspective, st)) < 1e-13);
    CHECK(glm::length(*image_point(bent, *direction) - st) < 1e-12);
  }
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {1, -1}, {-1, 1}, {1, 1}, {0, 1}})
    CHECK(ray(bent, corner));
  CHECK_FALSE(ray(bent, {1.001, 0}));
  CHECK_FALSE(beyond(bent, {1.001, 0}, {0, 0}));
  CHECK_FALSE(image_point(bent, {1, 0, -1}));
  CHECK_FALSE(image_point(bent, {0, 0, 1}));
  CHECK(matched_density(bent, {1600, 1200}) == matched_density(perspective, {1600, 1200}));
  CHECK(pixel_density(bent, {0.1, 0.2}, {1600, 1200}) ==
        doctest::Approx(pixel_density(perspective, {0.1, 0.2}, {1600, 1200})).epsilon(1e-4));
  CHECK(std::get<PerspectiveMap>(before_bending(bent).shape).tan_half_h ==
        std::get<PerspectiveMap>(perspective.shape).tan_half_h);
}

TEST_CASE("one cell: hand-worked, offsets by rows from the top, two triangles") {
  model::CameraTexture texture = grid_of(1, 1);
  texture.horizontal_fov = {90.0};
  texture.offsets = {{{0, 0}, {0, -1}}, {{0, 0}, {0, 0}}}; // the top right corner comes down to the middle
  const Map map = make_map(projection_of(texture), 1.0);
  // Upper right triangle: (-1,1), (1,-1), (1,0).
  CHECK(glm::length(*ray(map, {1, 0}) - glm::dvec3(1, 1, -1)) < 1e-12);
  CHECK(glm::length(*ray(map, {0, 0.5}) - glm::dvec3(0, 1, -1)) < 1e-12); // on its upper side
  CHECK_FALSE(ray(map, {0.5, 0.5}));
  CHECK(glm::length(*ray(map, {-0.5, -0.5}) - glm::dvec3(-0.5, -0.5, -1)) < 1e-12); // the other is as it was
  CHECK(glm::length(*image_point(map, {1, 1, -1}) - glm::dvec2(1, 0)) < 1e-12);
  const Map zoomed = make_map(projection_of(texture, 2.0), 1.0); // magnified after it is bent
  CHECK(glm::length(*ray(zoomed, {0.5, 0.5}) - *ray(map, {0.25, 0.25})) < 1e-12);
  CHECK(ray(zoomed, {1, 0}));
}

TEST_CASE("off-axis, turned, zoomed: ray and image point undo each other") {
  model::Projection p = projection_of(swirled(64, 48), 1.3);
  p.off_axis = {0.3, -0.2, 0.4};
  p.orientation = {{30}, {-20}, {10}};
  const Map map = make_map(p, aspect);
  std::mt19937 random(2);
  int shown = 0;
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec2 st = random_point(random);
    const auto direction = ray(map, st);
    if (!direction) continue;
    ++shown;
    const auto back = image_point(map, *direction);
    REQUIRE(back);
    CHECK(glm::length(*back - st) < 1e-9);
  }
  CHECK(shown > 15'000);
}

TEST_CASE("deformations: hand-worked values") {
  const glm::dvec2 round(1, 1);
  const auto moved = [&](const model::Deformation& deformation, glm::dvec2 st) {
    return deformed(deformation, st, round);
  };
  const double bell = std::exp(-0.25);
  CHECK(moved({model::RadialZoom{0.5}, 0, 0, 1.0, 0}, {0.5, 0}).x == doctest::Approx(0.5 + 0.25 * bell));
  CHECK(moved({model::RadialZoom{0.5}, 0.5, 0, 1.0, 0}, {0.5, 0}) == glm::dvec2(0.5, 0)); // the centre stays
  const glm::dvec2 turned = moved({model::Swirl{{90.0}}, 0, 0, 1e9, 0}, {0.5, 0});
  CHECK(glm::length(turned - glm::dvec2(0, 0.5)) < 1e-12); // counter-clockwise
  const model::Deformation lens{model::Lens{1.0}, 0, 0, 0.5, 0};
  CHECK(moved(lens, {0.25, 0}).x == doctest::Approx(0.25 * 1.5)); // half way: half of it
  CHECK(moved(lens, {0.5, 0}) == glm::dvec2(0.5, 0));
  CHECK(moved(lens, {0.3, 0.7}) == glm::dvec2(0.3, 0.7));
  const model::Deformation ripple{model::Ripple{0.02, 0.4}, 0, 0, 1.0, 0};
  CHECK(moved(ripple, {0.1, 0}).x == doctest::Approx(0.1 + 0.02 * std::exp(-0.01)));
  CHECK(moved(ripple, {0, 0}) == glm::dvec2(0, 0));
  // In a wide picture circles stay round: 0.25 across is 0.5 of half the height.
  const double wide = deformed({model::RadialZoom{0.5}, 0, 0, 1.0, 0}, {0.25, 0}, {2, 1}).x;
  CHECK(wide == doctest::Approx(0.25 + 0.125 * bell));
}

TEST_CASE("deformations act in their order, after the offsets") {
  model::CameraTexture texture = grid_of(1, 1);
  texture.offsets = {{{0.5, 0}, {0, 0}}, {{0, 0}, {0, 0}}};
  texture.deformations["b"] = {model::Swirl{{90.0}}, 0, 0, 100.0, 0};
  texture.deformations["a"] = {model::RadialZoom{1.0}, 0.5, 1.0, 100.0, 1};
  const Map map = make_map(projection_of(texture), 1.0);
  // (-1,1) moves to (-0.5,1), is turned to (-1,-0.5), then twice as far from (0.5,1).
  CHECK(glm::length(grid(map).landing(0) - glm::dvec2(-2.5, -2.0)) < 2e-3);
}

TEST_CASE("any grid: bins find what a search over all triangles finds") {
  std::mt19937 random(3);
  for (const double size : {0.01, 0.3, 4.0}) { // slight; folded; in disorder
    model::CameraTexture texture = grid_of(13, 7);
    std::uniform_real_distribution<double> offset(-size, size);
    texture.offsets.assign(8, std::vector<glm::dvec2>(14));
    for (auto& row : texture.offsets)
      for (glm::dvec2& pair : row) pair = {offset(random), offset(random)};
    const Map map = make_map(projection_of(texture), aspect);
    int shown = 0;
    for (int i = 0; i < 3000; ++i) {
      const glm::dvec2 st = random_point(random);
      const auto found = grid(map).seen_at(st), wanted = first_triangle(grid(map), st);
      REQUIRE(found.has_value() == wanted.has_value());
      if (!found) continue;
      ++shown;
      CHECK(glm::length(*found - *wanted) < 1e-9);
    }
    CHECK(shown > 1000);
  }
}

TEST_CASE("a fold: every triangle that covers a point is found, and its own ray lands there") {
  std::mt19937 random(5);
  model::CameraTexture texture = grid_of(13, 7);
  std::uniform_real_distribution<double> offset(-0.4, 0.4);
  texture.offsets.assign(8, std::vector<glm::dvec2>(14));
  for (auto& row : texture.offsets)
    for (glm::dvec2& pair : row) pair = {offset(random), offset(random)};
  const Map map = make_map(projection_of(texture), aspect);
  CHECK(folds(map));
  CHECK_FALSE(folds(make_map(projection_of(grid_of(13, 7)), aspect)));
  std::size_t several = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 st = random_point(random);
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t triangle = 0; triangle < grid(map).triangle_count(); ++triangle) {
      const auto corners = grid(map).triangle(triangle);
      std::array<double, 3> sides{};
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 a = grid(map).landing(corners[k]), b = grid(map).landing(corners[(k + 1) % 3]);
        sides[k] = (b.x - a.x) * (st.y - a.y) - (b.y - a.y) * (st.x - a.x);
      }
      const auto [least, most] = std::minmax({sides[0], sides[1], sides[2]});
      if (least >= 0.0 || most <= 0.0) wanted.push_back(triangle);
    }
    CHECK(covering(map, st) == wanted);
    several += wanted.size() > 1 ? 1 : 0;
    if (!wanted.empty()) CHECK(*ray_by(map, wanted.front(), st) == *ray(map, st));
    for (const std::uint32_t triangle : wanted) {
      const auto own = ray_by(map, triangle, st);
      REQUIRE(own);
      CHECK(glm::length(*image_point(map, *own) - st) < 1e-9);
    }
  }
  CHECK(several > 300);
}

TEST_CASE("grids that lie on one line or one point show nothing, and the largest are built") {
  model::CameraTexture texture = grid_of(2, 1);
  texture.offsets = {{{0, -1}, {0, -1}, {0, -1}}, {{0, 1}, {0, 1}, {0, 1}}};
  CHECK_FALSE(ray(make_map(projection_of(texture), 1.0), {0.3, 0}));
  texture.offsets = {{{1, -1}, {0, -1}, {-1, -1}}, {{1, 1}, {0, 1}, {-1, 1}}};
  CHECK_FALSE(ray(make_map(projection_of(texture), 1.0), {0, 0}));
  const Map large = make_map(projection_of(swirled(512, 512)), aspect);
  CHECK(grid(large).triangle_count() == 2 * 512 * 512);
  CHECK(ray(large, {0.123, 0.456}));
  std::vector<Map> copies(2, large); // they share the grid
  CHECK(&grid(copies.back()) == &grid(large));
}
