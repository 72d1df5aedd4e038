#include "renderer/passes/gpu_pieces.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <random>
#include <set>

#include "renderer/content/clusters.h"
#include "tests/renderer/passes/exact_pairs.h"
#include "tests/renderer/passes/piece_drawing.h"
#include "tests/renderer/passes/soup.h"

using namespace cupola;
using namespace cupola::tests;

namespace {

constexpr int size = 256;

plan::PieceSet cells(const model::Shape& shape, double max_error = 0.25) {
  model::Projection projection;
  projection.shape = shape;
  return *plan::make_cells(projection::make_map(projection, 1.0), {0, 0, size, size}, max_error);
}

/// Two triangles for each cell of the set's corners, which stand in rows of `across`.
void finish_grid(plan::PieceSet& set, std::uint32_t across) {
  const auto rows = static_cast<std::uint32_t>(set.corners.size()) / across;
  for (std::uint32_t y = 0; y + 1 < rows; ++y)
    for (std::uint32_t x = 0; x + 1 < across; ++x) {
      const std::uint32_t a = y * across + x, b = a + 1, c = a + across, d = c + 1;
      set.triangles.push_back({a, d, b});
      set.triangles.push_back({a, c, d});
    }
  set.shown.assign(set.triangles.size(), plan::Shown::all);
  plan::finish_triangles(set, {0, 0, size, size});
}

/// Square cells whose diagonals run through pixel centres: what a splitter avoids and data may ask for.
plan::PieceSet leaky_cells() {
  constexpr int side = 16;
  model::Projection projection;
  projection.shape = model::Stereographic{{200.0}};
  const projection::Map map = projection::make_map(projection, 1.0);
  plan::PieceSet set;
  for (int y = 0; y <= size; y += side)
    for (int x = 0; x <= size; x += side) {
      const glm::dvec2 at(2.0 * x / size - 1.0, 1.0 - 2.0 * y / size);
      set.corners.push_back({glm::normalize(projection::beyond(map, at, glm::dvec2(0.0)).value()), 1.0, at});
    }
  finish_grid(set, size / side + 1);
  return set;
}

/// A perspective of 90° whose picture is moved about on a grid: a swirl, or waves that fold it.
plan::PieceSet moved_grid(bool folded) {
  constexpr std::uint32_t across = 41;
  plan::PieceSet set;
  for (std::uint32_t j = 0; j < across; ++j)
    for (std::uint32_t i = 0; i < across; ++i) {
      const glm::dvec2 at = 2.6 * glm::dvec2(i, j) / (across - 1.0) - 1.3;
      const double turn = 0.4 * std::exp(-2.0 * glm::dot(at, at));
      const glm::dvec2 swirled(std::cos(turn) * at.x - std::sin(turn) * at.y,
                               std::sin(turn) * at.x + std::cos(turn) * at.y);
      const glm::dvec3 ray = glm::normalize(glm::dvec3(at, -1.0));
      set.corners.push_back(
          {ray, -ray.z, folded ? at + glm::dvec2(0.35 * std::sin(5.0 * at.x), 0.0) : swirled});
    }
  finish_grid(set, across);
  return set;
}

/// Background pixels that views from inside a closed room show.
long holes_in_room(const plan::PieceSet& set) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const std::shared_ptr<const content::Scene> room = content::load_scene(model::Room{}, ".")->scene;
  long holes = 0;
  for (int view = 0; view < 20; ++view) {
    model::Camera camera;
    const double x = unit(random), y = unit(random), z = unit(random);
    camera.position = 4.5 * glm::dvec3(x, y, z);
    camera.orientation = {{180.0 * unit(random)}, {90.0 * unit(random)}, {180.0 * unit(random)}};
    PieceDrawing drawing(room, set, size, plan::camera_at(camera, 0.0));
    const Bytes black = drawing.by_gpu();
    drawing.background = glm::vec3(1.0f);
    const Bytes white = drawing.by_gpu();
    for (std::size_t i = 0; i + 3 < black.size(); i += 4)
      holes += black[i] != white[i] || black[i + 1] != white[i + 1] || black[i + 2] != white[i + 2] ? 1 : 0;
  }
  return holes;
}

struct Materials {
  std::vector<content::Material> all;
  std::vector<content::Image> images;
  std::vector<content::Texture> textures;
};

Materials opaque() { return {{content::Material{}}, {}, {}}; }

