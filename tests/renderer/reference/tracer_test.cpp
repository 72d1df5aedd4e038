#include "renderer/reference/tracer.h"

#include <array>
#include <atomic>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <thread>

#include "tests/renderer/reference/small_scene.h"

namespace cupola::reference {
namespace {

constexpr glm::vec4 red{0.8f, 0.1f, 0.0f, 1.0f}, blue{0.0f, 0.2f, 0.6f, 1.0f};

void check_color(const glm::vec4& got, const glm::vec3& wanted, float tolerance = 1e-5f) {
  for (int c = 0; c < 3; ++c) CHECK(std::abs(got[c] - wanted[c]) <= tolerance);
}

/// A perspective of 90°: at depth 1 the picture is 2 wide.
Request square(int size, int samples = 1) { return request(perspective(90.0), size, size, samples); }

} // namespace

TEST_CASE("samples: one is the centre, 64 fill an 8 by 8 grid and 64 columns and rows") {
  CHECK(sample_position(0, 1) == glm::dvec2(0.5, 0.5));
  std::array<int, 64> cells{}, columns{}, rows{};
  glm::dvec2 mean(0.0);
  for (int i = 0; i < 64; ++i) {
    const glm::dvec2 at = sample_position(i, 64);
    mean += at / 64.0;
    ++cells[static_cast<std::size_t>(static_cast<int>(at.x * 8) + 8 * static_cast<int>(at.y * 8))];
    ++columns[static_cast<std::size_t>(at.x * 64)];
    ++rows[static_cast<std::size_t>(at.y * 64)];
  }
  for (std::size_t i = 0; i < 64; ++i) {
    CHECK(cells[i] == 1);
    CHECK(columns[i] == 1);
    CHECK(rows[i] == 1);
  }
  CHECK(mean.x == doctest::Approx(0.5));
  CHECK(mean.y == doctest::Approx(0.5));
  for (int count : {2, 3, 5, 9, 100})
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 at = sample_position(i, count);
      CHECK((at.x >= 0.0 && at.x < 1.0 && at.y >= 0.0 && at.y < 1.0));
    }
}

TEST_CASE("a wall shows its colour, the rest the background, and an edge its share of the pixel") {
  SmallScene scene;
  // At depth 2 a picture of 8 pixels is 4 wide. The wall ends at x = 0.75: 1.5 pixels right of the middle.
  scene.quad(scene.plain(red), {glm::vec3{-9, -9, -2}, {0.75, -9, -2}, {0.75, 9, -2}, {-9, 9, -2}});
  Request asked = square(8, 64);
  asked.background = {0.0, 0.5, 0.25};
  const Picture picture = render(scene, asked);
  check_color(picture.at(0, 0), red);
  CHECK(picture.at(0, 0).a == 1.0f);
  check_color(picture.at(7, 3), {0.0f, 0.5f, 0.25f});
  CHECK(picture.at(7, 3).a == 0.0f);
  check_color(picture.at(5, 3),
              0.5f * glm::vec3(red) + 0.5f * glm::vec3(0.0f, 0.5f, 0.25f)); // averaged in linear light
  CHECK(picture.at(5, 3).a == 0.5f);
}

TEST_CASE("a grey wall lit straight on") {
  // Sun, eye and normal agree: Fresnel's term is 0.04, the distribution 1, masking 1/4 at roughness 1, so
  // that (1 - 0.04) · 0.5 + 0.04 / 4 = 0.49 of the sunlight comes back.
  SmallScene scene;
  content::Material grey;
  grey.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  scene.wall(scene.material(grey), -3.0f);
  Request asked = square(9);
  asked.scene.sun = {{180.0}, {0.0}, {1.0, 0.5, 0.25}, 1.2}; // shines along -z
  asked.scene.sky.intensity = 0.0;
  check_color(render(scene, asked).at(4, 4), 0.49f * 1.2f * glm::vec3(1.0f, 0.5f, 0.25f));

  asked.scene.sun.azimuth.degrees = 0.0; // behind the wall
  check_color(render(scene, asked).at(4, 4), glm::vec3(0.0f));

  // A lamp of 2 candela one metre before the wall, two metres before the eye.
  content::Light lamp;
  lamp.kind = content::LightKind::point;
  lamp.position = {0, 0, -2};
  lamp.radiance = glm::vec3(2.0f);
  scene.scene.lights.push_back(lamp);
  check_color(render(scene, asked).at(4, 4), glm::vec3(0.49f * 2.0f / 3.14159265f));
}

