#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <random>

#include "renderer/plan/plan.h"

using namespace cupola;
using namespace cupola::plan;

namespace {

projection::Map map_of(const model::Shape& shape, double aspect, double pitch = 0.0, double yaw = 0.0) {
  model::Projection p;
  p.shape = shape;
  p.orientation = {{yaw}, {pitch}, {0}};
  return projection::make_map(p, aspect);
}

int seen_count(const CubemapPlan& plan) {
  int count = 0;
  for (const CubeFace& face : plan.faces) count += face.seen;
  return count;
}

/// Face and texel coordinates (not rounded) of a direction, written from GL's table of major axes.
struct Texel {
  std::size_t face;
  double x, y;
};
Texel texel_of(const glm::dvec3& d, int size) {
  const glm::dvec3 a = glm::abs(d);
  std::size_t face;
  double sc, tc, ma;
  if (a.x >= a.y && a.x >= a.z) {
    face = d.x > 0 ? 0 : 1;
    sc = d.x > 0 ? -d.z : d.z;
    tc = -d.y;
    ma = a.x;
  } else if (a.y >= a.z) {
    face = d.y > 0 ? 2 : 3;
    sc = d.x;
    tc = d.y > 0 ? d.z : -d.z;
    ma = a.y;
  } else {
    face = d.z > 0 ? 4 : 5;
    sc = d.z > 0 ? d.x : -d.x;
    tc = -d.y;
    ma = a.z;
  }
  return {face, (sc / ma + 1) / 2 * size, (tc / ma + 1) / 2 * size};
}

/// Every texel that bilinear reading of the pixel centres touches lies in a crop. Returns how many do not.
/// `waste`: the seen area over the area of boxes around what is touched.
long missed(const CubemapPlan& plan, const projection::Map& map, const PixelRect& rect,
            double* waste = nullptr) {
  long misses = 0;
  std::array<std::array<double, 4>, 6> touched;
  touched.fill({1e9, 1e9, -1e9, -1e9});
  const double h = 2.0 / plan.size;
  for (int y = 0; y < rect.height; ++y)
    for (int x = 0; x < rect.width; ++x) {
      const auto v = projection::ray(map, {-1 + 2 * (x + 0.5) / rect.width, 1 - 2 * (y + 0.5) / rect.height});
      if (!v) continue;
      const Texel at = texel_of(*v, plan.size);
      const glm::dmat3& axes = cube_face_axes()[at.face];
      const glm::dvec2 st(2 * at.x / plan.size - 1, 2 * at.y / plan.size - 1);
      // The four texel centres about it; those over an edge belong to another face.
      for (const double dy : {-0.5, 0.5})
        for (const double dx : {-0.5, 0.5}) {
          const double s = st.x + dx * h, t = st.y + dy * h;
          const Texel near = texel_of(axes[2] + s * axes[0] + t * axes[1], plan.size);
          const CubeFace& face = plan.faces[near.face];
          const bool in = face.seen && near.x >= face.crop.x && near.x <= face.crop.x + face.crop.width &&
                          near.y >= face.crop.y && near.y <= face.crop.y + face.crop.height;
          misses += !in;
          auto& box = touched[near.face];
          box = {std::min(box[0], near.x), std::min(box[1], near.y), std::max(box[2], near.x),
                 std::max(box[3], near.y)};
        }
    }
  if (waste) {
    double need = 0, have = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      if (touched[i][2] >= touched[i][0])
        need += (touched[i][2] - touched[i][0]) * (touched[i][3] - touched[i][1]);
      have += double(plan.faces[i].crop.width) * plan.faces[i].crop.height;
    }
    *waste = have / need;
  }
  return misses;
}

} // namespace

TEST_CASE("face axes agree with GL's table of major axes") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 d(normal(random), normal(random), normal(random));
    const Texel at = texel_of(d, 2);
    const glm::dmat3& axes = cube_face_axes()[at.face];
    const double ahead = glm::dot(axes[2], d);
    CHECK(ahead > 0);
    CHECK(glm::dot(axes[0], d) / ahead + 1 == doctest::Approx(at.x));
    CHECK(glm::dot(axes[1], d) / ahead + 1 == doctest::Approx(at.y));
  }
}

TEST_CASE("size: texels as large as pixels") {
  CHECK(make_cubemap(map_of(model::Cylinder{{360}, {134}}, 4.0 / 3), {0, 0, 1600, 1200}, {}).size == 512);
  CHECK(make_cubemap(map_of(model::Fisheye{{180}}, 1.0, 90), {0, 0, 2048, 2048}, {}).size == 1304);
  CHECK(make_cubemap(map_of(model::Perspective{{90}, {}}, 1.0), {0, 0, 1000, 1000}, {}).size == 1000);
  CHECK(make_cubemap(map_of(model::Equirectangular{{360}, {180}}, 2.0), {0, 0, 2048, 1024}, {}).size == 656);
  CHECK(make_cubemap(map_of(model::Cylinder{{360}, {134}}, 4.0 / 3), {0, 0, 1600, 1200}, 777).size == 777);
  CHECK(make_cubemap(map_of(model::Cylinder{{360}, {90}}, 4.0 / 3), {0, 0, 8, 6}, {}).size == 16);
  CHECK(make_cubemap(map_of(model::Perspective{{1}, {}}, 1.0), {0, 0, 4096, 4096}, {}).size == 8192);
}

