// Primitives of a glTF file as triangle lists, points and lines included. Private to the glTF reader.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "renderer/content/gltf_document.h"
#include "renderer/content/rig.h"

namespace cupola::content::gltf {

struct Primitive {
  std::shared_ptr<const RigMesh> mesh;
  std::vector<std::uint32_t> triangles; ///< into the vertices that the mesh places
  std::size_t material = 0;             ///< of the scene
  std::uint32_t most_joint = 0;         ///< largest joint that any vertex follows
  bool lit = true;                      ///< false: points or lines without normals
};

/// What a scene may hold; counted while reading, so that no file can ask for more memory than this allows.
struct Budget {
  std::size_t vertices = 0, triangles = 0, offsets = 0;
  /// Adds, or reports at `at` and answers false.
  bool take(std::size_t more_vertices, std::size_t more_triangles, std::size_t more_offsets,
            const std::string& at, Report& report);
};

/// What a primitive's vertices need to know of its material (the last one is the default).
struct MaterialNeed {
  int set = 0; ///< of texture coordinates
  bool textured = false;
};

/// The primitives of a mesh. Nothing after a problem.
[[nodiscard]] std::optional<std::vector<Primitive>> read_mesh(const Document& document, std::size_t mesh,
                                                              const std::vector<MaterialNeed>& materials,
                                                              Budget& budget, Report& report);

} // namespace cupola::content::gltf
