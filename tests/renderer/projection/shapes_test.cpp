// Hand-worked values of each shape.
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <numbers>

#include "renderer/projection/map.h"

using namespace cupola;
using namespace cupola::projection;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;

Map map_of(const model::Shape& shape, double aspect, double pitch = 0.0, double zoom = 1.0,
           glm::dvec3 off_axis = {}) {
  model::Projection p;
  p.shape = shape;
  p.zoom = zoom;
  p.off_axis = off_axis;
  p.orientation.pitch.degrees = pitch;
  return make_map(p, aspect);
}

void check_shows(const Map& map, glm::dvec2 st, glm::dvec3 direction) {
  CAPTURE(st.x);
  CAPTURE(st.y);
  const auto found = ray(map, st);
  REQUIRE(found);
  CHECK(glm::length(glm::normalize(*found) - glm::normalize(direction)) < 1e-12);
  const auto back = image_point(map, direction);
  REQUIRE(back);
  CHECK(glm::length(*back - st) < 1e-12);
}

} // namespace

TEST_CASE("perspective: 90 degrees across reach 45 to each side, square pixels without a vertical field") {
  const Map map = map_of(model::Perspective{{90}, {}}, 2.0);
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {1, 0}, {1, 0, -1});
  check_shows(map, {0, 1}, {0, 0.5, -1});
  check_shows(map, {-3, 4}, {-3, 2, -1}); // outside the picture the map goes on
  CHECK(ray(map, {1, 1})->z == -1.0);     // the weight
  CHECK_FALSE(image_point(map, {0, 0, 1}));
  CHECK_FALSE(image_point(map, {1, 0, 0}));
  check_shows(map_of(model::Perspective{{90}, model::Angle{90}}, 2.0), {0, 1}, {0, 1, -1});
  check_shows(map_of(model::Perspective{{90}, {}}, 1.0, 0, 2.0), {1, 1}, {0.5, 0.5, -1}); // zoom 2: half
}

TEST_CASE("perspective: off-axis is an asymmetric frustum, whatever the heading") {
  // A wall with left 59.2, right 49.15, up and down 26.28621031746032 degrees: at distance 1 the frustum
  // reaches from -1.6775 to 1.1564 and to ±0.49397.
  const double left = std::tan(59.2 * degree), right = std::tan(49.15 * degree);
  CHECK(left == doctest::Approx(1.6775).epsilon(1e-4));
  CHECK(right == doctest::Approx(1.1564).epsilon(1e-4));
  model::Projection p;
  p.shape =
      model::Perspective{{2 * std::atan((left + right) / 2) / degree}, model::Angle{2 * 26.28621031746032}};
  p.off_axis = {(left - right) / 2, 0, 0};
  for (const double yaw : {0.0, 270.0}) {
    p.orientation.yaw.degrees = yaw;
    const Map map = make_map(p, 2772.0 / 1345);
    const glm::dmat3 turn = rotation(p.orientation);
    check_shows(map, {-1, 0}, turn * glm::dvec3(-left, 0, -1));
    check_shows(map, {1, 0}, turn * glm::dvec3(right, 0, -1));
    CHECK(std::abs((ray(map, {0, 1}))->y) == doctest::Approx(0.49397).epsilon(1e-4));
    CHECK(std::abs((ray(map, {0, -1}))->y) == doctest::Approx(0.49397).epsilon(1e-4));
  }
}

TEST_CASE("cylinder: a full turn") {
  const Map map = map_of(model::Cylinder{{360}, {90}}, 4.0 / 3);
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {0.5, 0}, {1, 0, 0});
  check_shows(map, {-0.5, 0}, {-1, 0, 0});
  check_shows(map, {0, 1}, {0, 1, -1});
  check_shows(map, {-0.25, -1}, {-1, -std::sqrt(2.0), -1});
  const auto seam = ray(map, {1, 0}), other = ray(map, {-1, 0});
  REQUIRE(seam);
  REQUIRE(other);
  CHECK(glm::length(*seam - glm::dvec3(0, 0, 1)) < 1e-15);
  CHECK(glm::length(*seam - *other) < 1e-15);
  CHECK(std::abs(image_point(map, {0, 0, 1})->x) == 1.0);
  CHECK_FALSE(ray(map, {1.001, 0}));
  CHECK_FALSE(image_point(map, {0, 1, 0}));
  CHECK_FALSE(image_point(map, {0, -1, 0}));
  CHECK(std::hypot(ray(map, {0.3, 0.9})->x, ray(map, {0.3, 0.9})->z) == doctest::Approx(1.0)); // the weight
}