TEST_CASE("fog swallows by distance, not by depth; what is fogless stays") {
  SmallScene scene;
  scene.wall(scene.plain(red), -5.0f);
  Request asked = square(2);
  asked.scene.fog = {0.1, {0.3, 0.4, 0.5}};
  const double distance = 5.0 * std::sqrt(1.0 + 2.0 * 0.25); // pixel centres at ±0.5, ±0.5 of depth 1
  const auto clear = static_cast<float>(std::exp(-0.1 * distance));
  check_color(render(scene, asked).at(0, 1),
              glm::vec3(red) * clear + glm::vec3(0.3f, 0.4f, 0.5f) * (1.0f - clear));
  scene.scene.materials[0].fogless = true;
  check_color(render(scene, asked).at(0, 1), red);
}

TEST_CASE("what is nearer than near is not drawn: by depth in a perspective, by distance from the axis on a "
          "cylinder") {
  SmallScene scene;
  scene.wall(scene.plain(red), -1.0f);
  scene.wall(scene.plain(blue), -4.0f);
  Request asked = square(16);
  asked.near = 0.99;
  check_color(render(scene, asked).at(8, 8), red);
  asked.near = 1.01; // the corners of the red wall are 1.7 away, but not in depth
  for (const glm::vec4& pixel : render(scene, asked).pixels) check_color(pixel, blue);

  Request cylinder = request(of(model::Cylinder{{80.0}, {80.0}}), 16, 16);
  cylinder.near = 1.1; // cos 24.6° = 1 / 1.1: beyond this angle the red wall is far enough from the axis
  const Picture picture = render(scene, cylinder);
  check_color(picture.at(8, 8), blue);
  check_color(picture.at(8, 0), blue);  // high up, but straight ahead
  check_color(picture.at(13, 8), red);  // 27.5°
  check_color(picture.at(12, 8), blue); // 22.5°
}

TEST_CASE(
    "backs of single-sided materials are not there; double-sided ones are lit from the side that is seen") {
  SmallScene scene;
  const std::array<glm::vec3, 4> turned{
      glm::vec3{9, -9, -2}, {-9, -9, -2}, {-9, 9, -2}, {9, 9, -2}}; // faces -z
  scene.quad(scene.plain(red), turned);
  scene.wall(scene.plain(blue), -3.0f);
  check_color(render(scene, square(3)).at(1, 1), blue);
  scene.scene.materials[0].double_sided = true;
  check_color(render(scene, square(3)).at(1, 1), red);

  scene.scene.materials[0].unlit = false;
  Request asked = square(3);
  asked.scene.sun = {{180.0}, {0.0}, {1.0, 1.0, 1.0}, 1.0}; // from behind the eye, onto the back
  asked.scene.sky.intensity = 0.0;
  CHECK(render(scene, asked).at(1, 1).r > 0.5f);
}

TEST_CASE("mask cuts out by the texture's alpha, blend lays over what is behind") {
  SmallScene scene;
  content::Material leaf;
  leaf.unlit = true;
  leaf.alpha_mode = content::AlphaMode::mask;
  leaf.alpha_cutoff = 0.5f;
  leaf.base_color_map.texture = scene.texture(2, 1, {255, 255, 255, 200, 255, 255, 255, 100}, false);
  scene.scene.textures[0].mipmaps = false;
  scene.scene.textures[0].nearest = true;
  scene.wall(scene.material(leaf), -1.0f, 1.0f);
  scene.wall(scene.plain(blue), -4.0f);
  const Picture masked = render(scene, square(4));
  check_color(masked.at(0, 1), glm::vec3(1.0f)); // 200 / 255 is kept, and fully opaque
  check_color(masked.at(3, 1), blue);            // 100 / 255 is cut out

  scene.scene.materials[0].alpha_mode = content::AlphaMode::blend;
  const Picture blended = render(scene, square(4));
  const float cover = 100.0f / 255.0f;
  check_color(blended.at(3, 1), cover * glm::vec3(1.0f) + (1.0f - cover) * glm::vec3(blue));
  CHECK(blended.at(3, 1).a == 1.0f);
}

