#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "renderer/projection/map.h"

using namespace cupola;
using namespace cupola::projection;

namespace {

constexpr double pi = std::numbers::pi;

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

model::Orientation turned(double yaw, double pitch, double roll) { return {{yaw}, {pitch}, {roll}}; }

/// A projection anywhere in the ranges that a show file allows, with the eye inside its shape.
model::Projection random_projection(std::mt19937& random) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  model::Projection p;
  switch (random() % 9) {
  case 0: {
    model::Perspective shape{{number(0.1, 175)}, {}};
    if (random() % 2) shape.vertical_fov = model::Angle{number(0.1, 175)};
    p.shape = shape;
    break;
  }
  case 1:
    p.shape = model::Cylinder{{number(1, 360)}, {number(0.1, 170)}};
    break;
  case 2:
    p.shape = model::Fisheye{{number(1, 360)}};
    break;
  case 3:
    p.shape = model::Equirectangular{{number(1, 360)}, {number(1, 180)}};
    break;
  case 4:
    p.shape = model::Stereographic{{number(1, 350)}};
    break;
  case 5:
    p.shape = model::Orthographic{{number(1, 180)}};
    break;
  case 6:
    p.shape = model::Mercator{{number(1, 360)}, {number(1, 178)}};
    break;
  case 7: {
    const double distance = random() % 2 ? number(0, 1) : std::exp(number(0, 3));
    const double limit = panini_limit(distance) * 360 / pi - 1;
    p.shape = model::Panini{{number(0.1, limit)}, {}, distance};
    break;
  }
  default:
    p.shape = model::CubeCross{};
    break;
  }
  p.zoom = std::exp(number(std::log(0.05), std::log(100.0)));
  if (random() % 4) {
    do p.off_axis = {number(-0.95, 0.95), number(-0.95, 0.95), number(-0.95, 0.95)};
    while (glm::length(p.off_axis) > 0.95);
  }
  p.orientation = turned(number(-360, 360), number(-360, 360), number(-360, 360));
  return p;
}

} // namespace

TEST_CASE("orientation: yaw to the left, pitch upwards, roll clockwise, in this order") {
  const glm::dvec3 ahead(0, 0, -1), up(0, 1, 0), right(1, 0, 0);
  CHECK(rotation(turned(90, 0, 0)) * ahead == glm::dvec3(-1, 0, 0));
  CHECK(rotation(turned(0, 90, 0)) * ahead == glm::dvec3(0, 1, 0));
  CHECK(rotation(turned(0, 0, 90)) * up == glm::dvec3(1, 0, 0));
  CHECK(rotation(turned(0, 0, 90)) * ahead == ahead);
  CHECK(rotation(turned(90, 90, 0)) * ahead == glm::dvec3(0, 1, 0));
  CHECK(rotation(turned(90, 90, 0)) * right == glm::dvec3(0, 0, -1));
  CHECK(rotation(turned(360, -360, 360)) * ahead == ahead);
  const glm::dmat3 r = rotation(turned(33, -71, 205));
  CHECK(glm::determinant(r) == doctest::Approx(1.0).epsilon(1e-14));
  const glm::dvec3 look = r * ahead; // yaw 33 left, pitch 71 down
  CHECK(look.y == doctest::Approx(std::sin(-71 * pi / 180)));
  CHECK(std::atan2(-look.x, -look.z) == doctest::Approx(33 * pi / 180));
}

