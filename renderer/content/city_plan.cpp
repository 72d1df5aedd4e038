#include "renderer/content/city_plan.h"

#include <algorithm>
#include <cmath>

#include "renderer/content/random.h"

namespace cupola::content::city {
namespace {

constexpr int lot_bays = 14; ///< the built square of a block, (50 - 2 · 4) / 3

/// Triangles of streets, kerbs and ground for a grid of blocks, meadows included.
int ground_triangles(int across, int along) {
  const int crossings = 2 * (across + 1) * (along + 1);
  const int streets = 6 * (across * (along + 1) + along * (across + 1));
  const int blocks = 42 * across * along;
  const int meadows = 2 * (2 * (across * 4 + 1) + 2 * (along * 4 + 1)) + 8;
  return crossings + streets + blocks + meadows;
}

int sky_triangles(const Plan& plan) { return plan.sky_segments * 2 * (2 * plan.sky_rings - 1); }

/// Rises to 1 in the middle of the city, which lies ahead of the origin.
double centrality(const Rect& kerb, double reach) {
  const double dx = (kerb.x0 + kerb.x1) * 0.5 - 20.0;
  const double dz = (kerb.z0 + kerb.z1) * 0.5 + 90.0;
  return 1.0 / (1.0 + (dx * dx + dz * dz) / (reach * reach));
}

struct Lot {
  int x, z, width, depth; ///< bays
};

void divide(Random& random, const Lot& lot, int largest, std::vector<Lot>& lots) {
  const bool across = lot.width > lot.depth || (lot.width == lot.depth && random.chance(0.5));
  const int side = across ? lot.width : lot.depth;
  if (side <= largest || side < 8) {
    lots.push_back(lot);
    return;
  }
  const int cut = 4 + random.below(side - 7); // at least four bays on each side
  Lot first = lot;
  Lot second = lot;
  if (across) {
    first.width = cut;
    second.x += cut;
    second.width -= cut;
  } else {
    first.depth = cut;
    second.z += cut;
    second.depth -= cut;
  }
  divide(random, first, largest, lots);
  divide(random, second, largest, lots);
}

Group wall_for(Random& random, int storeys) {
  const double draw = random.unit();
  if (storeys > 12) return draw < 0.5 ? Group::glass : draw < 0.8 ? Group::office : Group::stone;
  if (storeys > 6) return draw < 0.15 ? Group::glass : draw < 0.6 ? Group::office : Group::stone;
  if (storeys > 4) return draw < 0.3 ? Group::stone : draw < 0.65 ? Group::brick : Group::plaster;
  return draw < 0.5 ? Group::brick : Group::plaster;
}

Building make_building(Random& random, const Rect& rect, double central) {
  Building made;
  made.rect = rect;
  const int across = static_cast<int>(rect.width() / bay + 0.5);
  const int deep = static_cast<int>(rect.depth() / bay + 0.5);
  const int slender = std::min(across, deep);
  const double wish = (2.0 + 30.0 * central * central) * random.between(0.6, 1.5);
  made.storeys = std::clamp(static_cast<int>(wish), 2, slender * 8);
  made.wall = wall_for(random, made.storeys);
  made.shops = random.chance(0.15 + 0.8 * central);
  made.shift = random.below(8);
  const double draw = random.unit();
  if (made.storeys > 10) {
    made.form = Form::tower;
    made.tiers = std::clamp(1 + random.below(4), 1, slender - 2);
  } else if (made.storeys <= 6 && (made.wall == Group::brick || made.wall == Group::plaster) && draw < 0.7) {
    made.form = Form::gabled;
    made.storeys = std::min(made.storeys, 4);
    made.corner = rect.width() < rect.depth() ? 1 : 0;
  } else if (slender >= 4 && draw < 0.45) {
    made.form = Form::ell;
    made.corner = random.below(4);
    made.notch_x = 1 + random.below(across - 2);
    made.notch_z = 1 + random.below(deep - 2);
  }
  return made;
}

Block make_block(std::uint32_t seed, int x, int z, double reach) {
  Random random{static_cast<std::int64_t>(seed), x, z, 1};
  Block block;
  const double margin = street_width * 0.5;
  block.kerb = {x * pitch + margin, z * pitch + margin, (x + 1) * pitch - margin, (z + 1) * pitch - margin};
  const double central = centrality(block.kerb, reach);
  block.park = random.chance(0.1) && central < 0.9;
  block.garden = !block.park && random.chance(0.8 - central);
  if (block.park) return block;
  std::vector<Lot> lots;
  divide(random, {0, 0, lot_bays, lot_bays}, 5 + random.below(3) + static_cast<int>(central * 3.0), lots);
  const double left = block.kerb.x0 + walk_width;
  const double back = block.kerb.z0 + walk_width;
  for (const Lot& lot : lots) { // an alley of 3 m between neighbours
    const Rect rect{left + lot.x * bay + bay * 0.5, back + lot.z * bay + bay * 0.5,
                    left + (lot.x + lot.width) * bay - bay * 0.5,
                    back + (lot.z + lot.depth) * bay - bay * 0.5};
    block.buildings.push_back(make_building(random, rect, central));
  }
  return block;
}

void add_roof_fillers(Random& random, const Building& building, std::vector<Filler>& fillers) {
  const double top = kerb_height + height_of(building, building.tiers);
  if (building.form == Form::gabled) {
    const bool along_x = building.corner == 0;
    const double middle_x = (building.rect.x0 + building.rect.x1) * 0.5;
    const double middle_z = (building.rect.z0 + building.rect.z1) * 0.5;
    const double run = (along_x ? building.rect.width() : building.rect.depth()) * random.between(0.2, 0.3);
    const double span = along_x ? building.rect.depth() : building.rect.width();
    fillers.push_back({FillerKind::chimney, middle_x + (along_x ? run : 0.9), top,
                       middle_z + (along_x ? 0.9 : run), 0.5, span * 0.35 + 1.2, random.bits()});
    return;
  }
  const double inset = 1.5 * (building.tiers - 1);
  double x = (building.rect.x0 + building.rect.x1) * 0.5;
  double z = (building.rect.z0 + building.rect.z1) * 0.5;
  if (building.form == Form::ell) { // on the corner that is not cut away
    x = building.corner & 1 ? building.rect.x0 + 1.5 : building.rect.x1 - 1.5;
    z = building.corner & 2 ? building.rect.z0 + 1.5 : building.rect.z1 - 1.5;
    fillers.push_back({FillerKind::roof_box, x, top, z, 1.0, random.between(1.2, 2.4), random.bits()});
    return;
  }
  const double room_x = building.rect.width() * 0.5 - inset;
  const double room_z = building.rect.depth() * 0.5 - inset;
  for (const double side : {-1.0, 1.0}) { // one on each half: they never touch
    const double size = random.between(0.8, 1.3);
    fillers.push_back({FillerKind::roof_box, x + side * room_x * 0.5, top,
                       z + random.between(-0.4, 0.4) * room_z, size, random.between(1.2, 3.0),
                       random.bits()});
  }
}

void add_ground_fillers(Random& random, const Block& block, std::vector<Filler>& fillers) {
  const Rect& kerb = block.kerb;
  const auto plant = [&](double x, double z, double bush) {
    Filler filler;
    filler.kind = random.chance(bush) ? FillerKind::bush : FillerKind::tree;
    filler.x = x;
    filler.y = kerb_height;
    filler.z = z;
    filler.size = filler.kind == FillerKind::bush ? random.between(0.5, 0.9) : random.between(1.3, 2.0);
    filler.height = filler.kind == FillerKind::bush ? filler.size * 1.6 : random.between(5.0, 8.0);
    filler.key = random.bits();
    fillers.push_back(filler);
  };
  for (int i = 1; i <= 7; ++i) { // along the four kerbs
    const double along = i * (kerb.width() / 8.0);
    plant(kerb.x0 + along, kerb.z0 + 1.4, 0.1);
    plant(kerb.x0 + along, kerb.z1 - 1.4, 0.1);
    plant(kerb.x0 + 1.4, kerb.z0 + along, 0.1);
    plant(kerb.x1 - 1.4, kerb.z0 + along, 0.1);
  }
  if (!block.park) return;
  for (int i = 0; i < 36; ++i)
    plant(kerb.x0 + 8.0 + (i % 6) * 6.8 + random.between(-2.0, 2.0),
          kerb.z0 + 8.0 + (i / 6) * 6.8 + random.between(-2.0, 2.0), 0.35);
}

/// Chooses things at random until nothing fits any more.
std::vector<Filler> fill_up(const Plan& plan, std::uint32_t seed, int budget) {
  std::vector<Filler> all;
  for (std::size_t i = 0; i < plan.blocks.size(); ++i) {
    const Block& block = plan.blocks[i];
    Random random{static_cast<std::int64_t>(seed), static_cast<std::int64_t>(std::floor(block.kerb.x0)),
                  static_cast<std::int64_t>(std::floor(block.kerb.z0)), 2};
    add_ground_fillers(random, block, all);
    for (const Building& building : block.buildings) add_roof_fillers(random, building, all);
  }
  std::sort(all.begin(), all.end(), [](const Filler& a, const Filler& b) { return a.key < b.key; });
  std::vector<Filler> chosen;
  for (const Filler& filler : all) {
    if (triangles_of(filler) > budget) continue;
    budget -= triangles_of(filler);
    chosen.push_back(filler);
  }
  return chosen;
}

void lay_out(Plan& plan, std::uint32_t seed, int across, int along) {
  plan.first_x = -(across / 2);
  plan.last_x = plan.first_x + across;
  plan.first_z = -(along - along / 2); // the longer half lies ahead
  plan.last_z = plan.first_z + along;
  const double reach = 70.0 + 0.12 * pitch * std::max(across, along);
  plan.blocks.clear();
  for (int z = plan.first_z; z < plan.last_z; ++z)
    for (int x = plan.first_x; x < plan.last_x; ++x) plan.blocks.push_back(make_block(seed, x, z, reach));
}

int building_triangles(const Plan& plan) {
  int sum = 0;
  for (const Block& block : plan.blocks)
    for (const Building& building : block.buildings) sum += triangles_of(building);
  return sum;
}

/// Leaves out what the smallest cities cannot afford: towers become boxes, then the last buildings go.
void thin_out(Plan& plan, int budget) {
  for (std::size_t number = 0;; ++number) {
    bool any = false;
    for (Block& block : plan.blocks) {
      if (number >= block.buildings.size()) continue;
      any = true;
      Building& building = block.buildings[number];
      if (building.form != Form::gabled) building.form = Form::box;
      building.tiers = 1;
      building.shops = false;
      if (triangles_of(building) <= budget) {
        budget -= triangles_of(building);
        continue;
      }
      block.buildings.resize(number);
    }
    if (!any) return;
  }
}

} // namespace

int triangles_of(const Building& building) {
  const int shops = building.shops ? 1 : 0;
  switch (building.form) {
  case Form::box:
    return 10 + 8 * shops;
  case Form::ell:
    return 16 + 12 * shops;
  case Form::tower:
    return 10 * building.tiers + 8 * shops;
  case Form::gabled:
    return 14 + 8 * shops;
  }
  return 0;
}

double height_of(const Building& building, int tier) {
  const int storeys = std::max(1, building.storeys * tier / building.tiers);
  return storeys * storey + (building.shops ? shop_height : 0.0);
}

int triangles_of(const Filler& filler) {
  switch (filler.kind) {
  case FillerKind::tree:
    return 20;
  case FillerKind::bush:
    return 8;
  case FillerKind::roof_box:
  case FillerKind::chimney:
    return 10;
  }
  return 0;
}

Plan make_plan(const model::City& city) {
  Plan plan;
  const int wanted = std::clamp(city.triangles, 500, 5'000'000);
  if (wanted >= 3'000) {
    plan.sky_segments = 16;
    plan.sky_rings = 4;
  }
  if (wanted >= 15'000) {
    plan.sky_segments = 32;
    plan.sky_rings = 8;
  }
  // The greatest city that leaves a fifth for trees and roofs; grown by turns in x and z from a good guess.
  const int side = std::max(2, static_cast<int>(std::sqrt(wanted / 700.0)) - 2);
  int across = side;
  int along = side;
  lay_out(plan, city.seed, across, along);
  const auto fixed = [&plan](int x, int z) { return ground_triangles(x, z) + sky_triangles(plan); };
  for (;;) {
    const int next_across = across + (across <= along ? 1 : 0);
    const int next_along = along + (across <= along ? 0 : 1);
    Plan next = plan;
    lay_out(next, city.seed, next_across, next_along);
    if (fixed(next_across, next_along) + building_triangles(next) > wanted * 4.0 / 5.0) break;
    plan = std::move(next);
    across = next_across;
    along = next_along;
  }
  if (fixed(across, along) + building_triangles(plan) > wanted) thin_out(plan, wanted - fixed(across, along));
  const int left = wanted - fixed(across, along) - building_triangles(plan);
  plan.fillers = fill_up(plan, city.seed, left);
  return plan;
}

} // namespace cupola::content::city
