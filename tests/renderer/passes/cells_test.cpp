#include "renderer/passes/cells.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "tests/renderer/passes/exact_pairs.h"
#include "tests/renderer/passes/soup.h"

using namespace cupola;

namespace {

constexpr int size = 512;
constexpr float near = 0.05f;

plan::PieceSet fisheye(double degrees) {
  model::Projection projection;
  projection.shape = model::Fisheye{{degrees}};
  return *plan::make_cells(projection::make_map(projection, 1.0), {0, 0, size, size}, 0.25);
}

struct Result {
  std::vector<passes::EmittedBatch> batches;
  std::uint64_t pairs = 0, emitted = 0;
};

Result distribute(const plan::PieceSet& set, const tests::Soup& soup, std::vector<passes::DrawItem> items) {
  const passes::PieceTable table(set);
  const passes::CellView view{table, glm::vec3(0.0f), glm::mat3(1.0f), near, false};
  passes::Occlusion occlusion;
  occlusion.reset(table);
  Result out;
  passes::distribute_cells(soup.geometry(), items, view, occlusion, out.batches);
  for (const passes::EmittedBatch& batch : out.batches) {
    out.pairs += batch.pairs;
    out.emitted += batch.indices.size() / 3;
  }
  return out;
}

Result distribute(const plan::PieceSet& set, const tests::Soup& soup) {
  return distribute(set, soup, {{0, 0, static_cast<std::uint32_t>(soup.indices.size())}});
}

/// Where a ray of the eye meets a triangle: its distance in lengths of the ray, and how far inside.
struct Hit {
  double distance, margin;
};
std::optional<Hit> hit(const tests::Soup& soup, std::size_t triangle, const glm::dvec3& ray) {
  const glm::dmat3 corners(soup.corner(triangle, 0), soup.corner(triangle, 1), soup.corner(triangle, 2));
  const double volume = glm::determinant(corners);
  if (volume == 0.0) return std::nullopt;
  const glm::dvec3 share = glm::inverse(corners) * ray;
  if (share.x < 0.0 || share.y < 0.0 || share.z < 0.0) return std::nullopt;
  const double sum = share.x + share.y + share.z;
  return Hit{1.0 / sum, std::min({share.x, share.y, share.z}) / sum};
}

/// The nearest emitted triangle at a point of the screen: its w there. Edge functions in homogeneous
/// coordinates.
double nearest_emitted(const Result& result, const glm::dvec2& at) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const passes::EmittedBatch& batch : result.batches)
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      glm::dmat3 corners;
      for (int k = 0; k < 3; ++k) {
        const glm::vec4& p = batch.vertices[batch.indices[i + static_cast<std::size_t>(k)]].position;
        corners[k] = glm::dvec3(p.x, p.y, p.w);
      }
      if (std::abs(glm::determinant(corners)) < 1e-14) continue;
      const glm::dvec3 share = glm::inverse(corners) * glm::dvec3(at, 1.0);
      if (share.x >= 0.0 && share.y >= 0.0 && share.z >= 0.0)
        nearest = std::min(nearest, 1.0 / (share.x + share.y + share.z));
    }
  return nearest;
}

/// The piece at a point of the screen.
const plan::Piece* piece_at(const plan::PieceSet& set, const glm::dvec2& at) {
  for (const plan::Piece& piece : set.pieces) {
    const glm::dvec3 ray = glm::inverse(piece.to_screen) * glm::dvec3(at, 1.0);
    if (std::all_of(piece.planes.begin(), piece.planes.end(),
                    [&](const glm::dvec3& plane) { return glm::dot(plane, ray) > 1e-6; }))
      return &piece;
  }
  return nullptr;
}

} // namespace

TEST_CASE("every pixel shows what lies nearest on its ray") {
  for (const double degrees : {120.0, 180.0, 260.0}) {
    const plan::PieceSet set = fisheye(degrees);
    const tests::Soup soup = tests::random_soup(7, 150, 0.8f);
    const Result result = distribute(set, soup);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.7, 0.7);
    int seen = 0;
    for (int i = 0; i < 600; ++i) {
      const double x = uniform(random), y = uniform(random);
      const glm::dvec2 at(x, y);
      const plan::Piece* piece = piece_at(set, at);
      if (piece == nullptr) continue;                                              // on a border
      const glm::dvec3 ray = glm::inverse(piece->to_screen) * glm::dvec3(at, 1.0); // where w is 1
      double nearest = std::numeric_limits<double>::infinity();
      bool clear = true;
      for (std::size_t triangle = 0; triangle < soup.triangles(); ++triangle)
        if (const auto met = hit(soup, triangle, ray)) {
          clear = clear && met->margin > 1e-3;
          nearest = std::min(nearest, met->distance);
        }
      if (!clear) continue; // too near to an edge to tell
      const double emitted = nearest_emitted(result, at);
      CAPTURE(degrees);
      CAPTURE(x);
      CAPTURE(y);
      if (std::isinf(nearest)) {
        CHECK(std::isinf(emitted));
      } else {
        CHECK(emitted == doctest::Approx(nearest).epsilon(1e-3));
        ++seen;
      }
    }
    CHECK(seen > 100);
  }
}

