#include "renderer/content/room.h"

#include <glm/geometric.hpp>
#include <string_view>

#include "renderer/content/canvas.h"
#include "renderer/content/clusters.h"

namespace cupola::content {
namespace {

/// Where the wall lies, and the right and up of its picture as seen from inside (outward is up × right).
struct Frame {
  glm::vec3 outward, right, up;
};

constexpr std::array<Frame, 6> frames{{
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
}};

constexpr int wall_cells = 4; ///< quads along an edge

/// Rows of five dots, from the top.
struct Glyph {
  char letter;
  std::array<const char*, 7> rows;
};

constexpr std::array<Glyph, 6> glyphs{{
    {'+', {".....", "..#..", "..#..", "#####", "..#..", "..#..", "....."}},
    {'-', {".....", ".....", ".....", "#####", ".....", ".....", "....."}},
    {'X', {"#...#", "#...#", ".#.#.", "..#..", ".#.#.", "#...#", "#...#"}},
    {'Y', {"#...#", "#...#", ".#.#.", "..#..", "..#..", "..#..", "..#.."}},
    {'Z', {"#####", "....#", "...#.", "..#..", ".#...", "#....", "#####"}},
    {'F', {"#####", "#....", "#....", "####.", "#....", "#....", "#...."}},
}};

void write(Canvas& canvas, std::string_view text, float left, float top, float dot) {
  for (const char letter : text) {
    for (const Glyph& glyph : glyphs) {
      if (glyph.letter != letter) continue;
      for (int row = 0; row < 7; ++row) {
        for (int column = 0; column < 5; ++column) {
          if (glyph.rows[static_cast<std::size_t>(row)][column] != '#') continue;
          const float x = left + dot * static_cast<float>(column);
          const float y = top + dot * static_cast<float>(row);
          canvas.rectangle(x, y, x + dot, y + dot, Color(1.0f));
        }
      }
    }
    left += 6.0f * dot;
  }
}

Image paint(const RoomWall& wall) {
  const Color color = Color(wall.color[0], wall.color[1], wall.color[2]) / 255.0f;
  Canvas canvas(512, 64.0f, color); // 64 dots
  write(canvas, wall.name, 10.0f, 18.0f, 4.0f);
  write(canvas, "F", 4.0f, 50.0f, 1.5f);
  return canvas.image(wall.name);
}

void add_wall(Scene& scene, std::vector<std::uint32_t>& triangles, const Frame& frame, float half) {
  const auto first = static_cast<std::uint32_t>(scene.geometry.vertices.size());
  for (int row = 0; row <= wall_cells; ++row) {
    for (int column = 0; column <= wall_cells; ++column) {
      const float u = static_cast<float>(column) / wall_cells;
      const float v = static_cast<float>(row) / wall_cells;
      Vertex vertex;
      vertex.position =
          (frame.outward + frame.right * (2.0f * u - 1.0f) + frame.up * (1.0f - 2.0f * v)) * half;
      vertex.normal = -frame.outward;
      vertex.uv = {u, v};
      scene.geometry.vertices.push_back(vertex);
    }
  }
  for (std::uint32_t row = 0; row < wall_cells; ++row) {
    for (std::uint32_t column = 0; column < wall_cells; ++column) {
      const std::uint32_t corner = first + row * (wall_cells + 1) + column;
      const std::uint32_t below = corner + wall_cells + 1;
      triangles.insert(triangles.end(), {corner, below, below + 1, corner, below + 1, corner + 1});
    }
  }
}

} // namespace

const std::array<RoomWall, 6>& room_walls() {
  static constexpr std::array<RoomWall, 6> walls{{{"+X", {208, 48, 48}},
                                                  {"-X", {104, 16, 32}},
                                                  {"+Y", {64, 176, 64}},
                                                  {"-Y", {16, 88, 32}},
                                                  {"+Z", {64, 96, 216}},
                                                  {"-Z", {16, 32, 112}}}};
  return walls;
}

Scene make_room(const model::Room& room) {
  Scene scene;
  std::vector<std::vector<std::uint32_t>> triangles(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RoomWall& wall = room_walls()[i];
    scene.images.push_back(paint(wall));
    Texture texture;
    texture.image = static_cast<int>(i);
    texture.wrap_s = texture.wrap_t = Wrap::clamp;
    scene.textures.push_back(texture);
    Material material;
    material.name = wall.name;
    material.unlit = true;
    material.base_color_map.texture = static_cast<int>(i);
    scene.materials.push_back(material);
    add_wall(scene, triangles[i], frames[i], static_cast<float>(room.size * 0.5));
  }
  make_clusters(scene.geometry, triangles, scene.materials);
  scene.static_vertices = static_cast<std::uint32_t>(scene.geometry.vertices.size());
  set_scene_bounds(scene);
  return scene;
}

} // namespace cupola::content
