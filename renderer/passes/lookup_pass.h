// The second half of the image-based method: every pixel of a viewport from the cubemap. Render thread only.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "configs/model/problem.h"
#include "renderer/gl/handle.h"
#include "renderer/passes/targets.h"
#include "renderer/projection/map.h"

namespace cupola::passes {

/// Sets the uniforms of map.glsl in the program in use, one for any shape.
void set_map(const projection::Map& map);

class LookupPass {
public:
  LookupPass();

  /// Looks every pixel of the current GL viewport up; a camera texture is drawn as its mesh, bending one flat
  /// picture. Pixels that the projection does not show stay as they are.
  void draw(const projection::Map& map, const CubemapTarget& cubemap);

  /// A shape whose shader the driver refuses shows nothing; the problem is given once.
  [[nodiscard]] model::Problems take_problems();

private:
  /// The grid of a camera texture on the GPU.
  struct Mesh {
    std::weak_ptr<const projection::CameraGrid> grid;
    gl::VertexArray array;
    gl::Buffer vertices, indices;
    GLsizei count = 0;
  };

  GLuint program(std::size_t shape, bool by_depth);
  const Mesh& mesh(const std::shared_ptr<const projection::CameraGrid>& grid);

  /// By shape (a shader for all would compute all), and whether the nearest of a fold is looked up.
  std::map<std::pair<std::size_t, bool>, gl::Program> programs_;
  std::vector<Mesh> meshes_; ///< of grids that are still in use
  gl::VertexArray empty_array_;
  model::Problems problems_;
};

} // namespace cupola::passes
