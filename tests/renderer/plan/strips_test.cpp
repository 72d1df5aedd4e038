#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <random>

#include "renderer/plan/plan.h"

using namespace cupola;
using namespace cupola::plan;

namespace {

constexpr double pi = std::numbers::pi;

projection::Map wall(double horizontal, double vertical, double zoom = 1.0, glm::dvec3 off_axis = {},
                     model::Orientation orientation = {}) {
  model::Projection p;
  p.shape = model::Cylinder{{horizontal}, {vertical}};
  p.zoom = zoom;
  p.off_axis = off_axis;
  p.orientation = orientation;
  return projection::make_map(p, 1.0);
}

/// Image coordinates of a place in pixels of the rect, y downwards.
glm::dvec2 image(const PixelRect& rect, double x, double y) {
  return {-1.0 + 2.0 * (x - rect.x) / rect.width, 1.0 - 2.0 * (y - rect.y) / rect.height};
}

/// What is measured by brute force, with nothing but the true map and the matrices.
struct Measured {
  double largest = 0.0, rms = 0.0, least_w = 1e300;
  long shown = 0, hidden_in_bounds = 0, outside_planes = 0;
};

Measured measure(const PieceSet& set, const projection::Map& map, const PixelRect& rect, int row_step = 1) {
  Measured out;
  double sum = 0.0;
  for (const Piece& piece : set.pieces)
    for (int x = piece.bounds.x; x < piece.bounds.x + piece.bounds.width; ++x)
      for (int y = piece.bounds.y; y < piece.bounds.y + piece.bounds.height; y += row_step) {
        const glm::dvec2 st = image(rect, x + 0.5, y + 0.5);
        const auto v = projection::ray(map, st);
        if (!v) {
          ++out.hidden_in_bounds;
          continue;
        }
        ++out.shown;
        const glm::dvec3 h = piece.to_screen * *v;
        const double error =
            std::hypot((h.x / h.z - st.x) * 0.5 * rect.width, (h.y / h.z - st.y) * 0.5 * rect.height);
        out.largest = std::max(out.largest, error);
        sum += error * error;
        out.least_w = std::min(out.least_w, h.z);
        for (int i = 0; i < piece.plane_count; ++i)
          if (glm::dot(piece.planes[static_cast<std::size_t>(i)], *v) < 0.0) ++out.outside_planes;
      }
  out.rms = std::sqrt(sum / double(out.shown));
  return out;
}

/// Neighbours agree along their border, and both are exact there in x and w. Returns the largest deviation.
double border_deviation(const PieceSet& set, const projection::Map& map, const PixelRect& rect) {
  double worst = 0.0;
  for (std::size_t i = 0; i + 1 < set.pieces.size(); ++i) {
    const Piece &left = set.pieces[i], &right = set.pieces[i + 1];
    const int column = right.bounds.x;
    for (const double y : {0.0, 0.21, 0.5, 0.77, 1.0}) {
      const glm::dvec2 st = image(rect, column, rect.y + y * rect.height);
      const auto v = projection::ray(map, st);
      REQUIRE(v);
      const glm::dvec3 a = left.to_screen * *v, b = right.to_screen * *v;
      worst = std::max({worst, glm::length(a - b), std::abs(a.x - st.x), std::abs(a.z - 1.0)});
      CHECK(std::abs(a.y - st.y) * 0.5 * rect.height <=
            set.max_error * 1.05 + 1e-9); // the balance, at the very edge
    }
    CHECK(left.planes[1] == -right.planes[0]); // the same bits: no gap and no overlap
  }
  return worst;
}

/// Bounds stand side by side over the full height, from the first column to the last.
void check_tiling(const PieceSet& set, const PixelRect& rect) {
  int column = rect.x;
  for (const Piece& piece : set.pieces) {
    CHECK(piece.bounds.x == column);
    CHECK(piece.bounds.width >= 1);
    CHECK(piece.bounds.y == rect.y);
    CHECK(piece.bounds.height == rect.height);
    column += piece.bounds.width;
  }
  CHECK(column == rect.x + rect.width);
}

} // namespace

TEST_CASE("errors of strips grow with the square of their width, whatever the vertical field") {
  // With heights exact at the borders, as in the paper's figures, strips of 10 pixels are wrong by 0.116 and
  // of 20 by 0.46; balanced between border and middle it is half of that.
  const PixelRect rect{0, 0, 1600, 1200};
  const auto expect = [&](double vertical, double max_error, std::size_t strips, double error) {
    const auto set = make_strips(wall(360, vertical), rect, max_error);
    REQUIRE(set);
    CHECK(set->pieces.size() == strips);
    CHECK(set->max_error == doctest::Approx(error).epsilon(0.02));
  };
  for (const double vertical : {10.0, 60.0, 134.0, 170.0}) {
    expect(vertical, 0.0585, 160, 0.116 / 2);
    expect(vertical, 0.25, 100, 0.116 / 2 * 1.6 * 1.6); // whole blocks of 16 pixels
    expect(vertical, 0.6, 50, 0.46 / 2 * 1.6 * 1.6);
  }
}

