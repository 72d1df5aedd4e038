// The test room: a closed cube around the origin, seen from inside, every wall with its own colour and
// letters.
#pragma once

#include <array>
#include <cstdint>

#include "configs/model/show.h"
#include "renderer/content/scene.h"

namespace cupola::content {

/// A wall's picture: `color` all over, its name in white in the middle, and a white letter F in the lower
/// left corner. The walls ±X and ±Z stand upright (top is +y). The ceiling +Y is upright for who looks up
/// with the head tilted back from -z (its top points to +z), the floor -Y for who looks down from -z (its top
/// points to -z).
struct RoomWall {
  const char* name;                  ///< "+X", …
  std::array<std::uint8_t, 3> color; ///< sRGB
};

/// In the order +X, -X, +Y, -Y, +Z, -Z: the indices of the room's materials.
[[nodiscard]] const std::array<RoomWall, 6>& room_walls();

[[nodiscard]] Scene make_room(const model::Room& room);

} // namespace cupola::content
