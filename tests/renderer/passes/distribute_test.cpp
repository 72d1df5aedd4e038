#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "renderer/passes/distribute.h"
#include "tests/renderer/passes/cylinder_views.h"
#include "tests/renderer/passes/soup.h"

using namespace cupola;

namespace {

using tests::Soup;

content::Vertex at(float x, float y, float z) { return {{x, y, z}, {0, 1, 0}, {0, 0}}; }

constexpr int group_size = 16;

struct Distributed {
  plan::PieceSet set;
  std::vector<passes::EmittedBatch> batches;
};

Distributed distribute(const Soup& soup, double fov, bool edges) {
  const tests::CylinderView cylinder = tests::cylinder_view(fov, 120.0);
  const passes::StripAzimuths azimuths(cylinder.set, cylinder.map.orientation);
  const passes::FrameGeometry geometry = soup.geometry();
  const std::vector<passes::DrawItem> items{{0, 0, static_cast<std::uint32_t>(soup.indices.size())}};
  const passes::StripView view{cylinder.set, azimuths, glm::vec3(0.0f), glm::mat3(1.0f), 0.05f,
                               group_size,   edges};
  Distributed made{cylinder.set, {}};
  passes::distribute_strips(geometry, items, view, made.batches);
  return made;
}

/// Some triangle emitted for this strip shows the point, which is in clip space with w > 0. Edge functions in
/// homogeneous coordinates: corners may lie behind the eye.
bool covered(const Distributed& result, std::size_t strip, const glm::dvec3& point) {
  for (const passes::EmittedBatch& batch : result.batches)
    for (const passes::EmittedPortion& portion : batch.portions) {
      if (portion.group != strip / group_size) continue;
      for (std::uint32_t i = 0; i < portion.index_count; i += 3) {
        glm::dmat3 corners;
        bool same_strip = true;
        for (int k = 0; k < 3; ++k) {
          const glm::vec4& p =
              batch.vertices[batch.indices[portion.first_index + i + static_cast<std::uint32_t>(k)]].position;
          same_strip = same_strip && static_cast<std::size_t>(p.z) == strip % group_size;
          corners[k] = glm::dvec3(p.x, p.y, p.w);
        }
        if (!same_strip || glm::determinant(corners) == 0.0) continue;
        const glm::dvec3 weights = glm::inverse(corners) * point;
        if (weights.x >= -1e-6 && weights.y >= -1e-6 && weights.z >= -1e-6) return true;
      }
    }
  return false;
}

} // namespace

TEST_CASE("what a piece's own perspective shows of a triangle is covered by what was emitted") {
  for (const double fov : {360.0, 150.0}) {
    const Soup soup = tests::random_soup(3, 150, 0.7f);
    const Distributed result = distribute(soup, fov, true);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    long checked = 0;
    for (std::size_t t = 0; t + 2 < soup.indices.size(); t += 3) {
      double a = unit(random), b = unit(random);
      if (a + b > 1.0) {
        a = 1.0 - a;
        b = 1.0 - b;
      }
      const glm::dvec3 p0(soup.vertices[t].position), p1(soup.vertices[t + 1].position),
          p2(soup.vertices[t + 2].position);
      const glm::dvec3 v = p0 + a * (p1 - p0) + b * (p2 - p0);
      for (std::size_t strip = 0; strip < result.set.pieces.size(); ++strip) {
        const plan::Piece& piece = result.set.pieces[strip];
        if (glm::dot(piece.planes[0], v) < 1e-4 || glm::dot(piece.planes[1], v) < 1e-4) continue;
        const glm::dvec3 h = piece.to_screen * v;
        if (h.z < 0.06 || std::abs(h.y) > 0.99 * h.z) continue;
        CHECK(covered(result, strip, h));
        ++checked;
      }
    }
    CHECK(checked > 30);
  }
}

