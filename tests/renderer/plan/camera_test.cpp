#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "renderer/plan/camera.h"

using namespace cupola;
using plan::camera_at;

namespace {

double distance(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }
glm::dvec3 ahead(const plan::CameraPose& pose) { return pose.orientation * glm::dvec3(0, 0, -1); }
glm::dvec3 up(const plan::CameraPose& pose) { return pose.orientation * glm::dvec3(0, 1, 0); }

model::Keyframe key(double time, glm::dvec3 position, double yaw = 0.0) {
  model::Keyframe k;
  k.time = time;
  k.position = position;
  k.orientation.yaw.degrees = yaw;
  return k;
}

bool proper(const plan::CameraPose& pose) {
  const glm::dmat3 product = pose.orientation * glm::transpose(pose.orientation);
  double worst = std::abs(glm::determinant(pose.orientation) - 1.0);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) worst = std::max(worst, std::abs(product[c][r] - (c == r ? 1.0 : 0.0)));
  return worst < 1e-12 && std::isfinite(glm::length(pose.position));
}

} // namespace

TEST_CASE("a camera without a path stands still") {
  model::Camera camera;
  camera.position = {1, 2, 3};
  camera.orientation.yaw.degrees = 90;
  for (const double time : {-5.0, 0.0, 1e9}) {
    CHECK(camera_at(camera, time).position == glm::dvec3(1, 2, 3));
    CHECK(distance(ahead(camera_at(camera, time)), {-1, 0, 0}) == 0.0); // yaw turns to the left
  }
}

TEST_CASE("look_to and up give the axes") {
  model::Camera camera;
  camera.look_to = glm::dvec3(5, 0, 0);
  CHECK(distance(ahead(camera_at(camera, 0)), {1, 0, 0}) < 1e-15);
  CHECK(distance(up(camera_at(camera, 0)), {0, 1, 0}) < 1e-15);
  CHECK(distance(camera_at(camera, 0).orientation * glm::dvec3(1, 0, 0), {0, 0, 1}) < 1e-15);
  camera.look_to = glm::dvec3(0, -2, 0);
  camera.up = {0, 0, -1};
  CHECK(distance(ahead(camera_at(camera, 0)), {0, -1, 0}) < 1e-15);
  CHECK(distance(up(camera_at(camera, 0)), {0, 0, -1}) < 1e-15);
}

TEST_CASE("directions that say nothing still give an orientation") {
  model::Camera camera;
  for (const glm::dvec3 look : {glm::dvec3(0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(1e-300)})
    for (const glm::dvec3 upwards : {glm::dvec3(0), glm::dvec3(0, 1, 0), glm::dvec3(0, -3, 0)}) {
      camera.look_to = look;
      camera.up = upwards;
      CHECK(proper(camera_at(camera, 0)));
    }
}

TEST_CASE("a path passes through its key frames and is smooth there") {
  model::Camera camera;
  camera.loop = false;
  camera.path = {key(1, {0, 0, 0}), key(2, {1, 0, 0}, 30), key(4, {1, 2, 0}, 60), key(5, {4, 4, 4}, -10)};
  for (const auto& k : camera.path) {
    CHECK(distance(camera_at(camera, k.time).position, k.position) < 1e-14);
    const glm::dvec3 wanted(-std::sin(k.orientation.yaw.radians()), 0,
                            -std::cos(k.orientation.yaw.radians()));
    CHECK(distance(ahead(camera_at(camera, k.time)), wanted) < 1e-12);
  }
  const double h = 1e-6; // one-sided speeds agree to first order
  for (const double time : {2.0, 4.0}) {
    const auto at = [&](double t) { return camera_at(camera, t).position; };
    CHECK(distance((at(time) - at(time - h)) / h, (at(time + h) - at(time)) / h) < 1e-4);
  }
}

TEST_CASE("equal steps in time give the uniform Catmull-Rom curve") {
  model::Camera camera;
  camera.loop = false;
  camera.path = {key(0, {0, 0, 0}), key(1, {1, 0, 0}), key(2, {2, 1, 0}), key(3, {3, 3, 0})};
  // Half way: (-p0 + 9 p1 + 9 p2 - p3) / 16.
  const glm::dvec3 wanted =
      (9.0 * glm::dvec3(1, 0, 0) + 9.0 * glm::dvec3(2, 1, 0) - glm::dvec3(3, 3, 0)) / 16.0;
  CHECK(distance(camera_at(camera, 1.5).position, wanted) < 1e-15);
}

TEST_CASE("turns go the short way round") {
  model::Camera camera;
  camera.path = {key(0, {}, 170), key(1, {}, -170)};
  CHECK(distance(ahead(camera_at(camera, 0.5)), {0, 0, 1}) < 1e-12);
  camera.path = {key(0, {}, 10), key(1, {}, 50)};
  CHECK(distance(ahead(camera_at(camera, 0.5)), {-0.5, 0, -std::sqrt(0.75)}) < 1e-12);
}

TEST_CASE("without a loop the ends are held, with one the path starts again") {
  model::Camera camera;
  camera.path = {key(1, {1, 0, 0}), key(3, {5, 0, 0})};
  camera.loop = false;
  CHECK(camera_at(camera, -1).position == glm::dvec3(1, 0, 0));
  CHECK(camera_at(camera, 0.5).position == glm::dvec3(1, 0, 0));
  CHECK(camera_at(camera, 7).position == glm::dvec3(5, 0, 0));
  camera.loop = true;
  CHECK(camera_at(camera, 3.5).position == glm::dvec3(1, 0, 0)); // held again before the first
  CHECK(distance(camera_at(camera, 5).position, {3, 0, 0}) < 1e-14);
  CHECK(distance(camera_at(camera, -1).position, {3, 0, 0}) < 1e-14);
}

TEST_CASE("a path that closes is smooth across its join") {
  model::Camera camera;
  camera.path = {key(0, {0, 0, 0}), key(1, {1, 0, 0}), key(3, {1, 1, 0}), key(4, {0, 0, 0})};
  const double h = 1e-6;
  const auto at = [&](double t) { return camera_at(camera, t).position; };
  CHECK(distance((at(4 - h) - at(4 - 2 * h)) / h, (at(4 + 2 * h) - at(4 + h)) / h) < 1e-4);
}

TEST_CASE("no time gives NaN") {
  model::Camera camera;
  camera.path = {key(0, {1, 2, 3})};
  for (int keys = 1; keys < 4; ++keys) {
    for (const double time : {0.0, -0.0, 1e308, -1e308, std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()})
      for (const bool loop : {false, true}) {
        camera.loop = loop;
        CHECK(proper(camera_at(camera, time)));
      }
    camera.path.push_back(key(keys * 2.5, {keys, 0, 1}, 180.0 * keys));
  }
}