TEST_CASE("pairs are as many as there must be") {
  const plan::PieceSet set = fisheye(180.0);
  for (const float extent : {0.05f, 0.5f, 4.0f}) {
    tests::Soup soup = tests::random_soup(11, 120, extent);
    soup.materials[0].alpha_mode = content::AlphaMode::mask; // hides nothing
    std::uint64_t exact = 0;
    for (std::size_t triangle = 0; triangle < soup.triangles(); ++triangle)
      for (const plan::Piece& piece : set.pieces)
        exact += tests::meets(piece,
                              {soup.corner(triangle, 0), soup.corner(triangle, 1), soup.corner(triangle, 2)})
                     ? 1
                     : 0;
    const Result result = distribute(set, soup);
    CAPTURE(extent);
    CHECK(exact > 50);
    CHECK(static_cast<double>(result.pairs) <= 1.02 * static_cast<double>(exact));
    CHECK(static_cast<double>(result.pairs) >= 0.98 * static_cast<double>(exact));
  }
}

TEST_CASE("what lies behind a wall is not emitted, what lies before it is") {
  const plan::PieceSet set = fisheye(180.0);
  tests::Soup soup;
  soup.materials[0].double_sided = true;
  soup.add({-1000, -1000, -10}, {1000, -1000, -10}, {0, 2000, -10});
  const Result wall = distribute(set, soup);
  const std::uint64_t alone = wall.emitted;
  tests::Soup behind = soup, before = soup;
  behind.add({-1, -1, -11}, {1, -1, -11}, {0, 1, -11});
  before.add({-1, -1, -9}, {1, -1, -9}, {0, 1, -9});
  CHECK(distribute(set, behind).emitted == alone);
  CHECK(distribute(set, before).emitted > alone);
  behind.materials[0].alpha_mode = content::AlphaMode::blend;
  CHECK(distribute(set, behind).emitted > alone);
}

TEST_CASE("an item all behind a wall is left out, one half before it is not") {
  const plan::PieceSet set = fisheye(180.0);
  tests::Soup soup;
  soup.materials[0].double_sided = true;
  soup.add({-1000, -1000, -10}, {1000, -1000, -10}, {0, 2000, -10});
  soup.add({-1, -1, -30}, {1, -1, -30}, {0, 1, -30});
  soup.add({-1, -1, -30}, {1, -1, -9}, {0, 1, -9});
  const passes::DrawItem wall{0, 0, 3}, behind{0, 3, 3, {0, 0, -30}, 2.0f},
      through{0, 6, 3, {0, 0, -19.5f}, 11.5f};
  const Result alone = distribute(set, soup, {wall});
  CHECK(alone.pairs > 100);
  CHECK(distribute(set, soup, {wall, behind}).pairs == alone.pairs);
  CHECK(distribute(set, soup, {behind, wall}).pairs > alone.pairs); // hides only what comes after it
  CHECK(distribute(set, soup, {wall, through}).emitted > alone.emitted);
}

TEST_CASE("opaque parts come from near to far, blended ones as they stand") {
  const plan::PieceSet set = fisheye(180.0);
  tests::Soup soup;
  soup.add({-1, -1, -90}, {1, -1, -90}, {0, 1, -90});
  soup.add({-1, -1, -9}, {1, -1, -9}, {0, 1, -9});
  const auto depths = [&] {
    std::vector<float> out;
    const Result result = distribute(set, soup);
    REQUIRE(result.batches.size() == 1);
    std::vector<passes::EmittedPortion> portions = result.batches[0].portions;
    std::stable_sort(portions.begin(), portions.end(),
                     [](const auto& a, const auto& b) { return a.run < b.run; });
    for (const passes::EmittedPortion& portion : portions)
      out.push_back(result.batches[0].vertices[result.batches[0].indices[portion.first_index]].position.w);
    return out;
  };
  const std::vector<float> opaque = depths();
  REQUIRE(opaque.size() == 2);
  CHECK(opaque[0] < 0.2f * opaque[1]);
  soup.materials[0].alpha_mode = content::AlphaMode::blend;
  const std::vector<float> blended = depths();
  REQUIRE(blended.size() == 1);
  CHECK(blended[0] == doctest::Approx(opaque[1]));
}