TEST_CASE("sharing joins corners of neighbours and moves none") {
  Soup soup;
  soup.materials[0].double_sided = true;
  soup.vertices = {at(-3.1f, -1.2f, -2.3f), at(2.7f, 1.9f, -3.4f), at(-2.2f, 2.6f, -2.9f),
                   at(2.9f, -1.7f, -2.6f)};
  soup.indices = {0, 1, 2, 1, 0, 3}; // the shared edge runs both ways
  const Distributed apart = distribute(soup, 360.0, true);
  const Distributed shared = distribute(soup, 360.0, false);
  REQUIRE(apart.batches.size() == 1);
  const passes::EmittedBatch &a = apart.batches[0], &b = shared.batches[0];
  REQUIRE(b.indices.size() == a.indices.size());
  CHECK(b.vertices.size() < a.vertices.size());
  for (std::size_t i = 0; i < a.indices.size(); ++i)
    CHECK(a.vertices[a.indices[i]].position == b.vertices[b.indices[i]].position);
}

TEST_CASE("back faces of single-sided materials are left out") {
  Soup soup;
  soup.vertices = {at(-1, 0, -5), at(1, 0, -5), at(0, 1, -5)};
  soup.indices = {0, 1, 2};
  CHECK(distribute(soup, 180.0, false).batches[0].pairs > 0);
  soup.indices = {0, 2, 1};
  CHECK(distribute(soup, 180.0, false).batches[0].pairs == 0);
}

TEST_CASE("shells of depth: any number has one, and farther ones are not before nearer ones") {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  CHECK(passes::depth_shell(std::numeric_limits<float>::quiet_NaN(), 2.0f) == 0);
  CHECK(passes::depth_shell(-infinity, 2.0f) == 0);
  CHECK(passes::depth_shell(1.0f, 2.0f) == 0);
  CHECK(passes::depth_shell(2.1f, 2.0f) == 2);
  CHECK(passes::depth_shell(infinity, 2.0f) == passes::depth_shells - 1);
  std::size_t last = 0;
  for (float depth = 0.01f; depth < 1e9f; depth *= 1.1f) {
    CHECK(passes::depth_shell(depth, 1.0f) >= last);
    last = passes::depth_shell(depth, 1.0f);
  }
}

TEST_CASE("portions hold whole triangles of one material: opaque ones by depth, blended ones as they stand") {
  Soup soup = tests::random_soup(9, 60, 0.7f);
  soup.materials.push_back(soup.materials.front());
  const tests::CylinderView cylinder = tests::cylinder_view(360.0, 120.0);
  const passes::StripAzimuths azimuths(cylinder.set, cylinder.map.orientation);
  const std::vector<passes::DrawItem> items{{0, 0, 60}, {1, 60, 60}, {0, 120, 60}};
  const passes::StripView view{cylinder.set, azimuths, glm::vec3(0.0f), glm::mat3(1.0f), 0.05f,
                               group_size,   false};
  for (const bool blended : {false, true}) {
    for (content::Material& material : soup.materials)
      material.alpha_mode = blended ? content::AlphaMode::blend : content::AlphaMode::opaque;
    const passes::FrameGeometry geometry = soup.geometry();
    std::vector<passes::EmittedBatch> batches;
    passes::distribute_strips(geometry, items, view, batches);
    REQUIRE(batches.size() == 1);
    const passes::EmittedBatch& batch = batches[0];
    std::uint32_t next = 0;
    std::set<std::uint32_t> runs;
    for (const passes::EmittedPortion& portion : batch.portions) {
      CHECK(portion.first_index == next);
      CHECK(portion.index_count % 3 == 0);
      CHECK(portion.material == portion.run % 2);
      next += portion.index_count;
      runs.insert(portion.run);
      if (blended) continue;
      for (std::uint32_t i = portion.first_index; i < next; i += 3) {
        float nearest = std::numeric_limits<float>::infinity();
        for (std::uint32_t k = 0; k < 3; ++k)
          nearest = std::min(nearest, batch.vertices[batch.indices[i + k]].position.w);
        CHECK(portion.run / 2 == passes::depth_shell(nearest, 1.0f));
      }
    }
    CHECK(next == batch.indices.size());
    CHECK(batch.pairs == batch.indices.size() / 3);
    if (blended)
      CHECK(runs == std::set<std::uint32_t>{0, 1, 2});
    else
      CHECK(runs.size() > 2);
  }
}
