// Triangular pieces as the CPU engine walks them: floats, a tree of cones, a pyramid and its landing each.
// Made once for a piece set, read by all threads. Pure, no GL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/plan/plan.h"

namespace cupola::passes {

class PieceTable {
public:
  static constexpr std::uint32_t no_group = ~0u;

  /// A cone about rays, through the eye.
  struct Cone {
    glm::vec3 axis;
    float sine, cosine; ///< of the half angle; cosine -1: everything
  };
  /// A subtree of pieces with a cone about all its rays: plan::PieceGroup in floats.
  struct Group : Cone {
    std::uint32_t first, count, next;
    std::uint32_t parent = no_group;
    [[nodiscard]] bool is_leaf(std::uint32_t own_number) const { return next == own_number + 1; }
  };
  struct Piece {
    /// Barycentric coordinates of a point of view space: dot(planes[i], v) for corner i.
    std::array<glm::vec3, 3> planes;
    std::array<std::uint32_t, 3> corners;
    /// Normals of the borders opposite the corners: the same in both pieces that meet there, to the last bit.
    std::array<glm::vec3, 3> borders;
    bool mirrored;                 ///< its picture is: winding on the screen is turned round
    std::uint32_t leaf = no_group; ///< the smallest group that holds it
  };
  struct Corner {
    glm::vec3 ray;
    glm::vec3 landing; ///< weight · (x, y, 1)
  };

  /// Precondition: `set` holds triangles.
  explicit PieceTable(const plan::PieceSet& set);

  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] const std::vector<Cone>& cones() const { return cones_; } ///< of each piece
  [[nodiscard]] const std::vector<Corner>& corners() const { return corners_; }

  /// Whether a group's cone may meet a sphere.
  [[nodiscard]] static bool meets(const Group& group, const glm::vec3& center, float radius);

private:
  std::vector<Group> groups_;
  std::vector<Piece> pieces_;
  std::vector<Cone> cones_;
  std::vector<Corner> corners_;
};

} // namespace cupola::passes