TEST_CASE("cylinder: zoom below 1 shows more, to a full turn and no further") {
  const Map map = map_of(model::Cylinder{{180}, {90}}, 1.0, 0.0, 0.25);
  check_shows(map, {0.25, 0.25}, {1, 1, 0});
  CHECK(ray(map, {0.5, 0}));
  CHECK_FALSE(ray(map, {0.501, 0}));
  CHECK(ray(map, {0, 1})->y == doctest::Approx(4.0)); // vertically: four times the tangent
}

TEST_CASE("cylinder: off-axis, the wall seen from elsewhere") {
  const Map map = map_of(model::Cylinder{{360}, {90}}, 1.0, 0.0, 1.0, {0.5, 0.25, 0});
  check_shows(map, {0.5, 0}, {0.5, -0.25, 0});   // the wall at +x is 0.5 away, the horizon 0.25 lower
  check_shows(map, {-0.5, 0}, {-1.5, -0.25, 0}); // at -x 1.5
  check_shows(map, {0, 1}, {-0.5, 0.75, -1});
}

TEST_CASE("fisheye: dome with the zenith in the centre, front at the bottom, right at the right") {
  const Map map = map_of(model::Fisheye{{180}}, 1600.0 / 1200, 90.0);
  check_shows(map, {0, 0}, {0, 1, 0});
  check_shows(map, {0, -1}, {0, 0, -1}); // north at the bottom
  check_shows(map, {0, 1}, {0, 0, 1});
  check_shows(map, {0.75, 0}, {1, 0, 0}); // the circle is 1200 of 1600 pixels wide
  check_shows(map, {-0.75, 0}, {-1, 0, 0});
  check_shows(map, {0, -0.5}, {0, 1, -1});
  CHECK_FALSE(ray(map, {0.7501, 0}));
  CHECK_FALSE(ray(map, {0.75, 0.75}));
  CHECK_FALSE(image_point(map, {0, -1, 0}));
}

TEST_CASE("fisheye: a tall viewport has the circle across its width") {
  const Map map = map_of(model::Fisheye{{180}}, 0.5);
  check_shows(map, {1, 0}, {1, 0, 0});
  check_shows(map, {0, 0.5}, {0, 1, 0});
  CHECK_FALSE(ray(map, {0, 0.501}));
}

TEST_CASE("fisheye: tilted back by 27 degrees from the zenith, the zenith stands at 27/90 of the radius") {
  check_shows(map_of(model::Fisheye{{180}}, 1.0, 90 - 27), {0, 0.30}, {0, 1, 0});
  check_shows(map_of(model::Fisheye{{180}}, 1.0, 0), {0, 1}, {0, 1, 0}); // level: on the rim
}

TEST_CASE("fisheye: a full sphere ends behind") {
  const Map map = map_of(model::Fisheye{{360}}, 1.0);
  check_shows(map, {0.5, 0}, {1, 0, 0});
  check_shows(map, {0, -0.75}, {0, -1, 1});
  for (const double a : {0.0, 1.0, 4.0}) {
    const auto behind = ray(map, {std::cos(a), std::sin(a)});
    REQUIRE(behind);
    CHECK(glm::length(*behind - glm::dvec3(0, 0, 1)) < 1e-12);
  }
  const auto st = image_point(map, {0, 0, 1});
  REQUIRE(st);
  CHECK(glm::length(*st) == doctest::Approx(1.0));
}

TEST_CASE("fisheye: the circle stays inscribed under zoom, the angle at its rim changes") {
  check_shows(map_of(model::Fisheye{{180}}, 1.0, 0, 2.0), {1, 0}, {1, 0, -1}); // 45 degrees at the rim
  CHECK_FALSE(ray(map_of(model::Fisheye{{180}}, 1.0, 0, 2.0), {1.001, 0}));
  const Map wide = map_of(model::Fisheye{{180}}, 1.0, 0, 0.25); // half a turn is reached at half the radius
  check_shows(wide, {0.25, 0}, {1, 0, 0});
  CHECK(ray(wide, {0.499, 0}));
  CHECK_FALSE(ray(wide, {0.501, 0}));
}

