// What stands where in the city, before any triangle: blocks, lots, buildings, and the small things that fill
// up the triangle budget. Pure; private to the city.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "configs/model/show.h"

namespace cupola::content::city {

// Metres. Sizes are whole bays of 3 m, so that no window is cut at a corner.
inline constexpr double pitch = 64.0; ///< from crossing to crossing
inline constexpr double street_width = 14.0;
inline constexpr double walk_width = 4.0;          ///< pavement around a block
inline constexpr double zebra_length = walk_width; ///< pedestrian crossing at both ends of a street
inline constexpr double kerb_height = 0.15;
inline constexpr double bay = 3.0;
inline constexpr double storey = 3.0;
inline constexpr double shop_height = 4.0;
inline constexpr double tile = 12.0;      ///< edge of a ground or roof texture
inline constexpr double wall_tile = 24.0; ///< edge of a façade texture

/// The fourteen groups; the values are indices of materials.
enum class Group : std::uint8_t {
  glass,
  office,
  stone,
  brick,
  plaster,
  shop,
  flat_roof,
  tiled_roof,
  street,
  crossing,
  pavement,
  grass,
  tree,
  sky
};
inline constexpr int group_count = 14;

struct Rect {
  double x0, z0, x1, z1;
  [[nodiscard]] double width() const { return x1 - x0; }
  [[nodiscard]] double depth() const { return z1 - z0; }
};

enum class Form : std::uint8_t { box, ell, tower, gabled };

struct Building {
  Form form{};
  Group wall{};
  Rect rect{};
  int storeys = 1;    ///< above the shops; of a tower: up to the top
  int tiers = 1;      ///< of a tower, each 1.5 m further in
  bool shops = false; ///< ground floor of 4 m
  int corner = 0; ///< of an ell: the quarter that is missing; of a gabled house: ridge along x (0) or z (1)
  int notch_x = 0, notch_z = 0; ///< of an ell: bays cut away
  int shift = 0;                ///< of the façade's texture, so that neighbours differ
};
[[nodiscard]] int triangles_of(const Building& building);
/// Top of tier `tier` (1 to tiers), above the pavement.
[[nodiscard]] double height_of(const Building& building, int tier);

enum class FillerKind : std::uint8_t { tree, bush, roof_box, chimney };
/// Trees and bushes stand at (x, z) on y; boxes stand there with half sizes `size`.
struct Filler {
  FillerKind kind{};
  double x = 0, y = 0, z = 0;
  double size = 1.0, height = 1.0;
  std::uint64_t key = 0; ///< order of choice
};
[[nodiscard]] int triangles_of(const Filler& filler);

struct Block {
  Rect kerb{};
  bool park = false;   ///< grass instead of buildings
  bool garden = false; ///< grass between the buildings
  std::vector<Building> buildings;
};

struct Plan {
  int first_x = 0, last_x = 0, first_z = 0, last_z = 0; ///< blocks first … last - 1, crossings first … last
  int sky_segments = 8, sky_rings = 2;                  ///< rings: above the horizon, and as many below
  std::vector<Block> blocks;                            ///< row by row
  std::vector<Filler> fillers;
};

[[nodiscard]] Plan make_plan(const model::City& city);

} // namespace cupola::content::city