TEST_CASE("the error that is told is the error that is there, and within the limit") {
  std::mt19937 random(3);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i) {
    glm::dvec3 eye(0.0);
    if (i % 3) eye = {number(-0.6, 0.6), number(-0.6, 0.6), number(-0.6, 0.6)};
    const auto map = wall(number(1, 360), number(1, 170), std::exp(number(-0.5, 2)), eye,
                          {{number(-180, 180)}, {number(-90, 90)}, {number(-180, 180)}});
    const PixelRect rect{17, 5, 64 + int(random() % 700), 64 + int(random() % 300)};
    const double limit = std::exp(number(-3, 1));
    const auto set = make_strips(map, rect, limit);
    REQUIRE(set);
    CAPTURE(i);
    const Measured found = measure(*set, map, rect);
    const bool finest = std::any_of(set->pieces.begin(), set->pieces.end(),
                                    [](const Piece& p) { return p.bounds.width == 1; });
    if (!finest) CHECK(found.largest <= limit);
    CHECK(found.largest == doctest::Approx(set->max_error).epsilon(1e-6));
    CHECK(found.rms == doctest::Approx(set->rms_error).epsilon(1e-6));
    CHECK(found.least_w > 0.0);
    CHECK(found.outside_planes == 0);
    CHECK(found.hidden_in_bounds == 0);
    CHECK(border_deviation(*set, map, rect) < 1e-12 * 600);
    CHECK(set->strips);
  }
}

TEST_CASE("neighbours agree along their border to 1e-12, and the viewport is covered once") {
  for (const auto& [horizontal, off_axis] : {std::pair{360.0, glm::dvec3(0)},
                                             {180.0, glm::dvec3(0)},
                                             {1.0, glm::dvec3(0)},
                                             {360.0, glm::dvec3(0.5, 0.2, -0.3)},
                                             {220.0, glm::dvec3(0, -0.9, 0)}}) {
    const auto map = wall(horizontal, 60, 1.0, off_axis);
    const PixelRect rect{100, 50, 1601, 777};
    const auto set = make_strips(map, rect, 0.25);
    REQUIRE(set);
    CHECK(border_deviation(*set, map, rect) < 1e-12);
    check_tiling(*set, rect);
  }
}

TEST_CASE("with the eye on the axis strips are equally wide, and as few as possible") {
  const auto map = wall(360, 134, 1.0, {0, 0.4, 0});
  const PixelRect rect{0, 0, 1600, 1200};
  const auto set = make_strips(map, rect, 0.25);
  REQUIRE(set);
  int narrowest = 1600, widest = 0;
  for (const Piece& piece : set->pieces) {
    narrowest = std::min(narrowest, piece.bounds.width);
    widest = std::max(widest, piece.bounds.width);
  }
  CHECK(widest - narrowest <= 16); // a block of the rasteriser; up to a pixel where strips are narrower
  // One strip fewer would make some strip wider; its error grows with the square of the width.
  CHECK(set->max_error * 32 * 32 / (widest * widest) > 0.25);
}

TEST_CASE("pictures of every width have strips: none is empty, none too wide") {
  constexpr double limit = 0.25;
  const projection::Map map = wall(360.0, 115.0);
  for (int width = 20; width <= 2000; ++width) {
    CAPTURE(width);
    const auto set = make_strips(map, {0, 0, width, width / 2}, limit);
    REQUIRE(set);
    CHECK(set->max_error <= limit);
    int end = 0;
    for (const Piece& piece : set->pieces) {
      CHECK(piece.bounds.x == end);
      CHECK(piece.bounds.width > 0);
      end += piece.bounds.width;
    }
    CHECK(end == width);
  }
}

TEST_CASE("off-axis: strips are narrow where the wall is near") {
  const auto set = make_strips(wall(360, 60, 1.0, {0, 0, -0.8}), {0, 0, 1600, 600}, 0.1);
  REQUIRE(set);
  // The middle of the picture is the wall ahead, 0.2 away from the eye; the ends are 1.8 away.
  const auto middle = std::find_if(set->pieces.begin(), set->pieces.end(), [](const Piece& p) {
    return p.bounds.x <= 800 && p.bounds.x + p.bounds.width > 800;
  });
  REQUIRE(middle != set->pieces.end());
  CHECK(middle->bounds.width != set->pieces.front().bounds.width);
}