TEST_CASE("blended surfaces in one plane and behind each other all count") {
  SmallScene scene;
  const int glass = scene.plain({1.0f, 0.0f, 0.0f, 0.5f}, content::AlphaMode::blend);
  const int green = scene.plain({0.0f, 1.0f, 0.0f, 0.25f}, content::AlphaMode::blend);
  scene.wall(glass, -2.0f);
  scene.wall(glass, -2.0f);
  scene.wall(green, -3.0f);
  Request asked = square(2);
  asked.background = {0.0, 0.0, 1.0};
  const glm::vec4 pixel = render(scene, asked).at(0, 0);
  // 1/2 red, then half of the rest, then a quarter of the rest green, then the background.
  check_color(pixel, {0.75f, 0.25f * 0.25f, 0.25f * 0.75f});
  CHECK(pixel.a == doctest::Approx(1.0f - 0.25f * 0.75f));
}

TEST_CASE("a viewport fills its rectangle, upright, and leaves the rest alone") {
  SmallScene scene;
  scene.quad(scene.plain(red),
             {glm::vec3{-9, 0, -2}, {9, 0, -2}, {9, 9, -2}, {-9, 9, -2}}); // above the horizon
  scene.quad(scene.plain(blue), {glm::vec3{-9, -9, -2}, {0, -9, -2}, {0, 0, -2}, {-9, 0, -2}}); // lower left
  Request asked = square(4);
  asked.rect = {3, 2, 4, 4};
  Picture picture(10, 8, {0.1, 0.1, 0.1});
  const Tracer tracer(scene.share());
  CHECK(tracer.render(asked, picture));
  check_color(picture.at(3, 2), red); // row 0 is the top
  check_color(picture.at(6, 3), red);
  check_color(picture.at(3, 5), blue); // and the left is the left
  CHECK(picture.at(6, 5).a == 0.0f);
  check_color(picture.at(6, 5), glm::vec3(0.0f)); // the request's background
  check_color(picture.at(2, 2), glm::vec3(0.1f));
  check_color(picture.at(7, 4), glm::vec3(0.1f));
  check_color(picture.at(4, 6), glm::vec3(0.1f));
}

TEST_CASE("a window is traced as it is in the whole picture, the rest of which stays") {
  SmallScene scene;
  scene.quad(scene.plain(red), {glm::vec3{-9, -9, -2}, {0.75, -9, -2}, {0.75, 9, -2}, {-9, 9, -2}});
  Request asked = square(32, 4);
  const Picture whole = render(scene, asked);
  for (const Rect window : {Rect{17, 3, 6, 20}, Rect{-5, 20, 90, 90}, Rect{40, 40, 5, 5}}) {
    asked.window = window;
    const Picture part = render(scene, asked);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const bool inside =
            x >= window.x && x < window.x + window.width && y >= window.y && y < window.y + window.height;
        CHECK(part.at(x, y) == (inside ? whole.at(x, y) : glm::vec4(0.0f)));
      }
  }
}

TEST_CASE("outside a fisheye's circle the picture stays as it was; on its rim it counts by its share") {
  SmallScene scene;
  const int material = scene.plain(red, content::AlphaMode::opaque, true);
  for (const float z : {-10.0f, 10.0f}) scene.wall(material, z, 1e5f);
  Request asked = request(of(model::Fisheye{{180.0}}), 40, 20, 16); // the circle has radius 10 about (20, 10)
  Picture picture(40, 20, {0.0, 0.0, 0.5});
  const Tracer tracer(scene.share());
  tracer.render(asked, picture);
  check_color(picture.at(20, 10), red);
  check_color(picture.at(11, 10), red);
  check_color(picture.at(8, 10), {0.0f, 0.0f, 0.5f});
  CHECK(picture.at(8, 10).a == 0.0f);
  double covered = 0.0;
  for (const glm::vec4& pixel : picture.pixels) covered += pixel.a;
  CHECK(covered == doctest::Approx(3.14159265 * 100.0).epsilon(0.01)); // the circle's area in pixels
}