TEST_CASE("an item whose sphere is known finds the same pairs") {
  const plan::PieceSet set = fisheye(180.0);
  tests::Soup soup;
  soup.materials[0].double_sided = true;
  std::vector<passes::DrawItem> known, unknown;
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  const auto draw = [&](float scale) {
    const float x = normal(random), y = normal(random), z = normal(random);
    return scale * glm::vec3(x, y, z);
  };
  for (std::uint32_t i = 0; i < 40; ++i) {
    const glm::vec3 center = draw(3.0f);
    float radius = 0.0f;
    std::array<glm::vec3, 3> corners;
    for (glm::vec3& corner : corners) {
      corner = center + draw(0.4f);
      radius = std::max(radius, glm::length(corner - center));
    }
    soup.add(corners[0], corners[1], corners[2]);
    known.push_back({0, 3 * i, 3, center, radius});
    unknown.push_back({0, 3 * i, 3});
  }
  const Result a = distribute(set, soup, known), b = distribute(set, soup, unknown);
  CHECK(a.pairs == b.pairs);
  CHECK(a.pairs > 40);
}

TEST_CASE("vertices are shared between the parts that meet in them") {
  const plan::PieceSet set = fisheye(180.0);
  tests::Soup soup;
  soup.add({-1000, -1000, -10}, {1000, -1000, -10}, {0, 2000, -10});
  const Result result = distribute(set, soup);
  std::size_t vertices = 0;
  for (const passes::EmittedBatch& batch : result.batches) vertices += batch.vertices.size();
  CHECK(result.emitted > 100);
  CHECK(static_cast<double>(vertices) < 0.75 * static_cast<double>(result.emitted));
}

TEST_CASE("two triangles at an edge meet the pieces' borders at the same places, to the last bit") {
  const plan::PieceSet set = fisheye(180.0);
  std::mt19937 random(9);
  std::normal_distribution<float> normal;
  const auto draw = [&](float scale) {
    const float x = normal(random), y = normal(random), z = normal(random);
    return scale * glm::vec3(x, y, z);
  };
  constexpr std::uint32_t pairs = 1500;
  std::vector<std::array<glm::vec3, 4>> corners;
  for (std::uint32_t i = 0; i < pairs; ++i) {
    const glm::vec3 middle = draw(4.0f);
    corners.push_back({middle + draw(2.0f), middle + draw(2.0f), middle + draw(2.0f), middle + draw(2.0f)});
  }
  tests::Soup soup;
  soup.materials[0].double_sided = true;
  soup.materials[0].alpha_mode = content::AlphaMode::mask; // hides nothing
  for (const auto& [a, b, c, d] : corners) soup.add(a, b, c);
  for (const auto& [a, b, c, d] : corners) soup.add(d, c, b);
  for (std::uint32_t i = 0; i < soup.vertices.size(); ++i) soup.vertices[i].color = i / 3; // tells them apart
  // Points of the edge opposite the first corner, without its ends; by triangle.
  std::vector<std::set<std::array<float, 3>>> places(2 * std::size_t{pairs});
  for (const passes::EmittedBatch& batch : distribute(set, soup).batches)
    for (const passes::EmittedVertex& v : batch.vertices)
      if (v.corner.x == 0.0f && v.corner.y != 0.0f && v.corner.y != 1.0f)
        places[v.color].insert({v.position.x, v.position.y, v.position.w});
  std::size_t seen = 0;
  for (std::uint32_t i = 0; i < pairs; ++i) {
    CHECK(places[i] == places[pairs + i]);
    seen += places[i].size();
  }
  CHECK(seen > 10'000);
}

TEST_CASE("a triangle through the eye, seen edge on, and one of no area yield nothing wrong") {
  const plan::PieceSet set = fisheye(180.0);
  tests::Soup soup;
  soup.materials[0].double_sided = true;
  soup.add({0, 0, -1}, {0, 0, -2}, {0, 0, -3});
  soup.add({-1, 0, -1}, {1, 0, -1}, {0, 0, 1});
  soup.add({1, 1, -1}, {1, 1, -1}, {2, 1, -1});
  const Result result = distribute(set, soup);
  for (const passes::EmittedBatch& batch : result.batches)
    for (const passes::EmittedVertex& vertex : batch.vertices)
      CHECK((std::isfinite(vertex.position.x) && std::isfinite(vertex.position.w)));
}