TEST_CASE("faces seen: hand-worked") {
  const PixelRect rect{0, 0, 1600, 1200};
  CHECK(seen_count(make_cubemap(map_of(model::Cylinder{{360}, {134}}, 4.0 / 3), rect, 512)) == 6);
  CHECK(seen_count(make_cubemap(map_of(model::Cylinder{{360}, {66}}, 4.0 / 3), rect, 512)) == 4);
  const CubemapPlan flat = make_cubemap(map_of(model::Perspective{{80}, {}}, 4.0 / 3), rect, 512);
  CHECK(seen_count(flat) == 1);
  CHECK(flat.faces[5].seen);
  // tan 40° of the face's half width, and two texels about it.
  CHECK(flat.faces[5].crop.width == doctest::Approx(512 * std::tan(40 * 3.14159265 / 180)).epsilon(0.04));
  CHECK(flat.faces[5].crop.height ==
        doctest::Approx(512 * 0.75 * std::tan(40 * 3.14159265 / 180)).epsilon(0.04));
  const CubemapPlan right = make_cubemap(map_of(model::Perspective{{80}, {}}, 4.0 / 3, 0, -90), rect, 512);
  CHECK(seen_count(right) == 1);
  CHECK(right.faces[0].seen);
  // A dome: the zenith's face whole, the upper half of those around it.
  const CubemapPlan dome = make_cubemap(map_of(model::Fisheye{{180}}, 4.0 / 3, 90), rect, 512);
  CHECK(seen_count(dome) == 5);
  CHECK_FALSE(dome.faces[3].seen);
  CHECK(dome.faces[2].crop == PixelRect{0, 0, 512, 512});
  for (const std::size_t side : {0u, 1u, 4u, 5u}) {
    CHECK(dome.faces[side].crop.x == 0);
    CHECK(dome.faces[side].crop.y == 0);
    CHECK(dome.faces[side].crop.width == 512);
    CHECK(dome.faces[side].crop.height >= 256);
    CHECK(dome.faces[side].crop.height <= 262);
  }
}

TEST_CASE("what a picture reads is in the crops, with little waste") {
  std::mt19937 random(2);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double total = 0;
  const int rounds = 180;
  for (int i = 0; i < rounds; ++i) {
    model::Projection p;
    switch (i % 9) {
    case 0:
      p.shape = model::Perspective{{number(5, 170)}, {}};
      break;
    case 1:
      p.shape = model::Cylinder{{number(5, 360)}, {number(5, 170)}};
      break;
    case 2:
      p.shape = model::Fisheye{{number(5, 360)}};
      break;
    case 3:
      p.shape = model::Equirectangular{{number(5, 360)}, {number(5, 180)}};
      break;
    case 4:
      p.shape = model::Stereographic{{number(5, 350)}};
      break;
    case 5:
      p.shape = model::Orthographic{{number(5, 180)}};
      break;
    case 6:
      p.shape = model::Mercator{{number(5, 360)}, {number(5, 178)}};
      break;
    case 7:
      p.shape = model::Panini{{number(5, 250)}, {}, number(0.8, 1.2)};
      break;
    default:
      p.shape = model::CubeCross{};
      break;
    }
    p.zoom = std::exp(number(-2, 1));
    if (i % 3 == 0) p.off_axis = {number(-0.5, 0.5), number(-0.5, 0.5), number(-0.5, 0.5)};
    p.orientation = {{number(-180, 180)}, {number(-90, 90)}, {number(-180, 180)}};
    const PixelRect rect{0, 0, 40 + int(random() % 200), 40 + int(random() % 150)};
    const auto map = projection::make_map(p, double(rect.width) / rect.height);
    const CubemapPlan plan = make_cubemap(map, rect, 64 << (i % 5));
    CAPTURE(i);
    double waste = 0;
    CHECK(missed(plan, map, rect, &waste) == 0);
    total += waste;
  }
  CHECK(total / rounds < 1.35);
}

TEST_CASE("poles, rims and slivers are not missed") {
  for (const double yaw : {0.0, 45.0, 30.0})
    for (const double pitch : {0.0, 90.0, -45.0, 35.264}) {
      const PixelRect rect{0, 0, 501, 333};
      for (const model::Shape& shape :
           {model::Shape(model::Equirectangular{{360}, {180}}), model::Shape(model::Fisheye{{360}}),
            model::Shape(model::Fisheye{{90}}), model::Shape(model::Cylinder{{3}, {170}}),
            model::Shape(model::Equirectangular{{1}, {180}}), model::Shape(model::Perspective{{0.1}, {}})}) {
        const auto map = map_of(shape, 1.5, pitch, yaw);
        CHECK(missed(make_cubemap(map, rect, 256), map, rect) == 0);
      }
    }
}

TEST_CASE("extreme parameters end, with crops inside their faces") {
  for (const double zoom : {0.05, 1.0, 100.0})
    for (const double eye : {0.0, 0.94, -0.94})
      for (const int size : {16, 1000, 16384})
        for (const model::Shape& shape :
             {model::Shape(model::Perspective{{175}, model::Angle{175}}),
              model::Shape(model::Cylinder{{360}, {170}}), model::Shape(model::Fisheye{{360}}),
              model::Shape(model::Equirectangular{})}) {
          model::Projection p;
          p.shape = shape;
          p.zoom = zoom;
          p.off_axis.x = eye;
          const CubemapPlan plan = make_cubemap(projection::make_map(p, 2), {0, 0, 200, 100}, size);
          CHECK(seen_count(plan) >= 1);
          for (const CubeFace& face : plan.faces) {
            if (!face.seen) continue;
            CHECK(face.crop.x >= 0);
            CHECK(face.crop.y >= 0);
            CHECK(face.crop.width > 0);
            CHECK(face.crop.height > 0);
            CHECK(face.crop.x + face.crop.width <= size);
            CHECK(face.crop.y + face.crop.height <= size);
          }
        }
}
