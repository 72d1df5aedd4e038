#include "renderer/content/strokes.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <numbers>

namespace cupola::content {
namespace {

/// Any direction across `direction`, the same for the same one.
glm::vec3 across(const glm::vec3& direction) {
  const glm::vec3 axis =
      std::abs(direction.y) < 0.9f * glm::length(direction) ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  return glm::normalize(glm::cross(direction, axis));
}

Vertex between(const Vertex& a, const Vertex& b, float t) {
  Vertex made;
  made.position = a.position + (b.position - a.position) * t;
  const glm::vec3 normal = a.normal + (b.normal - a.normal) * t;
  made.normal = glm::dot(normal, normal) > 0.0f ? glm::normalize(normal) : a.normal;
  made.uv = a.uv + (b.uv - a.uv) * t;
  made.color =
      a.color == b.color
          ? a.color
          : glm::packUnorm4x8(glm::unpackUnorm4x8(a.color) * (1.0f - t) + glm::unpackUnorm4x8(b.color) * t);
  return made;
}

/// A line as seen from the eye, which is the origin.
struct Sight {
  float distance_a, distance_b;
  glm::vec3 toward_a, toward_b; ///< unit length
  float angle;                  ///< between them
  glm::vec3 side;               ///< unit length, across the plane of eye and line; from a to b turns about it
};

Sight look_at(const glm::vec3& a, const glm::vec3& b) {
  Sight sight{glm::length(a), glm::length(b), {0, 0, -1}, {0, 0, -1}, 0.0f, {1, 0, 0}};
  if (sight.distance_a == 0.0f && sight.distance_b == 0.0f) return sight;
  sight.toward_a = sight.distance_a > 0.0f ? a / sight.distance_a : b / sight.distance_b;
  sight.toward_b = sight.distance_b > 0.0f ? b / sight.distance_b : sight.toward_a;
  const glm::vec3 turn = glm::cross(sight.toward_a, sight.toward_b);
  const float sine = glm::length(turn);
  sight.angle = std::atan2(sine, glm::dot(sight.toward_a, sight.toward_b));
  sight.side = sine > 1e-6f ? turn / sine : across(sight.toward_a);
  return sight;
}

/// Where on the line (0 at a, 1 at b) the eye looks after `share` of the angle.
float place_on_line(const Sight& sight, float share) {
  // The law of sines in the two triangles that the ray cuts the large one into.
  const bool narrow = sight.angle < 1e-3f;
  const float from_a = sight.distance_a * (narrow ? share : std::sin(share * sight.angle));
  const float from_b = sight.distance_b * (narrow ? 1.0f - share : std::sin((1.0f - share) * sight.angle));
  return from_a + from_b > 0.0f ? from_a / (from_a + from_b) : share;
}

} // namespace

std::vector<std::uint32_t> stroke_corners(Form form, std::size_t count) {
  std::vector<std::uint32_t> corners;
  corners.reserve(count * stroke_triangles(form) * 3);
  for (std::size_t stroke = 0; stroke < count; ++stroke) {
    const auto first = static_cast<std::uint32_t>(stroke * stroke_vertices(form));
    if (form == Form::points) {
      for (std::uint32_t i = 1; i + 1 < disc_corners; ++i)
        corners.insert(corners.end(), {first, first + i, first + i + 1});
      continue;
    }
    for (std::uint32_t i = 0; i < ribbon_sections; ++i) {
      const std::uint32_t low = first + 2 * i;
      corners.insert(corners.end(), {low, low + 2, low + 3, low, low + 3, low + 1});
    }
  }
  return corners;
}

void place_point(const Vertex& at, const glm::vec3& eye, float diameter, Vertex* out) {
  static const std::array<glm::vec2, disc_corners> directions = [] {
    // An octagon of radius r covers 2 sqrt(2) r².
    const double radius = std::sqrt(std::numbers::pi / (2.0 * std::numbers::sqrt2));
    std::array<glm::vec2, disc_corners> made{};
    for (std::size_t i = 0; i < disc_corners; ++i) {
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / disc_corners;
      made[i] = {radius * std::cos(turn), radius * std::sin(turn)};
    }
    return made;
  }();
  const glm::vec3 sight = at.position - eye;
  const float distance = glm::length(sight);
  const float radius = distance * std::tan(0.5f * diameter);
  const glm::vec3 right = distance > 0.0f ? across(sight) : glm::vec3(1, 0, 0);
  const glm::vec3 up = distance > 0.0f ? glm::cross(right, sight / distance) : glm::vec3(0, 1, 0);
  for (std::size_t i = 0; i < disc_corners; ++i) {
    out[i] = at;
    out[i].position += radius * (directions[i].x * right + directions[i].y * up);
  }
}

void place_line(const Vertex& a, const Vertex& b, const glm::vec3& eye, float width, Vertex* out) {
  const Sight sight = look_at(a.position - eye, b.position - eye);
  const float half = 0.5f * width, wide = std::tan(half);
  for (std::size_t i = 0; i <= ribbon_sections; ++i) {
    const float share = static_cast<float>(i) / ribbon_sections;
    Vertex station = between(a, b, i == ribbon_sections ? 1.0f : place_on_line(sight, share));
    if (i == 0 || i == ribbon_sections) { // turned away from the line, as far as before
      const bool first = i == 0;
      const glm::vec3& toward = first ? sight.toward_a : sight.toward_b;
      const glm::vec3 along = glm::cross(sight.side, toward) * (first ? -1.0f : 1.0f);
      station.position = eye + (first ? sight.distance_a : sight.distance_b) *
                                   (std::cos(half) * toward + std::sin(half) * along);
    }
    const glm::vec3 aside = sight.side * (glm::length(station.position - eye) * wide);
    out[2 * i] = out[2 * i + 1] = station;
    out[2 * i].position += aside;
    out[2 * i + 1].position -= aside;
  }
}

} // namespace cupola::content