TEST_CASE("the picture is the same for any number of threads") {
  SmallScene scene;
  content::Material checks;
  checks.base_color_map.texture =
      scene.texture(2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}, true);
  scene.quad(scene.material(checks), {glm::vec3{-50, -1, 50}, {50, -1, 50}, {50, -1, -50}, {-50, -1, -50}},
             40, 40);
  Request asked = request(of(model::Cylinder{{360.0}, {100.0}}), 150, 70, 8);
  std::array<Picture, 3> pictures;
  const Tracer tracer(scene.share());
  for (std::size_t i = 0; i < 3; ++i) {
    asked.threads = static_cast<int>(i * i + 1); // 1, 2, 5
    pictures[i] = Picture(150, 70, asked.background);
    CHECK(tracer.render(asked, pictures[i]));
  }
  CHECK(pictures[0].pixels == pictures[1].pixels);
  CHECK(pictures[0].pixels == pictures[2].pixels);
  CHECK(pictures[0].at(75, 60).a == 1.0f);
}

TEST_CASE("progress rises to 1; a cancelled render says so and stops") {
  SmallScene scene;
  scene.wall(scene.plain(red), -1.0f);
  Request asked = square(64);
  double last = 0.0;
  bool rising = true;
  asked.progress = [&](double share) {
    rising = rising && share > last;
    last = share;
  };
  const Tracer tracer(scene.share());
  Picture picture(64, 64, asked.background);
  CHECK(tracer.render(asked, picture));
  CHECK(rising);
  CHECK(last == 1.0);

  const std::atomic<bool> cancel{true};
  asked.cancel = &cancel;
  Picture untouched(64, 64, asked.background);
  CHECK_FALSE(tracer.render(asked, untouched));
  for (const glm::vec4& pixel : untouched.pixels) CHECK(pixel.a == 0.0f);
}

TEST_CASE("a pose moves the vertices that move, and the lights") {
  SmallScene scene;
  scene.wall(scene.plain(blue), -4.0f);
  scene.wall(scene.plain(red), -2.0f, 0.5f);
  scene.scene.static_vertices = 4;
  Tracer tracer(scene.share());
  Request asked = square(8);
  Picture picture(8, 8, asked.background);
  tracer.render(asked, picture);
  check_color(picture.at(4, 4), red);
  check_color(picture.at(6, 4), blue);

  content::Pose pose;
  pose.vertices.assign(scene.scene.geometry.vertices.begin() + 4, scene.scene.geometry.vertices.end());
  for (content::Vertex& vertex : pose.vertices) vertex.position.x += 1.0f; // two pixels to the right
  tracer.move(pose);
  tracer.render(asked, picture);
  check_color(picture.at(3, 4), blue);
  check_color(picture.at(6, 4), red);
}

TEST_CASE("a mesh without normals is lit by its faces; a texture without pixels is white") {
  SmallScene scene;
  content::Material grey;
  grey.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  grey.base_color_map.texture = scene.texture(0, 0, {}, true);
  scene.wall(scene.material(grey), -3.0f);
  for (content::Vertex& vertex : scene.scene.geometry.vertices) vertex.normal = glm::vec3(0.0f);
  Request asked = square(5);
  asked.scene.sun = {{180.0}, {0.0}, {1.0, 1.0, 1.0}, 1.0};
  asked.scene.sky.intensity = 0.0;
  check_color(render(scene, asked).at(2, 2), glm::vec3(0.49f));
}

TEST_CASE("a scene without a triangle is all background") {
  Request asked = square(4);
  asked.background = {0.1, 0.2, 0.3};
  const Picture picture = render(SmallScene{}, asked);
  for (const glm::vec4& pixel : picture.pixels) {
    check_color(pixel, {0.1f, 0.2f, 0.3f});
    CHECK(pixel.a == 0.0f);
  }
}

TEST_CASE("the encoding is that of displays") {
  Picture picture(1, 1, {0.0, 0.0, 0.0});
  picture.at(0, 0) = {0.2158605f, -1.0f, 7.0f, 0.5f};
  CHECK(encoded(picture) == std::vector<std::uint8_t>{128, 0, 255, 128});
  picture.at(0, 0) = {std::nanf(""), 0.0031308f, 1.0f, 2.0f};
  CHECK(encoded(picture) == std::vector<std::uint8_t>{0, 10, 255, 255});
}

} // namespace cupola::reference
