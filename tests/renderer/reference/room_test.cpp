// The lettered room through every projection: each wall where it belongs, and no way out.
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

#include "renderer/content/mipmap.h"
#include "renderer/content/room.h"
#include "tests/renderer/reference/small_scene.h"

namespace cupola::reference {
namespace {

enum Wall { right, left, ceiling, floor, behind, ahead };

const Tracer& room() {
  static const Tracer tracer(std::make_shared<const content::Scene>(content::make_room(model::Room{})));
  return tracer;
}

/// Straight into the room's middle, light alike from everywhere, so that walls keep their colours' order.
Picture seen(const model::Projection& projection, int width, int height) {
  const Request asked = request(projection, width, height, 4);
  Picture picture(width, height, asked.background);
  room().render(asked, picture);
  return picture;
}

/// Which wall's colour a pixel has: the nearest in direction, as light may scale it.
int wall_at(const Picture& picture, int x, int y) {
  int best = -1;
  float best_cosine = 0.0f;
  const auto& walls = content::room_walls();
  for (int i = 0; i < 6; ++i) {
    glm::vec3 color;
    for (int c = 0; c < 3; ++c)
      color[c] =
          content::srgb_to_linear(walls[static_cast<std::size_t>(i)].color[static_cast<std::size_t>(c)]);
    const float cosine = glm::dot(glm::normalize(color), glm::normalize(glm::vec3(picture.at(x, y))));
    if (cosine > best_cosine) {
      best = i;
      best_cosine = cosine;
    }
  }
  return best;
}

/// The pixel that shows a direction.
int wall_towards(const Picture& picture, const model::Projection& projection, const glm::dvec3& direction) {
  const auto map = projection::make_map(projection, static_cast<double>(picture.width) / picture.height);
  const auto st = projection::image_point(map, direction);
  if (!st) return -1;
  const int x = static_cast<int>((st->x + 1.0) / 2.0 * picture.width);
  const int y = static_cast<int>((1.0 - st->y) / 2.0 * picture.height);
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return -1;
  return wall_at(picture, x, y);
}

} // namespace

// The letters stand in the middle of each wall: pixels are taken from above them, where v is about a tenth.

TEST_CASE("perspective") {
  const Picture picture =
      seen(perspective(120.0), 100, 100);    // the picture is 2 · tan 60° = 3.46 wide at depth 1
  CHECK(wall_at(picture, 50, 26) == ahead);  // 0.83 up
  CHECK(wall_at(picture, 50, 5) == ceiling); // 1.56 up
  CHECK(wall_at(picture, 50, 95) == floor);
  CHECK(wall_at(picture, 5, 25) == left); // 1.57 to the side, 0.87 up: 0.55 up on the wall
  CHECK(wall_at(picture, 95, 25) == right);
}

TEST_CASE("cylinder: the whole round, ahead in the middle, behind at both ends") {
  const Picture picture =
      seen(of(model::Cylinder{{360.0}, {120.0}}), 360, 200); // a pixel is a degree; top: 1.73 up
  const int high = 52;                                       // 0.83 up
  CHECK(wall_at(picture, 180, high) == ahead);
  CHECK(wall_at(picture, 270, high) == right);
  CHECK(wall_at(picture, 90, high) == left);
  CHECK(wall_at(picture, 0, high) == behind);
  CHECK(wall_at(picture, 359, high) == behind);
  CHECK(wall_at(picture, 180, 3) == ceiling);
  CHECK(wall_at(picture, 180, 197) == floor);
}

TEST_CASE("fisheye turned to the zenith: the dome's front at the bottom, right on the right") {
  model::Projection dome = of(model::Fisheye{{180.0}});
  dome.orientation.pitch.degrees = 90.0;
  const Picture picture = seen(dome, 180, 180);  // a pixel is a degree, the zenith in the middle
  CHECK(wall_at(picture, 90, 60) == ceiling);    // 30° from the zenith: past the letters
  CHECK(wall_at(picture, 90, 90 + 52) == ahead); // 38° high: 0.78 up
  CHECK(wall_at(picture, 90, 90 - 52) == behind);
  CHECK(wall_at(picture, 90 + 52, 90) == right);
  CHECK(wall_at(picture, 90 - 52, 90) == left);
  CHECK(picture.at(3, 3).a == 0.0f); // outside the circle
}

TEST_CASE("fisheye of 300° looking ahead sees the wall behind in its rim") {
  const Picture picture = seen(of(model::Fisheye{{300.0}}), 300, 300); // a pixel is a degree
  CHECK(wall_at(picture, 150, 150 - 38) == ahead);
  CHECK(wall_at(picture, 150, 10) == behind);
  CHECK(wall_at(picture, 150 + 85, 150 - 50) == right); // 99° from the axis, 0.59 up on the wall
}

TEST_CASE("equirectangular: zenith along the top, nadir along the bottom") {
  const Picture picture = seen(of(model::Equirectangular{{360.0}, {180.0}}), 360, 180); // a pixel is a degree
  const int high = 52;                                                                  // 38° high
  CHECK(wall_at(picture, 180, high) == ahead);
  CHECK(wall_at(picture, 270, high) == right);
  CHECK(wall_at(picture, 90, high) == left);
  CHECK(wall_at(picture, 1, high) == behind);
  for (const int x : {1, 180}) { // 60° high: 0.58 ahead of the zenith, or behind it
    CHECK(wall_at(picture, x, 30) == ceiling);
    CHECK(wall_at(picture, x, 150) == floor);
  }
  CHECK(wall_at(picture, 225, 45) == ceiling); // half right
  CHECK(wall_at(picture, 225, 135) == floor);
}

TEST_CASE("the image point of a direction shows the wall in that direction") {
  const double z = 0.8; // past the letters
  const std::array<std::pair<glm::dvec3, int>, 6> looks{{{{1, z, 0.1}, right},
                                                         {{-1, z, 0.1}, left},
                                                         {{0.1, 1, z}, ceiling},
                                                         {{0.1, -1, z}, floor},
                                                         {{0.1, z, 1}, behind},
                                                         {{0.1, z, -1}, ahead}}};
  model::Projection turned = of(model::Fisheye{{360.0}});
  turned.orientation = {{30.0}, {20.0}, {10.0}};
  model::Projection moved = of(model::Equirectangular{});
  moved.off_axis = {0.2, 0.1, -0.3};
  for (const model::Projection& projection : {turned, moved, of(model::Cylinder{{360.0}, {140.0}})}) {
    const Picture picture = seen(projection, 256, 256);
    for (const auto& look : looks) {
      const auto& direction = look.first;
      const int wall = look.second; // no structured binding: the macro below captures it
      const int found = wall_towards(picture, projection, direction);
      CAPTURE(projection.shape.index());
      CAPTURE(wall);
      CHECK((found == wall || found == -1));
    }
  }
}

TEST_CASE("a closed room has no hole in 100 views") {
  std::mt19937 random(7);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * (static_cast<double>(random()) / 4294967296.0);
  };
  const std::array<model::Projection, 4> projections{
      of(model::Perspective{{100.0}, std::nullopt}), of(model::Cylinder{{360.0}, {150.0}}),
      of(model::Fisheye{{360.0}}), of(model::Equirectangular{})};
  long shown = 0, holes = 0;
  for (int view = 0; view < 100; ++view) {
    const model::Projection& projection = projections[static_cast<std::size_t>(view % 4)];
    Request asked = request(projection, 97, 61, 2);
    asked.eye = {uniform(-4.9, 4.9), uniform(-4.9, 4.9), uniform(-4.9, 4.9)};
    asked.orientation =
        projection::rotation({{uniform(-180, 180)}, {uniform(-90, 90)}, {uniform(-180, 180)}});
    asked.near = 0.01;
    Picture picture(97, 61, asked.background);
    room().render(asked, picture);
    for (int y = 0; y < 61; ++y)
      for (int x = 0; x < 97; ++x) {
        double inside = 0.0;
        for (int i = 0; i < 2; ++i) {
          const glm::dvec2 at = glm::dvec2(x, y) + sample_position(i, 2);
          if (projection::ray(asked.map, {2.0 * at.x / 97 - 1.0, 1.0 - 2.0 * at.y / 61})) inside += 0.5;
        }
        if (inside > 0.0) ++shown;
        if (picture.at(x, y).a != static_cast<float>(inside)) ++holes;
      }
  }
  CHECK(holes == 0);
  CHECK(shown > 400'000);
}

} // namespace cupola::reference