/// Opaque, double-sided, masked by a chequered image, blended: one each.
Materials mixed() {
  Materials out;
  out.all.resize(5);
  out.all[1].double_sided = true;
  out.all[1].base_color = {0.2f, 0.9f, 0.4f, 1.0f};
  out.all[2].alpha_mode = content::AlphaMode::mask;
  out.all[2].base_color_map.texture = 0;
  out.all[3].alpha_mode = content::AlphaMode::blend;
  out.all[3].base_color = {0.9f, 0.3f, 0.2f, 0.4f};
  out.all[4] = out.all[3];
  out.all[4].double_sided = true;
  content::Image image{"cheques", 4, 4, true, {}};
  for (int i = 0; i < 16; ++i) {
    const auto alpha = static_cast<std::uint8_t>((i + i / 4) % 2 ? 255 : 0);
    image.rgba.insert(image.rgba.end(), {250, 240, 90, alpha});
  }
  out.images.push_back(image);
  content::Texture texture;
  texture.image = 0;
  texture.nearest = true;
  texture.mipmaps = false;
  out.textures.push_back(texture);
  return out;
}

/// Seen from both sides, opaque and blended.
Materials two_sided() {
  Materials out = mixed();
  out.all = {out.all[1], out.all[4]};
  return out;
}

/// Random triangles, dealt to the materials in turn.
std::shared_ptr<const content::Scene> random_scene(unsigned seed, int triangles, float extent,
                                                   const Materials& materials) {
  auto scene = std::make_shared<content::Scene>();
  scene->materials = materials.all;
  scene->images = materials.images;
  scene->textures = materials.textures;
  const Soup soup = random_soup(seed, triangles, extent);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform;
  scene->geometry.vertices = soup.vertices;
  for (content::Vertex& vertex : scene->geometry.vertices) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    vertex.normal = glm::normalize(glm::vec3(x, y, z) - 0.4f);
    vertex.uv = {x, y};
    vertex.color = 0xff000000u | static_cast<std::uint32_t>(random() & 0xffffffu);
  }
  std::vector<std::vector<std::uint32_t>> dealt(materials.all.size());
  for (std::size_t i = 0; i < soup.indices.size(); ++i)
    dealt[i / 3 % dealt.size()].push_back(soup.indices[i]);
  content::make_clusters(scene->geometry, dealt, scene->materials);
  return scene;
}

std::shared_ptr<const content::Scene> load(const model::Content& content) {
  return content::load_scene(content, ".")->scene;
}

double psnr(const Bytes& a, const Bytes& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 4 == 3) continue;
    const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += difference * difference;
  }
  return sum == 0.0 ? 999.0 : 10.0 * std::log10(255.0 * 255.0 * 0.75 * static_cast<double>(a.size()) / sum);
}

/// Pairs of the list against those that there are.
void check_pairs(PieceDrawing& drawing, double most_replication) {
  drawing.by_gpu();
  const auto list = PieceDrawing::pairs();
  const std::set<std::array<std::uint32_t, 2>> listed(list.begin(), list.end());
  CHECK(listed.size() == list.size()); // none twice
  const auto exact = exact_pairs(drawing.scene(), drawing.camera(), drawing.set());
  long missing = 0;
  for (const auto& pair : exact) missing += listed.contains(pair) ? 0 : 1;
  MESSAGE("pairs there are " << exact.size() << ", in the list " << list.size());
  CHECK(exact.size() > 50);
  CHECK(missing == 0);
  CHECK(static_cast<double>(list.size()) <= most_replication * static_cast<double>(exact.size()));
}

} // namespace

TEST_CASE("the list holds every pair that there is, and hardly more") {
  for (const double degrees : {180.0, 260.0})
    for (const float extent : {0.05f, 0.5f, 4.0f}) {
      CAPTURE(degrees);
      CAPTURE(extent);
      PieceDrawing drawing(random_scene(11, 300, extent, opaque()), cells(model::Fisheye{{degrees}}), size);
      check_pairs(drawing, 1.05);
    }
}

TEST_CASE("the list of a city holds every pair that there is, and hardly more") {
  model::Camera camera;
  camera.position = {4.0, 9.0, 6.0};
  camera.orientation.yaw.degrees = 20.0;
  PieceDrawing drawing(load(model::City{}), cells(model::Fisheye{{180.0}}), size,
                       plan::camera_at(camera, 0.0));
  check_pairs(drawing, 1.05);
}

TEST_CASE("both engines draw the same, whatever the material and the style") {
  using enum model::StyleKind;
  for (const auto style : {textured, wireframe, hatching})
    for (const float extent : {0.4f, 3.0f}) {
      CAPTURE(static_cast<int>(style));
      CAPTURE(extent);
      PieceDrawing drawing(random_scene(3, 250, extent, mixed()), cells(model::Fisheye{{200.0}}), size, {},
                           style);
      // Hatching has steps of brightness, which rounding crosses here and there.
      CHECK(psnr(drawing.by_cpu(), drawing.by_gpu()) > (style == hatching ? 45.0 : 50.0));
    }
}

