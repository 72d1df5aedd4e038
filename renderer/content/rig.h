// What a moving scene is made of: nodes, skins, morph targets, animation channels. Private to
// renderer/content.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/content/strokes.h"

namespace cupola::content {

/// A node's place against its parent: translation · rotation · scale, or a matrix that cannot be animated.
struct RigNode {
  int parent = -1;
  bool fixed = false; ///< `matrix` holds instead of the three
  glm::vec3 translation{0.0f}, scale{1.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::mat4 matrix{1.0f};
  std::vector<float> weights; ///< of morph targets
};

enum class RigPath : std::uint8_t { translation, rotation, scale, weights };
enum class RigCurve : std::uint8_t { linear, step, cubic };

/// One property of a node over time. values: per key `width` numbers; cubic: in-tangents, values,
/// out-tangents.
struct RigChannel {
  std::size_t node = 0;
  RigPath path{};
  RigCurve curve{};
  std::size_t width = 3;
  std::vector<float> times, values;
};

/// Joints' nodes and the matrices from the mesh's space to each joint's.
struct RigSkin {
  std::vector<std::size_t> joints;
  std::vector<glm::mat4> inverse_bind;
};

struct RigInfluence {
  std::uint32_t joint;
  float weight;
};

/// Vertices in their own space, shared by all places where the same primitive is shown.
struct RigMesh {
  std::vector<Vertex> vertices;
  bool flat = false; ///< three vertices a triangle in order; normals follow from their positions
  Form form = Form::triangles;
  std::vector<std::uint32_t> strokes; ///< vertices that are points, or pairs of them that are lines
  struct Target {
    std::vector<glm::vec3> positions, normals; ///< offsets; empty: none
  };
  std::vector<Target> targets;
  std::size_t influences =
      0; ///< of each vertex in `skinning`, largest count of the file (4 or 8); 0: no skin
  std::vector<RigInfluence> skinning;

  [[nodiscard]] std::size_t stroke_count() const {
    return form == Form::lines ? strokes.size() / 2 : strokes.size();
  }
  /// Vertices that it has in a scene.
  [[nodiscard]] std::size_t placed_vertices() const {
    return form == Form::triangles ? vertices.size() : stroke_count() * stroke_vertices(form);
  }
};

/// A primitive at a node.
struct RigPart {
  std::shared_ptr<const RigMesh> mesh;
  std::size_t node = 0;
  int skin = -1;
  std::size_t first_vertex = 0; ///< among the scene's vertices
};

struct RigLight {
  std::size_t node = 0;
  Light light; ///< at the origin of its node, shining along -z
};

struct Rig {
  float scale = 1.0f;             ///< of the whole scene
  float point_size = 0.0f;        ///< diameter of points as seen from the eye, radians
  float line_width = 0.0f;        ///< radians
  std::vector<RigNode> nodes;     ///< as at rest
  std::vector<std::size_t> order; ///< of nodes: parents first
  std::vector<RigChannel> channels;
  std::vector<RigSkin> skins;
  std::vector<RigPart> parts; ///< those that move, with time or with the eye
  std::vector<RigLight> lights;
  std::vector<std::size_t> moving_clusters;
};

/// Where everything is at one time.
struct RigState {
  std::vector<RigNode> nodes;
  std::vector<glm::mat4> world;
};
[[nodiscard]] RigState rig_state(const Rig& rig, double time);
/// The vertices of one part as they are seen from `eye`; `out` has room for all that the mesh places.
void place_part(const Rig& rig, const RigState& state, const RigPart& part, const glm::vec3& eye,
                Vertex* out);
/// Mirrored parts show their triangles' backs: their winding has to be turned.
[[nodiscard]] bool is_mirrored(const Rig& rig, const RigState& state, const RigPart& part);
[[nodiscard]] Light place_light(const Rig& rig, const RigState& state, const RigLight& light);

} // namespace cupola::content
