#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

#include "renderer/plan/plan.h"

using namespace cupola;
using namespace cupola::plan;

namespace {

constexpr PixelRect rect{16, 32, 800, 600};

model::Projection bent(double angle, double zoom = 1.0) {
  model::CameraTexture texture;
  texture.columns = 20;
  texture.rows = 15;
  texture.deformations["bulge"] = {model::RadialZoom{0.6}, 0, 0, 0.9, 0};
  texture.deformations["turn"] = {model::Swirl{{angle}}, 0, 0, 0.8, 1};
  model::Projection p;
  p.shape = texture;
  p.zoom = zoom;
  return p;
}

projection::Map map_of(const model::Projection& projection) {
  return projection::make_map(projection, double(rect.width) / rect.height);
}

/// The piece whose pyramid holds a direction.
const Piece* holding(const PieceSet& set, const glm::dvec3& direction) {
  for (const Piece& piece : set.pieces) {
    bool in = true;
    for (const glm::dvec3& plane : piece.planes) in = in && glm::dot(plane, direction) >= -1e-12;
    if (in) return &piece;
  }
  return nullptr;
}

} // namespace

TEST_CASE("pieces of a camera texture are its triangles, without error") {
  model::Projection p = bent(60.0);
  p.off_axis = {0.2, -0.1, 0.3};
  p.orientation = {{25}, {-40}, {10}};
  const projection::Map map = map_of(p);
  const auto set = make_camera_texture_pieces(map, rect);
  REQUIRE(set);
  CHECK(set->max_error == 0.0);
  CHECK_FALSE(set->strips);
  CHECK(set->pieces.size() == set->triangles.size());
  CHECK(set->pieces.size() <= 600);
  CHECK(set->pieces.size() > 400);
  CHECK_FALSE(set->groups.empty());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  int shown = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec2 st(anywhere(random), anywhere(random));
    const auto direction = projection::ray(map, st);
    if (!direction) continue;
    ++shown;
    const Piece* piece = holding(*set, *direction);
    REQUIRE(piece);
    const glm::dvec3 h = piece->to_screen * *direction;
    CHECK(h.z == doctest::Approx(1.0)); // the weight: 1 where a ray ends, as in a perspective
    CHECK(glm::length(glm::dvec2(h) / h.z - st) < 1e-9);
    const glm::dvec2 pixel(rect.x + (st.x + 1) * 0.5 * rect.width, rect.y + (1 - st.y) * 0.5 * rect.height);
    CHECK(pixel.x > piece->bounds.x - 1e-6);
    CHECK(pixel.x < piece->bounds.x + piece->bounds.width + 1e-6);
    CHECK(pixel.y > piece->bounds.y - 1e-6);
    CHECK(pixel.y < piece->bounds.y + piece->bounds.height + 1e-6);
  }
  CHECK(shown > 1500);
}

TEST_CASE("what a camera texture leaves uncovered is told") {
  CHECK(make_camera_texture_pieces(map_of(bent(0.0)), rect)->fills); // a bulge pushes the border outwards
  CHECK_FALSE(make_camera_texture_pieces(map_of(bent(250.0)), rect)->fills); // a swirl pulls it in
  CHECK(make_camera_texture_pieces(map_of(bent(250.0, 1.5)), rect)->fills);
  CHECK_FALSE(make_camera_texture_pieces(map_of(bent(0.0, 0.5)), rect)->fills);
  model::Projection plain = bent(0.0);
  std::get<model::CameraTexture>(plain.shape).deformations.clear();
  CHECK(make_camera_texture_pieces(map_of(plain), rect)->fills);
  CHECK(make_camera_texture_pieces(map_of(plain), {0, 0, 1, 1})->fills);
  std::get<model::CameraTexture>(plain.shape).offsets.assign(16, std::vector<glm::dvec2>(21, {3, 0}));
  CHECK_FALSE(make_camera_texture_pieces(map_of(plain), rect)); // all of it has left the picture
  // Zoomed in, only pieces that reach the picture are left.
  CHECK(make_camera_texture_pieces(map_of(bent(0.0, 20.0)), rect)->pieces.size() < 60);
}

TEST_CASE("a camera texture that is said to fill its picture shows every pixel") {
  int filled = 0;
  for (const double angle : {0.0, 60.0, 120.0, -200.0, 400.0})
    for (const double zoom : {0.9, 1.0, 1.1, 1.4}) {
      const projection::Map map = map_of(bent(angle, zoom));
      const PixelRect small{0, 0, 80, 60};
      const bool fills = make_camera_texture_pieces(map, small)->fills;
      long missing = 0;
      for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
          missing += !projection::ray(map, {(x + 0.5) / 40 - 1, 1 - (y + 0.5) / 30});
      CAPTURE(angle);
      CAPTURE(zoom);
      CHECK((!fills || missing == 0));
      CHECK((fills || missing > 0)); // of such grids it is certain
      filled += fills;
    }
  CHECK(filled > 5);
  CHECK(filled < 15);
}

TEST_CASE("folded triangles are pieces, narrow ones are not; both are told") {
  model::Projection p = bent(0.0);
  auto& texture = std::get<model::CameraTexture>(p.shape);
  texture.deformations.clear();
  CHECK_FALSE(first_fold(map_of(p)));
  texture.columns = 4;
  texture.rows = 2;
  texture.offsets.assign(3, std::vector<glm::dvec2>(5));
  texture.offsets[1][2] = {0.5, 0.0}; // onto its neighbour: four triangles vanish, two of them beside it
  auto fold = first_fold(map_of(p));
  REQUIRE(fold);
  CHECK(fold->column == 2);
  CHECK(fold->row == 0);
  CHECK(fold->narrow);
  const auto narrow = make_camera_texture_pieces(map_of(p), rect);
  REQUIRE(narrow);
  CHECK(narrow->pieces.size() == std::size_t(16 - fold->triangles));
  texture.offsets[1][2] = {0.75, 0.0}; // over it
  fold = first_fold(map_of(p));
  REQUIRE(fold);
  CHECK_FALSE(fold->narrow);
  CHECK(make_camera_texture_pieces(map_of(p), rect)->pieces.size() == 16);
}

TEST_CASE("a camera texture of 75 degrees bends one face alone") {
  const CubemapPlan plan = make_cubemap(map_of(bent(60.0)), rect, {});
  int seen = 0;
  for (const CubeFace& face : plan.faces) seen += face.seen;
  CHECK(seen == 1);
  CHECK(plan.faces[5].seen);
  CHECK(plan.size == matched_cubemap_size(map_of(bent(0.0)), rect));
}

TEST_CASE("other shapes have no such pieces") {
  model::Projection p;
  p.shape = model::Perspective{};
  CHECK_FALSE(make_camera_texture_pieces(map_of(p), rect));
  CHECK_FALSE(first_fold(map_of(p)));
}