TEST_CASE("ray, image point and ray again: random projections and points") {
  std::mt19937 random(7);
  int shown = 0;
  for (int i = 0; i < 20'000; ++i) {
    const model::Projection projection = random_projection(random);
    const Map map = make_map(projection, std::exp(std::uniform_real_distribution<>(-2, 2)(random)));
    const glm::dvec2 st(std::uniform_real_distribution<>(-1, 1)(random),
                        std::uniform_real_distribution<>(-1, 1)(random));
    const auto direction = ray(map, st);
    if (!direction) continue;
    ++shown;
    const auto same = beyond(map, st, st);
    REQUIRE(same);
    CHECK(*same == *direction);
    const auto back = image_point(map, *direction);
    REQUIRE(back);
    const auto again = ray(map, *back);
    REQUIRE(again);
    // Off-axis to 0.95 magnifies angles up to 1 / 0.05; these two crowd directions towards their end.
    const bool crowds =
        std::holds_alternative<OrthographicMap>(map.shape) || std::holds_alternative<PaniniMap>(map.shape);
    CHECK(angle(*direction, *again) < (crowds ? 1e-6 : 1e-9));
    // Image coordinates are as good, except where a rim or pole crowds them.
    if (!std::holds_alternative<EquirectangularMap>(map.shape) &&
        !std::holds_alternative<MercatorMap>(map.shape))
      CHECK(glm::length(*back - st) < 1e-6);
  }
  CHECK(shown > 10'000);
}

TEST_CASE("image point, ray and image point again: random directions") {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  int found = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Map map = make_map(random_projection(random), 4.0 / 3);
    const glm::dvec3 direction(normal(random), normal(random), normal(random));
    const auto st = image_point(map, direction);
    if (!st) continue;
    ++found;
    const auto back = ray(map, *st);
    // A seam at half a turn may lie a rounding beyond it.
    const bool crowds =
        std::holds_alternative<OrthographicMap>(map.shape) || std::holds_alternative<PaniniMap>(map.shape);
    if (back) CHECK(angle(direction, *back) < (crowds ? 1e-6 : 1e-9));
    if (!back) CHECK(ray(map, *st * (1.0 - 1e-12)));
  }
  CHECK(found > 5'000);
}

TEST_CASE("nonsense in, nothing out") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const model::Shape& shape :
       {model::Shape(model::Perspective{}), model::Shape(model::Cylinder{}), model::Shape(model::Fisheye{}),
        model::Shape(model::Equirectangular{}), model::Shape(model::Stereographic{}),
        model::Shape(model::Orthographic{}), model::Shape(model::Mercator{}), model::Shape(model::Panini{}),
        model::Shape(model::CubeCross{}), model::Shape(model::CameraTexture{})}) {
    model::Projection projection;
    projection.shape = shape;
    const Map map = make_map(projection, 1.5);
    CHECK_FALSE(image_point(map, {0, 0, 0}));
    for (const double bad : {nan, inf, -inf}) {
      CHECK_FALSE(ray(map, {bad, 0}));
      CHECK_FALSE(ray(map, {0, bad}));
      CHECK(pixel_density(map, {bad, 0}, {100, 100}) == 0.0);
      CHECK_FALSE(image_point(map, {bad, 0, -1}));
      CHECK_FALSE(image_point(map, {0, bad, -1}));
      CHECK_FALSE(image_point(map, {0, 0, bad}));
    }
    for (const double scale : {1e-308, 1e-200, 1e200, 1e308}) { // a direction has no size
      const auto st = image_point(map, glm::dvec3(0.3, 0.2, -0.9) * scale);
      REQUIRE(st);
      CHECK(glm::length(*st - *image_point(map, {0.3, 0.2, -0.9})) < 1e-9);
    }
  }
}

