#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "renderer/passes/distribute.h"
#include "tests/renderer/passes/cylinder_views.h"

using namespace cupola;

namespace {

struct Soup {
  std::vector<content::Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<content::Material> materials{content::Material{}};
};

content::Vertex at(float x, float y, float z) { return {{x, y, z}, {0, 1, 0}, {0, 0}}; }

/// Triangles of all sizes around the eye.
Soup random_soup(unsigned seed, int triangles) {
  Soup soup;
  soup.materials[0].double_sided = true;
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  const auto draw = [&] { return normal(random); };
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 center(4.0f * draw(), 4.0f * draw(), 4.0f * draw());
    for (int corner = 0; corner < 3; ++corner) {
      soup.indices.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
      soup.vertices.push_back(
          at(center.x + 0.7f * draw(), center.y + 0.7f * draw(), center.z + 0.7f * draw()));
    }
  }
  return soup;
}

struct Distributed {
  plan::PieceSet set;
  std::vector<passes::EmittedBatch> batches;
};

Distributed distribute(const Soup& soup, double fov, bool edges) {
  const tests::CylinderView cylinder = tests::cylinder_view(fov, 120.0);
  const passes::StripAzimuths azimuths(cylinder.set, cylinder.map.orientation);
  passes::FrameGeometry geometry;
  geometry.still = soup.vertices;
  geometry.indices = soup.indices;
  geometry.materials = soup.materials;
  const std::vector<passes::DrawItem> items{{0, 0, static_cast<std::uint32_t>(soup.indices.size())}};
  const passes::StripView view{cylinder.set, azimuths, glm::vec3(0.0f), glm::mat3(1.0f), 0.05f, edges};
  Distributed made{cylinder.set, {}};
  passes::distribute_strips(geometry, items, view, made.batches);
  return made;
}

bool inside(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const auto side = [&p](const glm::dvec2& o, const glm::dvec2& q) {
    return (q.x - o.x) * (p.y - o.y) - (q.y - o.y) * (p.x - o.x);
  };
  const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
  return (ab >= -1e-9 && bc >= -1e-9 && ca >= -1e-9) || (ab <= 1e-9 && bc <= 1e-9 && ca <= 1e-9);
}

bool covered(const Distributed& result, const glm::dvec2& point) {
  for (const passes::EmittedBatch& batch : result.batches)
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      std::array<glm::dvec2, 3> corner;
      bool before = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec4& clip = batch.vertices[batch.indices[i + k]].clip;
        before = before && clip.w > 1e-3f;
        corner[k] = {clip.x / clip.w, clip.y / clip.w};
      }
      if (before && inside(point, corner[0], corner[1], corner[2])) return true;
    }
  return false;
}

} // namespace

TEST_CASE("what a piece's own perspective shows of a triangle is covered by what was emitted") {
  for (const double fov : {360.0, 150.0}) {
    const Soup soup = random_soup(3, 150);
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
      for (const plan::Piece& piece : result.set.pieces) {
        if (glm::dot(piece.planes[0], v) < 1e-4 || glm::dot(piece.planes[1], v) < 1e-4) continue;
        const glm::dvec3 h = piece.to_screen * v;
        if (h.z < 0.06 || std::abs(h.y) > 0.99 * h.z) continue;
        CHECK(covered(result, {h.x / h.z, h.y / h.z}));
        ++checked;
      }
    }
    CHECK(checked > 30);
    for (const passes::EmittedBatch& batch : result.batches)
      for (const passes::EmittedVertex& vertex : batch.vertices) CHECK(vertex.clip.w > -1e-4f);
  }
}

TEST_CASE("two triangles that share an edge meet in the same bits") {
  Soup soup;
  soup.materials[0].double_sided = true;
  soup.vertices = {at(-3.1f, -1.2f, -2.3f), at(2.7f, 1.9f, -3.4f), at(-2.2f, 2.6f, -2.9f),
                   at(2.9f, -1.7f, -2.6f)};
  soup.indices = {0, 1, 2, 1, 0, 3}; // the shared edge runs both ways
  const Distributed apart = distribute(soup, 360.0, true);
  const Distributed shared = distribute(soup, 360.0, false);
  REQUIRE(apart.batches.size() == 1);
  // Sharing joins exactly what has the same position: it removes vertices and moves none.
  const passes::EmittedBatch &a = apart.batches[0], &b = shared.batches[0];
  REQUIRE(b.indices.size() == a.indices.size());
  CHECK(b.vertices.size() < a.vertices.size());
  for (std::size_t i = 0; i < a.indices.size(); ++i)
    CHECK(a.vertices[a.indices[i]].clip == b.vertices[b.indices[i]].clip);
}

TEST_CASE("back faces of single-sided materials are left out") {
  Soup soup;
  soup.vertices = {at(-1, 0, -5), at(1, 0, -5), at(0, 1, -5)};
  soup.indices = {0, 1, 2};
  CHECK(distribute(soup, 180.0, false).batches[0].pairs > 0);
  soup.indices = {0, 2, 1};
  CHECK(distribute(soup, 180.0, false).batches[0].pairs == 0);
}
