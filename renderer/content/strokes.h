// Points and lines as triangles that face the eye: a disc, and a ribbon as wide everywhere as seen from the
// eye. Every method and engine then draws them as it draws any triangle. Private to renderer/content. Pure.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::content {

/// What the vertices of a mesh stand for.
enum class Form : std::uint8_t { triangles, points, lines };

inline constexpr std::size_t disc_corners = 8;
/// Of a ribbon, each as long as its neighbours as seen from the eye. Within one the width follows the chord
/// of 1/cos: it is at most 8 % too wide, where a line runs past the eye from one horizon to the other.
inline constexpr std::size_t ribbon_sections = 4;

/// Vertices that stand for one point or for one line from a to b.
[[nodiscard]] constexpr std::size_t stroke_vertices(Form form) {
  return form == Form::points ? disc_corners : 2 * (ribbon_sections + 1);
}
[[nodiscard]] constexpr std::size_t stroke_triangles(Form form) {
  return form == Form::points ? disc_corners - 2 : 2 * ribbon_sections;
}

/// Corners of `count` strokes that stand behind one another, counter-clockwise as the eye sees them.
[[nodiscard]] std::vector<std::uint32_t> stroke_corners(Form form, std::size_t count);

/// A disc of a diameter in radians, as large as a circle of it; `out` has room for its vertices.
void place_point(const Vertex& at, const glm::vec3& eye, float diameter, Vertex* out);

/// A ribbon of a width in radians. It reaches half a width beyond both ends, so that lines that meet leave no
/// notch. Colours and coordinates run evenly from a to b.
void place_line(const Vertex& a, const Vertex& b, const glm::vec3& eye, float width, Vertex* out);

} // namespace cupola::content