TEST_CASE("pieces that mirror show fronts and backs as they are") {
  plan::PieceSet set = cells(model::Fisheye{{200.0}});
  PieceDrawing straight(random_scene(3, 250, 2.0f, mixed()), set, size);
  for (plan::Corner& corner : set.corners) corner.screen.x = -corner.screen.x;
  plan::finish_triangles(set, {0, 0, size, size});
  PieceDrawing mirrored(random_scene(3, 250, 2.0f, mixed()), set, size);
  const Bytes wanted = straight.by_gpu(), drawn = mirrored.by_gpu();
  CHECK(psnr(mirrored.by_cpu(), drawn) > 50.0);
  Bytes turned(drawn.size());
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t x = 0; x < size; ++x)
      std::copy_n(drawn.begin() + static_cast<std::ptrdiff_t>((y * size + x) * 4), 4,
                  turned.begin() + static_cast<std::ptrdiff_t>((y * size + size - 1 - x) * 4));
  CHECK(psnr(wanted, turned) > 40.0); // centres on edges of triangles fall to the other side
}

TEST_CASE("a list that is too short is filled again and again, and nothing is missing") {
  const auto scene = random_scene(5, 400, 2.0f, mixed());
  const plan::PieceSet set = cells(model::Fisheye{{180.0}});
  PieceDrawing drawing(scene, set, size);
  const Bytes wanted = drawing.by_gpu();
  PieceDrawing tight(scene, set, size);
  for (int frame = 0; frame < 3; ++frame) CHECK(tight.by_gpu(1000) == wanted);
  CHECK(tight.counts.pairs > 3000);
  CHECK(tight.counts.bytes <= 2 * 8 * 1000);
  CHECK(tight.by_gpu() == wanted); // the ceiling is raised
}

TEST_CASE("what no list was made for is drawn in the same frame") {
  // Large triangles all over a few pieces: more pairs than a first guess allows for.
  const auto scene = random_scene(5, 500, 60.0f, two_sided());
  const plan::PieceSet set = cells(model::Fisheye{{180.0}}, 1.0);
  PieceDrawing drawing(scene, set, size);
  const Bytes first = drawing.by_gpu();
  const std::uint64_t room = drawing.counts.bytes / 8;
  static_cast<void>(drawing.by_gpu());
  CHECK(drawing.counts.pairs > room); // so the first frame had too little
  const Bytes second = drawing.by_gpu();
  CHECK(drawing.counts.bytes / 8 > room);
  CHECK(psnr(first, second) > 60.0);
  CHECK(psnr(first, drawing.by_cpu()) > 50.0);
}

TEST_CASE("nothing opens between pieces whose borders run through pixel centres") {
  CHECK(holes_in_room(leaky_cells()) == 0);
}

TEST_CASE("a grid of moved corners: no hole, also folded, and hardly a pair more than there must be") {
  for (const bool folded : {false, true}) {
    CAPTURE(folded);
    const plan::PieceSet set = moved_grid(folded);
    CHECK(holes_in_room(set) == 0);
    PieceDrawing drawing(random_scene(3, 250, 1.5f, mixed()), set, size);
    CHECK(psnr(drawing.by_cpu(), drawing.by_gpu()) > 50.0);
    PieceDrawing soup(random_scene(11, 300, 1.0f, opaque()), set, size);
    check_pairs(soup, 1.05);
  }
}

TEST_CASE("pieces reach over their borders by a sixty-fourth of a pixel") {
  const plan::PieceSet set = cells(model::Fisheye{{180.0}});
  for (std::size_t i = 0; i < set.pieces.size(); i += 37) {
    const glm::dvec3 shares = passes::overlap_shares(set, i, glm::dvec2(size));
    const glm::dmat3 from_screen = glm::inverse(set.pieces[i].to_screen);
    for (std::size_t border = 0; border < 3; ++border) {
      const auto corner = [&](std::size_t k) {
        return set.corners[set.triangles[i][(border + k) % 3]].screen;
      };
      const glm::dvec2 along = corner(2) - corner(1), middle = 0.5 * (corner(1) + corner(2));
      const glm::dvec2 outwards = glm::normalize(glm::dvec2(along.y, -along.x)) * 2.0 / double(size);
      const auto side = [&](double pixels) {
        const glm::dvec3 v = from_screen * glm::dvec3(middle + pixels * outwards, 1.0); // where w is 1
        return glm::dot(set.pieces[i].planes[border], v) + shares[static_cast<int>(border)];
      };
      CHECK(side(0.9 / 64.0) > 0.0);
      CHECK(side(1.1 / 64.0) < 0.0);
    }
  }
}