TEST_CASE("fisheye: off-axis, the dome seen from elsewhere") {
  const Map map = map_of(model::Fisheye{{180}}, 1.0, 0, 1.0, {0.8, 0, 0});
  check_shows(map, {1, 0}, {0.2, 0, 0});
  check_shows(map, {-1, 0}, {-1.8, 0, 0});
  check_shows(map, {0, 0}, {-0.8, 0, -1});
  CHECK_FALSE(image_point(map, {0, 0, 1})); // that wall lies beyond the circle
}

TEST_CASE("equirectangular: longitude across, latitude upwards") {
  const Map map = map_of(model::Equirectangular{{360}, {180}}, 2.0);
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {0.5, 0}, {1, 0, 0});
  check_shows(map, {0, 0.5}, {0, 1, -1});
  check_shows(map, {-0.25, -0.5}, {-1, -std::sqrt(2.0), -1});
  check_shows(map, {0, 1}, {0, 1, 0}); // of a pole, the middle
  CHECK(glm::length(*ray(map, {0.77, 1}) - glm::dvec3(0, 1, 0)) < 1e-15);
  CHECK_FALSE(ray(map, {0, 1.001}));
  CHECK_FALSE(ray(map, {-1.001, 0}));
  CHECK(std::abs(image_point(map, {0, 0, 1})->x) == 1.0);
  check_shows(map_of(model::Equirectangular{{90}, {60}}, 2.0), {1, 0}, {1, 0, -1});
}

TEST_CASE("beyond what is shown the map goes on to where it ends by nature") {
  const auto goes_on = [](const Map& map, glm::dvec2 st, glm::dvec3 direction) {
    CAPTURE(st.x);
    CAPTURE(st.y);
    CHECK_FALSE(ray(map, st));
    const auto found = beyond(map, st, {0, 0});
    REQUIRE(found);
    CHECK(glm::length(glm::normalize(*found) - glm::normalize(direction)) < 1e-12);
  };
  const Map dome = map_of(model::Fisheye{{180}}, 1.0);
  goes_on(dome, {1.5, 0}, {1, 0, 1});
  goes_on(dome, {0, -1.25}, {0, -1, std::tan(22.5 * degree)});
  CHECK(beyond(dome, {1.999, 0}, {0, 0}));
  CHECK_FALSE(beyond(dome, {2.001, 0}, {0, 0})); // over the point behind
  CHECK_FALSE(beyond(dome, {1.5, 1.5}, {0, 0}));
  const Map wall = map_of(model::Cylinder{{360}, {90}}, 1.0);
  goes_on(wall, {1.25, 1}, {-1, std::sqrt(2.0), 1});
  goes_on(wall, {-1.5, 0}, {1, 0, 0});
  const Map globe = map_of(model::Equirectangular{{360}, {180}}, 2.0);
  goes_on(globe, {1.25, 0}, {-1, 0, 1});
  CHECK_FALSE(beyond(globe, {0, 1.001}, {0, 0}));                               // over a pole
  goes_on(map_of(model::Equirectangular{{360}, {90}}, 2.0, 0, 0.5), {0.6, 0.5}, // 0.5 · 2 of 45 degrees
          {std::sin(216 * degree) * std::cos(45 * degree), std::sin(45 * degree),
           -std::cos(216 * degree) * std::cos(45 * degree)});
  CHECK_FALSE(beyond(dome, {std::nan(""), 0}, {0, 0}));
  goes_on(map_of(model::Stereographic{{180}}, 1.0), {3, 0},
          {3.0 / 5, 0, 4.0 / 5}); // tan of half the angle: 3
  goes_on(map_of(model::Orthographic{{60}}, 1.0), {0, 1.5}, {0, 0.75, -std::sqrt(1 - 0.75 * 0.75)});
  CHECK_FALSE(beyond(map_of(model::Orthographic{{60}}, 1.0), {0, 2.001}, {0, 0})); // 90 degrees
  goes_on(map_of(model::Mercator{{360}, {90}}, 1.0), {1.5, 0}, {-1, 0, 0});
}

