#include "renderer/plan/camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

#include "renderer/projection/map.h"

namespace cupola::plan {

namespace {

using Path = std::vector<model::Keyframe>;

/// View axes that look to a direction: columns right, up, back. A direction without length looks ahead; an
/// `up` that gives no side is replaced by the axis farthest from the direction.
glm::dmat3 looking(const glm::dvec3& look_to, const glm::dvec3& up) {
  const double distance = glm::length(look_to);
  if (!(distance > 0.0) || !std::isfinite(distance)) return glm::dmat3(1.0);
  const glm::dvec3 back = -look_to / distance;
  glm::dvec3 right = glm::cross(up, back);
  if (!(glm::length(right) > 1e-9 * glm::length(up)))
    right = glm::cross(std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), back);
  right = glm::normalize(right);
  return {right, glm::cross(back, right), back};
}

glm::dmat3 axes(const model::Orientation& orientation, const std::optional<glm::dvec3>& look_to,
                const glm::dvec3& up) {
  return look_to ? looking(*look_to, up) : projection::rotation(orientation);
}

/// Metres per second at a key frame: through its neighbours [Catmull–Rom, for unequal steps in time]. On a
/// path that closes, the neighbours of both ends lie across the join.
glm::dvec3 velocity(const Path& path, std::size_t i, bool closed) {
  const std::size_t last = path.size() - 1;
  if (closed && (i == 0 || i == last)) {
    const double before = path[last].time - path[last - 1].time, after = path[1].time - path[0].time;
    return (path[1].position - path[last - 1].position) / (before + after);
  }
  const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, last);
  return (path[b].position - path[a].position) / (path[b].time - path[a].time);
}

/// Show time to time on the path. A loop lasts from 0 to the last key frame.
double path_time(const model::Camera& camera, double time) {
  const double end = camera.path.back().time;
  if (!std::isfinite(time)) return camera.path.front().time;
  if (!camera.loop || !(end > 0.0)) return time;
  const double within = std::fmod(time, end);
  return within < 0.0 ? within + end : within;
}

CameraPose pose_of(const model::Camera& camera, const model::Keyframe& key) {
  return {key.position, axes(key.orientation, key.look_to, camera.up)};
}

CameraPose between(const model::Camera& camera, std::size_t i, double time) {
  const Path& path = camera.path;
  const model::Keyframe &a = path[i], &b = path[i + 1];
  const double step = b.time - a.time, u = (time - a.time) / step, u2 = u * u, u3 = u2 * u;
  const bool closed = camera.loop && path.size() > 2 && path.front().time == 0.0 &&
                      path.front().position == path.back().position;
  CameraPose out;
  out.position = (2 * u3 - 3 * u2 + 1) * a.position + (u3 - 2 * u2 + u) * step * velocity(path, i, closed) +
                 (3 * u2 - 2 * u3) * b.position + (u3 - u2) * step * velocity(path, i + 1, closed);
  const glm::dquat from = glm::quat_cast(pose_of(camera, a).orientation);
  const glm::dquat to = glm::quat_cast(pose_of(camera, b).orientation);
  out.orientation = glm::mat3_cast(glm::normalize(glm::slerp(from, to, u)));
  return out;
}

} // namespace

CameraPose camera_at(const model::Camera& camera, double time) {
  const Path& path = camera.path;
  if (path.empty()) return {camera.position, axes(camera.orientation, camera.look_to, camera.up)};
  const double t = path_time(camera, time);
  if (t <= path.front().time) return pose_of(camera, path.front());
  if (t >= path.back().time) return pose_of(camera, path.back());
  const auto next = std::upper_bound(
      path.begin(), path.end(), t, [](double value, const model::Keyframe& key) { return value < key.time; });
  return between(camera, static_cast<std::size_t>(next - path.begin()) - 1, t);
}

} // namespace cupola::plan
