// Points and lines by every method and engine: a sky of stars, circles of latitude and a meridian, and a
// floor of lines that run past the eye, with a wall that hides some of it.
#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/renderer/content/gltf_file.h"
#include "tests/support/drawing.h"

using namespace cupola;
using namespace cupola::tests;
using content::GltfFile;
using content::Json;

namespace {

class Sky {
public:
  model::Gltf write() {
    file_.add("materials", paint("floor", 0.2, 0.7, 0.3));
    file_.add("materials", paint("circles", 1.0, 0.5, 0.1));
    file_.add("materials", paint("stars", 1.0, 1.0, 1.0));
    file_.add("materials", paint("wall", 0.1, 0.15, 0.4));
    file_.json["extensionsUsed"] = {"KHR_materials_unlit"};
    floor();
    circles();
    stars();
    wall();
    model::Gltf gltf;
    gltf.file = file_.write("sky.gltf").string();
    gltf.point_size.degrees = 1.2;
    gltf.line_width.degrees = 0.8;
    return gltf;
  }

private:
  static Json paint(const char* name, double red, double green, double blue) {
    return {{"name", name},
            {"pbrMetallicRoughness", {{"baseColorFactor", {red, green, blue, 1.0}}}},
            {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
  }

  void show(const std::vector<float>& positions, int mode, int material,
            const std::vector<float>& colors = {}) {
    Json attributes{{"POSITION", file_.floats(positions, "VEC3")}};
    if (!colors.empty()) attributes["COLOR_0"] = file_.floats(colors, "VEC3");
    file_.show({{"attributes", attributes}, {"mode", mode}, {"material", material}});
  }

  void floor() { // mode 1, lines
    std::vector<float> ends;
    for (int i = -5; i <= 5; ++i) {
      const auto x = 8.0f * static_cast<float>(i);
      ends.insert(ends.end(), {x, -2, -40, x, -2, 40, -40, -2, x, 40, -2, x});
    }
    show(ends, 1, 0);
  }

  static void add(std::vector<float>& to, double longitude, double latitude, double radius) {
    to.push_back(static_cast<float>(radius * std::cos(latitude) * std::sin(longitude)));
    to.push_back(static_cast<float>(radius * std::sin(latitude)));
    to.push_back(static_cast<float>(radius * std::cos(latitude) * -std::cos(longitude)));
  }

  void circles() { // modes 2 and 3: loops, a strip from horizon to horizon
    for (const double latitude : {0.0, 0.5, 1.0}) {
      std::vector<float> places;
      for (int i = 0; i < 24; ++i) add(places, i * std::numbers::pi / 12.0, latitude, 100.0);
      show(places, 2, 1);
    }
    std::vector<float> places;
    for (int i = 0; i <= 12; ++i) add(places, 0.3, i * std::numbers::pi / 12.0, 100.0);
    show(places, 3, 1);
  }

  void stars() { // mode 0, of many colours and distances
    std::vector<float> places, colors;
    for (int i = 0; i < 400; ++i) {
      const double up = (i + 0.5) / 400.0, around = i * 2.399963;
      add(places, around, std::asin(up), 20.0 + 9000.0 * std::fmod(i * 0.618, 1.0));
      for (int c = 0; c < 3; ++c) colors.push_back(0.5f + 0.5f * static_cast<float>(std::sin(around + c)));
    }
    show(places, 0, 2, colors);
  }

  void wall() { show({-6, -2, -12, 10, -2, -12, 10, 6, -12, -6, -2, -12, 10, 6, -12, -6, 6, -12}, 4, 3); }

  GltfFile file_;
};

model::Show show_of(const model::Shape& shape, model::Method method) {
  static const model::Gltf sky = Sky().write();
  model::Projection projection;
  projection.shape = shape;
  projection.orientation = {{10.0}, {35.0}, {5.0}};
  model::Show show = make_show(sky, projection, method, 720, 540);
  show.camera.position = {0.5, 0.2, 1.0};
  show.scene.fog.density = 0.0;
  show.quality.samples = 4;
  return show;
}

} // namespace

TEST_CASE("points and lines are the same by every method and engine") {
  struct Case {
    std::string name;
    model::Shape shape;
  };
  const std::vector<Case> cases{{"fisheye", model::Fisheye{{180.0}}},
                                {"cylinder", model::Cylinder{{300.0}, {110.0}}},
                                {"equirectangular", model::Equirectangular{{360.0}, {180.0}}},
                                {"perspective", model::Perspective{{90.0}, std::nullopt}}};
  for (const Case& it : cases) {
    CAPTURE(it.name);
    model::Show show = show_of(it.shape, model::Method::reference);
    show.quality.samples = 16;
    const Shot traced = draw(show);
    show = show_of(it.shape, model::Method::piecewise);
    show.pieces.engine = model::Engine::cpu;
    const Shot cpu = draw(show);
    show.pieces.engine = model::Engine::gpu;
    const Shot gpu = draw(show);
    const Shot cubemap = draw(show_of(it.shape, model::Method::cubemap));
    MESSAGE(it.name << ": against rays, pieces " << psnr(cpu, traced) << " dB, cubemap "
                    << psnr(cubemap, traced) << " dB; between the engines " << psnr(cpu, gpu) << " dB");
    CHECK(psnr(cpu, gpu) > 50.0);
    CHECK(psnr(cpu, traced) > 30.0);
    CHECK(psnr(cubemap, traced) > 27.0);
    if (it.name == "fisheye")
      expect_image(cpu, "strokes/fisheye.png",
                   {4, 0.004, "rounding of the rasteriser, one or two steps apart between drivers"});
  }
}

TEST_CASE("points and lines keep their size when the eye moves away") {
  long before = 0;
  for (const double z : {1.0, 15.0, 30.0}) {
    model::Show show = show_of(model::Fisheye{{180.0}}, model::Method::piecewise);
    show.camera.position = {0.0, 60.0, z};
    show.projections["it"].orientation = {{0.0}, {-90.0}, {0.0}}; // down, upon the floor's lines
    show.quality.samples = 1;
    const Shot shot = draw(show);
    // Green of the floor: the length of its lines shrinks a little, their width does not.
    long green = 0;
    for (std::size_t i = 0; i < shot.rgba.size(); i += 4)
      if (shot.rgba[i + 1] > 150 && shot.rgba[i] < 150) ++green;
    MESSAGE(z << ": " << green);
    CHECK(green > 1000);
    if (before > 0) CHECK(std::abs(static_cast<double>(green) / static_cast<double>(before) - 1.0) < 0.15);
    before = green;
  }
}