TEST_CASE("stereographic: the tangent of half the angle grows with the radius") {
  const Map map = map_of(model::Stereographic{{180}}, 1.0);
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {1, 0}, {1, 0, 0});
  check_shows(map, {0, -std::tan(22.5 * degree)}, {0, -1, -1});
  CHECK_FALSE(ray(map, {0.8, 0.8}));
  CHECK_FALSE(image_point(map, {0, 0, 1}));
  CHECK_FALSE(image_point(map, {1, 0, 0.01}));
  const Map wide = map_of(model::Stereographic{{270}}, 2.0); // the circle across half the width
  check_shows(wide, {0.5, 0}, {1, 0, 1});
  check_shows(wide, {0, 1}, {0, 1, 1});
  check_shows(map_of(model::Stereographic{{180}}, 1.0, 0, 2.0), {1, 0}, {4.0 / 5, 0, -3.0 / 5});
  check_shows(map_of(model::Stereographic{{180}}, 1.0, 0, 1.0, {0.8, 0, 0}), {1, 0}, {0.2, 0, 0});
  CHECK(pixel_density(map, {0, 0}, {1000, 1000}) == doctest::Approx(250).epsilon(1e-5));
  CHECK(pixel_density(map, {1, 0}, {1000, 1000}) == doctest::Approx(500).epsilon(1e-5)); // twice at the rim
  CHECK(matched_density(map, {1000, 1000}) == doctest::Approx(250 * 1.25)); // 1 + tan² at half the radius
}

TEST_CASE("orthographic: the sine of the angle grows with the radius, to a right angle") {
  const Map map = map_of(model::Orthographic{{180}}, 1.0);
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {0.5, 0}, {0.5, 0, -std::sqrt(0.75)});
  check_shows(map, {0, -0.8}, {0, -0.8, -0.6});
  CHECK(ray(map, {1, 0})->z == 0.0);
  CHECK_FALSE(image_point(map, {0, 0, 1}));
  CHECK_FALSE(image_point(map, {0.1, 0, 1})); // not the same as ahead
  CHECK_FALSE(ray(map_of(model::Orthographic{{180}}, 1.0, 0, 0.5), {0.501, 0}));
  check_shows(map_of(model::Orthographic{{60}}, 0.5), {1, 0}, {0.5, 0, -std::sqrt(0.75)});
  check_shows(map_of(model::Orthographic{{60}}, 0.5), {0, 0.5}, {0, 0.5, -std::sqrt(0.75)});
  check_shows(map_of(model::Orthographic{{180}}, 1.0, 0, 1.0, {0, 0, 0.5}), {0.6, 0}, {0.6, 0, -1.3});
  CHECK(pixel_density(map, {0, 0}, {1000, 1000}) == doctest::Approx(500).epsilon(1e-5));
  CHECK(matched_density(map, {1000, 1000}) == doctest::Approx(500));
}

TEST_CASE("mercator: conformal, the poles far away") {
  const Map map = map_of(model::Mercator{{360}, {90}}, 1.0);
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {0.5, 0}, {1, 0, 0});
  check_shows(map, {0, 1}, {0, 1, -1});
  check_shows(map, {-0.25, -1}, {-1, -std::sqrt(2.0), -1});
  CHECK_FALSE(ray(map, {1.001, 0}));
  CHECK_FALSE(image_point(map, {0, 1, 0}));
  check_shows(map, {0, std::asinh(std::tan(80 * degree)) / std::asinh(1.0)},
              {0, std::sin(80 * degree), -std::cos(80 * degree)}); // outside the picture it goes on
  check_shows(map_of(model::Mercator{{360}, {90}}, 1.0, 0, 1.0, {0.5, 0, 0}), {0.5, 0}, {0.5, 0, 0});
  // Square pixels anywhere: 2π across, 2 asinh(1) upwards.
  const glm::dvec2 size(1000, 1000 * std::asinh(1.0) / pi);
  const double equator = 1000 / (2 * pi);
  CHECK(pixel_density(map, {0, 0}, size) == doctest::Approx(equator).epsilon(1e-5));
  CHECK(pixel_density(map, {0.3, 1}, size) == doctest::Approx(equator * std::sqrt(2.0)).epsilon(1e-5));
  CHECK(matched_density(map, size) == doctest::Approx(equator));
}

