#include "renderer/passes/lookup_pass.h"

#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <utility>
#include <vector>

#include "renderer/gl/shader.h"

namespace cupola::passes {

namespace {

/// Twin of the inputs of lookup_grid.vert.glsl.
struct GridVertex {
  glm::vec2 landing, place;
};

/// Those of a program for one shape.
void set_uniforms(const projection::MapUniforms& values) {
  using projection::MapUniforms;
  glUniform4fv(MapUniforms::location_parameters, 1, glm::value_ptr(values.parameters));
  glUniform1f(MapUniforms::location_zoom, values.zoom);
  glUniform3fv(MapUniforms::location_off_axis, 1, glm::value_ptr(values.off_axis));
  glUniformMatrix3fv(MapUniforms::location_orientation, 1, GL_FALSE, glm::value_ptr(values.orientation));
}

} // namespace

void set_map(const projection::Map& map) {
  const projection::MapUniforms values = projection::uniforms(map);
  glUniform1i(projection::MapUniforms::location_shape, values.shape);
  set_uniforms(values);
}

LookupPass::LookupPass()
    : empty_array_(gl::VertexArray::make()) {}

GLuint LookupPass::program(std::size_t shape, bool by_depth) {
  const auto found = programs_.find({shape, by_depth});
  if (found != programs_.end()) return found->second.id();
  constexpr std::size_t bent = projection::index_of<projection::CameraTextureMap>;
  const char* vertex =
      shape == bent ? "renderer/passes/lookup_grid.vert.glsl" : "renderer/passes/fullscreen.vert.glsl";
  std::vector<std::string> defines{"MAP_SHAPE " + std::to_string(shape)};
  if (by_depth) defines.emplace_back("CUPOLA_BY_DEPTH");
  model::Result<gl::Program> made = gl::build_program(
      {"lookup",
       {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, "renderer/passes/lookup.frag.glsl"}},
       defines});
  if (!made) {
    problems_.insert(problems_.end(), made.error().begin(), made.error().end());
    return programs_.emplace(std::pair{shape, by_depth}, gl::Program()).first->second.id();
  }
  return programs_.emplace(std::pair{shape, by_depth}, std::move(*made)).first->second.id();
}

/// Triangles in falling order: where equally near ones fold over each other, the first is drawn last and
/// stays.
const LookupPass::Mesh& LookupPass::mesh(const std::shared_ptr<const projection::CameraGrid>& grid) {
  std::erase_if(meshes_, [](const Mesh& mesh) { return mesh.grid.expired(); });
  for (const Mesh& mesh : meshes_)
    if (mesh.grid.lock() == grid) return mesh;
  const auto vertex_count = static_cast<std::uint32_t>((grid->columns() + 1) * (grid->rows() + 1));
  std::vector<GridVertex> vertices;
  vertices.reserve(vertex_count);
  for (std::uint32_t i = 0; i < vertex_count; ++i)
    vertices.push_back({glm::vec2(grid->landing(i)), glm::vec2(grid->place(i))});
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{3} * grid->triangle_count());
  for (std::uint32_t i = grid->triangle_count(); i-- > 0;)
    for (const std::uint32_t vertex : grid->triangle(i)) indices.push_back(vertex);

  Mesh made{grid, gl::VertexArray::make(), gl::Buffer::make(), gl::Buffer::make(),
            static_cast<GLsizei>(indices.size())};
  glNamedBufferStorage(made.vertices.id(), static_cast<GLsizeiptr>(vertices.size() * sizeof(GridVertex)),
                       vertices.data(), 0);
  glNamedBufferStorage(made.indices.id(), static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                       indices.data(), 0);
  const GLuint array = made.array.id();
  glVertexArrayVertexBuffer(array, 0, made.vertices.id(), 0, sizeof(GridVertex));
  glVertexArrayElementBuffer(array, made.indices.id());
  for (const GLuint input : {0u, 1u}) {
    glEnableVertexArrayAttrib(array, input);
    glVertexArrayAttribFormat(array, input, 2, GL_FLOAT, GL_FALSE, input * sizeof(glm::vec2));
    glVertexArrayAttribBinding(array, input, 0);
  }
  return meshes_.emplace_back(std::move(made));
}

void LookupPass::draw(const projection::Map& map, const CubemapTarget& cubemap) {
  const auto* bent = std::get_if<projection::CameraTextureMap>(&map.shape);
  const bool by_depth = bent != nullptr && cubemap.depth_texture() != 0;
  const GLuint used = program(map.shape.index(), by_depth);
  if (used == 0) return;
  glDisable(GL_DEPTH_TEST);
  if (by_depth) {
    glClearDepth(0.0);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glBindTextureUnit(1, cubemap.depth_texture());
    glBindSampler(1, 0);
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glUseProgram(used);
  set_uniforms(projection::uniforms(map));
  glBindTextureUnit(0, cubemap.texture());
  glBindSampler(0, 0);
  if (bent != nullptr) {
    const Mesh& drawn = mesh(bent->grid);
    glBindVertexArray(drawn.array.id());
    glDrawElements(GL_TRIANGLES, drawn.count, GL_UNSIGNED_INT, nullptr);
  } else {
    glBindVertexArray(empty_array_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

model::Problems LookupPass::take_problems() { return std::exchange(problems_, {}); }

} // namespace cupola::passes