TEST_CASE("the paper's matrices give the same picture") {
  // eq. 1: M = M_tx · M_sx · M_p · M_ry with n equal pieces of phi = phi_c / n. M_p: perspective of phi
  // across; vertically so that the border of the piece, where the depth is cos(phi / 2), is as high as the
  // cylinder.
  const double phi_c = 240.0 * pi / 180.0, tan_half_v = std::tan(35.0 * pi / 180.0);
  const PixelRect rect{0, 0, 1200, 800};
  const auto map = wall(240, 70);
  const auto set = make_strips(map, rect, 0.069);
  REQUIRE(set);
  const int n = int(set->pieces.size());
  REQUIRE(1200 % n == 0); // equal pieces as in the paper
  const double phi = phi_c / n;
  // The paper leaves the vertical scale of M_p free. Ours is larger by one k for all pieces: the error of
  // heights is then the same at the border and at the pixel column nearest to the middle.
  const double k = set->pieces[0].to_screen[1][1] * std::tan(35.0 * pi / 180.0);
  CHECK(k > 1.0);
  CHECK(k < 2.0 / (1.0 + std::cos(phi / 2)) + 1e-12);
  std::mt19937 random(5);
  for (int p = 0; p < n; ++p) {
    const double center = (p + 0.5) * phi - phi_c / 2;
    const double c = std::cos(center), s = std::sin(center);
    // Turns the direction (sin center, 0, -cos center) to (0, 0, -1). Columns.
    const glm::dmat4 m_ry(glm::dvec4(c, 0, -s, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(s, 0, c, 0),
                          glm::dvec4(0, 0, 0, 1));
    const double p11 = 1.0 / std::tan(phi / 2), p22 = std::cos(phi / 2) / tan_half_v;
    const glm::dmat4 m_p(glm::dvec4(p11, 0, 0, 0), glm::dvec4(0, p22, 0, 0), glm::dvec4(0, 0, -1, -1),
                         glm::dvec4(0, 0, -0.1, 0));
    glm::dmat4 m_sx(1.0), m_tx(1.0);
    m_sx[0][0] = 1.0 / n;
    m_tx[3][0] = (2 * p + 1.0) / n - 1.0;
    const glm::dmat4 m = m_tx * m_sx * m_p * m_ry;
    // eq. 2: M_clip = M_s(p11, p22; 1) · M_ry; the piece is -z >= |x| there, both ways.
    glm::dmat4 m_s(1.0);
    m_s[0][0] = p11;
    m_s[1][1] = p22;
    const glm::dmat4 m_clip = m_s * m_ry;
    const Piece& piece = set->pieces[static_cast<std::size_t>(p)];
    for (int i = 0; i < 50; ++i) {
      const double a = center + (std::uniform_real_distribution<>(-1, 1)(random)) * phi;
      const double far = std::uniform_real_distribution<>(0.5, 20)(random);
      const glm::dvec3 v =
          far * glm::dvec3(std::sin(a), std::uniform_real_distribution<>(-2, 2)(random), -std::cos(a));
      const glm::dvec4 theirs = m * glm::dvec4(v, 1.0);
      const glm::dvec3 ours = piece.to_screen * v;
      CHECK(ours.x / ours.z == doctest::Approx(theirs.x / theirs.w).epsilon(1e-10));
      CHECK(ours.y / ours.z == doctest::Approx(k * theirs.y / theirs.w).epsilon(1e-10));
      CHECK(ours.z * std::cos(phi / 2) == doctest::Approx(theirs.w).epsilon(1e-10));
      const glm::dvec4 clip = m_clip * glm::dvec4(v, 1.0);
      const bool in_theirs = std::abs(clip.x) <= -clip.z;
      const bool in_ours = glm::dot(piece.planes[0], v) >= 0 && glm::dot(piece.planes[1], v) >= 0;
      CHECK(in_ours == in_theirs);
    }
  }
}

TEST_CASE("a full turn closes: the last strip ends where the first begins") {
  const auto map = wall(360, 90, 1.0, {0.3, 0, 0.2}, {{40}, {10}, {5}});
  const PixelRect rect{0, 0, 1600, 400};
  const auto set = make_strips(map, rect, 0.25);
  REQUIRE(set);
  CHECK(set->pieces.back().planes[1] == -set->pieces.front().planes[0]);
  const glm::dvec3 behind = map.orientation * (glm::dvec3(0, 0.5, 1) - map.off_axis);
  const glm::dvec3 first = set->pieces.front().to_screen * behind,
                   last = set->pieces.back().to_screen * behind;
  CHECK(first.x / first.z == doctest::Approx(-1.0).epsilon(1e-12));
  CHECK(last.x / last.z == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(std::abs(first.y - last.y) < 1e-12);
  CHECK(std::abs(first.z - last.z) < 1e-12);
}

TEST_CASE("zoom below 1: what is beyond a full turn has no strips") {
  const auto map = wall(360, 60, 0.6);
  const PixelRect rect{10, 20, 1001, 300};
  const auto set = make_strips(map, rect, 0.25);
  REQUIRE(set);
  long columns = 0;
  for (int x = 0; x < rect.width; ++x)
    if (projection::ray(map, image(rect, rect.x + x + 0.5, 100))) ++columns;
  long covered = 0;
  for (const Piece& piece : set->pieces) covered += piece.bounds.width;
  CHECK(covered == columns);
  CHECK(columns == doctest::Approx(600).epsilon(0.005));
  CHECK(set->pieces.back().planes[1] == -set->pieces.front().planes[0]); // a full turn, exactly
  const Measured found = measure(*set, map, rect);
  CHECK(found.hidden_in_bounds == 0);
  CHECK(found.outside_planes == 0);
  CHECK(found.largest <= 0.25);
  // Zoom that shows more, but not a full turn, fills the viewport.
  const auto more = make_strips(wall(180, 60, 0.6), rect, 0.25);
  REQUIRE(more);
  check_tiling(*more, rect);
}

TEST_CASE("a tall vertical field and high zoom") {
  for (const double zoom : {0.3, 1.0, 30.0}) {
    const auto map = wall(300, 170, zoom);
    const PixelRect rect{0, 0, 800, 2000};
    const auto set = make_strips(map, rect, 0.25);
    REQUIRE(set);
    const Measured found = measure(*set, map, rect, 7);
    CHECK(found.largest <= 0.25);
    CHECK(found.least_w > 0.9); // w is 1 at the borders and at most 1 / cos inside
    CHECK(found.outside_planes == 0);
  }
}

TEST_CASE("a perspective is one exact piece, off-axis too") {
  for (const glm::dvec3 off_axis : {glm::dvec3(0), glm::dvec3(0.3, -0.5, 0.6)}) {
    model::Projection p;
    p.shape = model::Perspective{{100}, {}};
    p.zoom = 1.3;
    p.off_axis = off_axis;
    p.orientation = {{20}, {-35}, {70}};
    const auto map = projection::make_map(p, 1.5);
    const PixelRect rect{3, 4, 600, 400};
    const auto set = make_strips(map, rect, 0.01);
    REQUIRE(set);
    REQUIRE(set->pieces.size() == 1);
    CHECK(set->pieces[0].plane_count == 0);
    CHECK(set->pieces[0].bounds == rect);
    CHECK(set->max_error == 0.0);
    CHECK(set->rms_error == 0.0);
    const Measured found = measure(*set, map, rect, 13);
    CHECK(found.largest < 1e-10);
    CHECK(found.least_w == doctest::Approx(1.0));
  }
}

TEST_CASE("where there are no strips") {
  model::Projection p;
  const PixelRect rect{0, 0, 100, 100};
  p.shape = model::Fisheye{};
  CHECK_FALSE(make_strips(projection::make_map(p, 1), rect, 0.25));
  p.shape = model::Equirectangular{};
  CHECK_FALSE(make_strips(projection::make_map(p, 1), rect, 0.25));
  CHECK_FALSE(make_strips(wall(360, 90), {0, 0, 0, 100}, 0.25));
  CHECK_FALSE(make_strips(wall(360, 90), {0, 0, 2, 100}, 0.25));           // half a turn a pixel
  CHECK_FALSE(make_strips(wall(360, 90, 0.05), {0, 0, 2, 100}, 0.25));     // no pixel centre shows anything
  CHECK_FALSE(make_strips(wall(360, 90, 1.0, {0.9, 0, 0.9}), rect, 0.25)); // outside
  CHECK(make_strips(wall(360, 90, 1.0, {0, 3, 0}), rect, 0.25));           // along the axis is inside
}

TEST_CASE("strips of one pixel are the finest; the error beyond the limit is told") {
  const auto set = make_strips(wall(360, 90), {0, 0, 12, 4000}, 0.25);
  REQUIRE(set);
  CHECK(set->pieces.size() == 12);
  CHECK(set->max_error > 0.25);
}

TEST_CASE("a picture k times as large has strips of the same error in its own pixels") {
  const auto map = wall(360, 134);
  const auto one = make_strips(map, {0, 0, 1600, 1200}, 0.25),
             two = make_strips(map, {0, 0, 3200, 2400}, 0.25);
  REQUIRE(one);
  REQUIRE(two);
  CHECK(two->max_error <= 0.25);
  CHECK(two->pieces.size() > one->pieces.size());
}