TEST_CASE("panini: from a perspective to the picture of a wall") {
  const Map flat = map_of(model::Panini{{90}, {}, 0.0}, 2.0);
  check_shows(flat, {1, 1}, {1, 0.5, -1});
  CHECK(glm::length(*ray(flat, {0.3, -0.7}) - glm::dvec3(0.3, -0.35, -1)) < 1e-15); // the weight too
  const Map map = map_of(model::Panini{{180}, model::Angle{90}, 1.0}, 1.0);         // x = 2 tan(azimuth / 2)
  check_shows(map, {0, 0}, {0, 0, -1});
  check_shows(map, {1, 0}, {1, 0, 0});
  check_shows(map, {0, 1}, {0, 1, -1});
  check_shows(map, {std::tan(22.5 * degree), 0}, {1, 0, -1});
  check_shows(map, {1, 1}, {2, 1, 0}); // S = 2 at 90 degrees: the wall's height is halved
  CHECK_FALSE(image_point(map, {0, 0, 1}));
  CHECK_FALSE(image_point(map, {0, 1, 0}));
  check_shows(map, {-std::tan(85 * degree), 0}, {-std::sin(170 * degree), 0, -std::cos(170 * degree)});
  // The wall is then a parabola with the eye at its focus: at +x it is 2 away.
  check_shows(map_of(model::Panini{{180}, model::Angle{90}, 1.0}, 1.0, 0, 1.0, {0.5, 0.25, 0}), {1, 0},
              {1.5, -0.25, 0});
  const Map far = map_of(model::Panini{{150}, model::Angle{90}, 4.0}, 1.0);
  const double limit = panini_limit(4.0); // about 104.5 degrees
  check_shows(far, {panini_x(1.5, 4.0) / panini_x(75 * degree, 4.0), 0}, {std::sin(1.5), 0, -std::cos(1.5)});
  CHECK_FALSE(image_point(far, {std::sin(limit + 0.01), 0, -std::cos(limit + 0.01)}));
  CHECK(image_point(far, {std::sin(limit - 0.01), 0, -std::cos(limit - 0.01)}));
  CHECK_FALSE(ray(far, {panini_x(limit, 4.0) / panini_x(75 * degree, 4.0) + 1e-3, 0}));
  CHECK(matched_density(map, {1000, 500}) ==
        doctest::Approx(1000 / 4.0 * 1.25)); // 1 + tan² of half the angle
  CHECK(matched_density(map_of(model::Panini{{90}, {}, 0.0}, 2.0), {1000, 500}) ==
        doctest::Approx(500 * 1.25)); // 1 / cos² where the tangent is 1/2
}

TEST_CASE("cube cross: six faces that meet, nothing beside them") {
  const Map map = map_of(model::CubeCross{}, 4.0 / 3);
  const double third = 1.0 / 3;
  check_shows(map, {-0.25, 0}, {0, 0, -1});
  check_shows(map, {0.25, 0}, {1, 0, 0});
  check_shows(map, {0.75, 0}, {0, 0, 1});
  check_shows(map, {-0.75, 0}, {-1, 0, 0});
  check_shows(map, {-0.25, 2 * third}, {0, 1, 0});
  check_shows(map, {-0.25, -2 * third}, {0, -1, 0});
  check_shows(map, {-0.25, third + 0.01}, {0, 1, -0.97}); // above front's top: the top near the front
  check_shows(map, {0.25, 0.2}, {1, 0.6, 0});
  check_shows(map, {-0.375, 2 * third}, {-0.5, 1, 0}); // left of the top is left
  check_shows(map, {-0.25, -1 + 0.01}, {0, -1, 0.97});
  for (const glm::dvec2 beside : {glm::dvec2(0.25, 0.5), {-0.75, 0.5}, {0.75, -0.5}, {-0.6, -0.9}}) {
    CHECK_FALSE(ray(map, beside));
    CHECK(pixel_density(map, beside, {400, 300}) == 0.0);
  }
  CHECK_FALSE(ray(map_of(model::CubeCross{}, 4.0 / 3, 0, 0.5), {0.51, 0})); // zoomed out
  check_shows(map_of(model::CubeCross{}, 4.0 / 3, 0, 1.0, {0.5, 0, 0}), {0.25, 0}, {0.5, 0, 0});
  CHECK(pixel_density(map, {-0.25, 0}, {400, 300}) == doctest::Approx(50).epsilon(1e-5));
  CHECK(matched_density(map, {400, 300}) == doctest::Approx(50));
}