TEST_CASE("extreme parameters never give NaN") {
  std::mt19937 random(9);
  const auto pick = [&](std::initializer_list<double> values) {
    return *(values.begin() + random() % values.size());
  };
  for (int i = 0; i < 20'000; ++i) {
    model::Projection p;
    switch (random() % 9) {
    case 0:
      p.shape = model::Perspective{{pick({0.1, 90, 175})}, model::Angle{pick({0.1, 175})}};
      break;
    case 1:
      p.shape = model::Cylinder{{pick({1, 180, 360})}, {pick({0.1, 170})}};
      break;
    case 2:
      p.shape = model::Fisheye{{pick({1, 180, 360})}};
      break;
    case 3:
      p.shape = model::Equirectangular{{pick({1, 360})}, {pick({1, 180})}};
      break;
    case 4:
      p.shape = model::Stereographic{{pick({1, 180, 350})}};
      break;
    case 5:
      p.shape = model::Orthographic{{pick({1, 90, 180})}};
      break;
    case 6:
      p.shape = model::Mercator{{pick({1, 360})}, {pick({1, 178})}};
      break;
    case 7:
      p.shape = model::Panini{{pick({0.1, 170})}, model::Angle{pick({0.1, 175})}, pick({0, 1, 100})};
      break;
    default:
      p.shape = model::CubeCross{};
      break;
    }
    p.zoom = pick({0.05, 0.5, 1, 100});
    p.off_axis = {pick({-0.95, 0, 0.95}), pick({-0.95, 0, 0.95}), pick({-0.95, 0, 0.95})}; // also outside
    p.orientation = turned(pick({0, 90, 360}), pick({0, 90, -90}), pick({0, 180}));
    const Map map = make_map(p, pick({1e-4, 0.5, 1, 16384}));
    const glm::dvec2 st(pick({-1, 0, 1, 1e300, -1e9}), pick({-1, 0, 1, 1e300, 1e9}));
    if (const auto d = ray(map, st)) {
      REQUIRE(std::isfinite(d->x + d->y + d->z));
      if (const auto back = image_point(map, *d)) REQUIRE(std::isfinite(back->x + back->y));
    }
    REQUIRE_FALSE(std::isnan(pixel_density(map, {st.x > 1 ? 1 : st.x, 0}, {1600, 1200})));
    const glm::dvec3 direction(pick({-1, 0, 1e-320, 1}), pick({-1, -0.0, 1}), pick({-1, 0, 1e-320, 1}));
    if (const auto point = image_point(map, direction)) REQUIRE(std::isfinite(point->x + point->y));
    const MapUniforms u = uniforms(map);
    REQUIRE(std::isfinite(u.parameters.x + u.parameters.y + u.parameters.z + u.zoom));
  }
}

TEST_CASE("the sampling vector: V = C (δ(F s) - O) with zoom 1 / s") {
  model::Projection p;
  p.shape = model::Cylinder{{180}, {90}};
  p.zoom = 2;
  p.off_axis = {0.25, -0.5, 0.125};
  p.orientation = turned(90, 0, 0);
  // δ at s = 1/2 of ±90°: azimuth 45°, height 1/2 tan 45°. C turns x to -z and z to x.
  const glm::dvec3 shape(std::sqrt(0.5) - 0.25, 0.5 + 0.5, -std::sqrt(0.5) - 0.125);
  const auto v = ray(make_map(p, 1), {1, 1});
  REQUIRE(v);
  CHECK(glm::length(*v - glm::dvec3(shape.z, shape.y, -shape.x)) < 1e-15);
}

TEST_CASE("the eye must stay inside") {
  model::Projection p;
  p.off_axis = {0.95, 0.95, -0.95};
  for (const auto& [shape, expected] : {std::pair{model::Shape(model::Perspective{}), true},
                                        {model::Shape(model::Cylinder{}), false},
                                        {model::Shape(model::Fisheye{}), false},
                                        {model::Shape(model::Equirectangular{}), false}}) {
    p.shape = shape;
    CHECK(inside(make_map(p, 1)) == expected);
  }
  p.off_axis = {0, 5, 0}; // along the axis a cylinder has no end
  p.shape = model::Cylinder{};
  CHECK(inside(make_map(p, 1)));
}

TEST_CASE("uniforms carry the shape's numbers") {
  model::Projection p;
  p.shape = model::Fisheye{{220}};
  p.zoom = 1.5;
  p.off_axis = {0.1, 0.2, 0.3};
  p.orientation = turned(90, 0, 0);
  const MapUniforms u = uniforms(make_map(p, 2));
  CHECK(u.shape == 2);
  CHECK(u.parameters.x == doctest::Approx(110 * pi / 180));
  CHECK(u.parameters.y == 2.0f);
  CHECK(u.parameters.z == 1.0f);
  CHECK(u.zoom == 1.5f);
  CHECK(u.off_axis == glm::vec3(0.1f, 0.2f, 0.3f));
  CHECK(u.orientation * glm::vec3(0, 0, -1) == glm::vec3(-1, 0, 0));
}
