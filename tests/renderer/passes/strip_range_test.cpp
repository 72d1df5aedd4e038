#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "tests/renderer/passes/cylinder_views.h"

using namespace cupola;
using passes::StripAzimuths;
using passes::StripRange;
using tests::cylinder_view;
using tests::CylinderView;

namespace {

bool holds(const StripRange& range, int strip, int strips) {
  const int steps = ((strip - range.first) % strips + strips) % strips;
  return steps < range.count;
}

/// Strip whose planes hold the point, or −1.
int strip_of(const plan::PieceSet& set, const glm::dvec3& v) {
  for (std::size_t i = 0; i < set.pieces.size(); ++i)
    if (glm::dot(set.pieces[i].planes[0], v) >= 0.0 && glm::dot(set.pieces[i].planes[1], v) >= 0.0)
      return static_cast<int>(i);
  return -1;
}

using Corners = std::array<glm::dvec3, 3>;

StripRange range_of(const StripAzimuths& azimuths, const Corners& corners) {
  std::array<float, 3> azimuth{};
  for (std::size_t i = 0; i < 3; ++i)
    azimuth[i] = StripAzimuths::azimuth(azimuths.axes_from_view() * glm::vec3(corners[i]));
  return azimuths.triangle(azimuth[0], azimuth[1], azimuth[2]);
}

} // namespace

TEST_CASE("borders rise from left to right over the field of view") {
  const CylinderView whole = cylinder_view(360.0);
  const StripAzimuths azimuths(whole.set, whole.map.orientation);
  CHECK(azimuths.full_turn());
  CHECK(azimuths.count() == static_cast<int>(whole.set.pieces.size()));
  CHECK(azimuths.borders().front() == doctest::Approx(-std::numbers::pi));
  CHECK(azimuths.borders().back() == doctest::Approx(std::numbers::pi));
  const CylinderView part = cylinder_view(120.0);
  const StripAzimuths narrow(part.set, part.map.orientation);
  CHECK_FALSE(narrow.full_turn());
  CHECK(narrow.borders().front() == doctest::Approx(-std::numbers::pi / 3.0));
  CHECK(narrow.borders().back() == doctest::Approx(std::numbers::pi / 3.0));
}

TEST_CASE("no strip that a triangle touches is ever missing, and few are named in vain") {
  for (const CylinderView& view :
       {cylinder_view(360.0), cylinder_view(200.0), cylinder_view(60.0),
        cylinder_view(360.0, 100.0, {0.4, 0.0, 0.3}),
        cylinder_view(270.0, 100.0, {-0.5, 0.2, 0.1}, {{130.0}, {25.0}, {-40.0}})}) {
    const StripAzimuths azimuths(view.set, view.map.orientation);
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    long named = 0, touched = 0;
    for (int round = 0; round < 1500; ++round) {
      const double size = std::pow(10.0, -2.0 + 3.0 * unit(random));
      const glm::dvec3 center(normal(random) * 3.0, normal(random) * 3.0, normal(random) * 3.0);
      Corners corners;
      for (glm::dvec3& corner : corners)
        corner = center + size * glm::dvec3(normal(random), normal(random), normal(random));
      const StripRange range = range_of(azimuths, corners);
      std::vector<bool> seen(view.set.pieces.size(), false);
      for (int sample = 0; sample < 300; ++sample) {
        double a = unit(random), b = unit(random);
        if (a + b > 1.0) {
          a = 1.0 - a;
          b = 1.0 - b;
        }
        const int strip =
            strip_of(view.set, corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]));
        if (strip < 0) continue;
        REQUIRE(holds(range, strip, azimuths.count()));
        seen[static_cast<std::size_t>(strip)] = true;
      }
      named += range.count;
      for (const bool it : seen) touched += it ? 1 : 0;
    }
    // Sampling itself misses some that are touched, so the exact figure lies between.
    MESSAGE("named " << named << ", touched by samples " << touched);
    CHECK(static_cast<double>(named) < 2.0 * static_cast<double>(touched));
  }
}

TEST_CASE("a triangle that the axis pierces touches all strips") {
  const CylinderView view = cylinder_view(360.0);
  const StripAzimuths azimuths(view.set, view.map.orientation);
  CHECK(range_of(azimuths, {glm::dvec3(-1, 5, 1), {1, 5, 1}, {0, 5, -1}}).count == azimuths.count());
}

TEST_CASE("a triangle across the back seam wraps around") {
  const CylinderView view = cylinder_view(360.0);
  const StripAzimuths azimuths(view.set, view.map.orientation);
  const StripRange range = range_of(azimuths, {glm::dvec3(-0.1, 0, 1), {0.1, 0, 1}, {0.1, 1, 1}});
  CHECK(range.count < azimuths.count() / 4);
  CHECK(holds(range, 0, azimuths.count()));
  CHECK(holds(range, azimuths.count() - 1, azimuths.count()));
  CHECK_FALSE(holds(range, azimuths.count() / 2, azimuths.count()));
}

TEST_CASE("what is outside the field touches no strip") {
  const CylinderView view = cylinder_view(90.0);
  const StripAzimuths azimuths(view.set, view.map.orientation);
  CHECK(range_of(azimuths, {glm::dvec3(-0.1, 0, 1), {0.1, 0, 1}, {0.1, 1, 1}}).count == 0);
  CHECK(azimuths.sphere({0.0f, 0.0f, 5.0f}, 1.0f).count == 0);
  CHECK(azimuths.sphere({0.0f, 0.0f, -5.0f}, 1.0f).count > 0);
  CHECK(azimuths.sphere({0.0f, 0.0f, 5.0f}, 6.0f).count == azimuths.count()); // around the eye
}