TEST_CASE("cube cross: the map breaks between faces, and each goes on over its neighbours") {
  const Map map = map_of(model::CubeCross{}, 4.0 / 3);
  CHECK(breaks(map).s == std::vector<double>{-0.5, 0.0, 0.5});
  CHECK(breaks(map).t == std::vector<double>{-1.0 / 3, 1.0 / 3});
  CHECK(breaks(map_of(model::CubeCross{}, 4.0 / 3, 0, 2.0)).s == std::vector<double>{0.0});
  CHECK(breaks(map_of(model::Fisheye{}, 1.0)).s.empty());
  const auto front = beyond(map, {0.25, 0}, {-0.25, 0}), right = beyond(map, {0.25, 0}, {0.25, 0});
  REQUIRE(front);
  REQUIRE(right);
  CHECK(glm::length(*front - glm::dvec3(2, 0, -1)) < 1e-12);
  CHECK(glm::length(*right - glm::dvec3(1, 0, 0)) < 1e-12);
  const glm::dvec2 border(0.0, 0.1); // both faces show it alike
  CHECK(glm::length(*beyond(map, border, {-0.25, 0}) - *beyond(map, border, {0.25, 0})) < 1e-12);
  CHECK_FALSE(beyond(map, {0, 0}, {0.75, 0.75}));
}

TEST_CASE("pixel density: hand-worked values") {
  const glm::dvec2 size(1600, 1200);
  const double aspect = 4.0 / 3;
  const auto density = [&](const Map& map, glm::dvec2 st) { return pixel_density(map, st, size); };
  const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-5); };
  const Map flat = map_of(model::Perspective{{90}, {}}, aspect);
  CHECK(density(flat, {0, 0}) == near(800));
  CHECK(density(flat, {1, 0}) == near(1600)); // 1 / cos² across
  const Map wall = map_of(model::Cylinder{{360}, {90}}, aspect);
  CHECK(density(wall, {0, 0}) == near(600));       // upwards; across only 1600 / 2π
  CHECK(density(wall, {0.7, 1}) == near(600 * 2)); // 1 / cos² 45°
  CHECK(density(wall, {-1, 0}) == near(600));      // one-sided at the seam
  const Map dome = map_of(model::Fisheye{{180}}, aspect, 90);
  CHECK(density(dome, {0, 0}) == near(600 / (pi / 2)));
  CHECK(density(dome, {0, -1}) == near(600)); // along the rim: 2π · 600 pixels for 2π
  CHECK(density(dome, {1, 0}) == 0.0);        // outside the circle
  const Map globe = map_of(model::Equirectangular{{360}, {180}}, 2.0);
  CHECK(pixel_density(globe, {0, 0}, {2000, 1000}) == near(1000 / pi));
  CHECK(pixel_density(globe, {0, 2.0 / 3}, {2000, 1000}) == near(2 * 1000 / pi)); // at 60° parallels are half
  CHECK(pixel_density(globe, {0, 1}, {2000, 1000}) > 1e6);                        // a pole
  CHECK(density(map_of(model::Perspective{{90}, {}}, aspect, 0, 3.0), {0, 0}) == near(2400)); // zoom
}

TEST_CASE("matched density: along the lines of equal steps") {
  const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-12); };
  const double tan67 = std::tan(67 * degree);
  CHECK(matched_density(map_of(model::Cylinder{{360}, {134}}, 4.0 / 3), {1600, 1200}) == near(600 / tan67));
  CHECK(matched_density(map_of(model::Fisheye{{180}}, 1.0), {2048, 2048}) == near(1024 / (pi / 2)));
  CHECK(matched_density(map_of(model::Fisheye{{180}}, 4.0 / 3, 90), {1600, 1200}) == near(600 / (pi / 2)));
  CHECK(matched_density(map_of(model::Perspective{{90}, {}}, 2.0), {1000, 500}) == near(500));
  CHECK(matched_density(map_of(model::Equirectangular{{360}, {180}}, 2.0), {2000, 1000}) == near(1000 / pi));
  // Zoom, and an eye that sees the far wall 1.6 away.
  CHECK(matched_density(map_of(model::Fisheye{{180}}, 1.0, 0, 2.0, {0, 0, 0.6}), {2048, 2048}) ==
        near(1024 / (pi / 2) * 2 * 1.6));
}
