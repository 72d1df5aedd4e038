// Walks over the whole table: what is true for one row is true for those to come.
#include "configs/model/parameters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

using namespace cupola::model;
using Json = nlohmann::ordered_json;

namespace {

CameraTexture bent(std::size_t number) {
  CameraTexture texture;
  texture.offsets = {{{0.1, 0.2}, {0, 0}}, {{0, 0}, {0, 0}}};
  Deformation deformation;
  if (number / 10 % 4 == 1) deformation.bend = Swirl{};
  if (number / 10 % 4 == 2) deformation.bend = Lens{};
  if (number / 10 % 4 == 3) deformation.bend = Ripple{};
  texture.deformations["d"] = deformation;
  return texture;
}

/// A show with at least one entry everywhere, its alternatives chosen by number.
Show furnished(std::size_t number) {
  Show show;
  show.scene.content = std::array<Content, 3>{City{}, Room{}, Gltf{"a.glb", "", 1.0}}[number % 3];
  show.camera.path = {{0.0, {1, 2, 3}, {}, {}}, {2.5, {4, 5, 6}, {}, glm::dvec3(1, 0, 0)}};
  show.projections["wall"].shape = std::array<Shape, 10>{
      Perspective{},  Cylinder{}, Fisheye{}, Equirectangular{}, Stereographic{},
      Orthographic{}, Mercator{}, Panini{},  CubeCross{},       bent(number)}[number % 10];
  show.projections["b.2"].shape = Fisheye{};
  Output output;
  output.sink =
      std::array<Sink, 4>{AutoOutput{}, HeadlessOutput{}, WindowOutput{}, FilesOutput{}}[number % 4];
  output.viewports["left"].projection = "wall";
  output.viewports["right"].projection = "b.2";
  show.outputs["main"] = output;
  return show;
}
constexpr std::size_t furnishings = 60;

/// Another valid value than `value`.
Json another(const Parameter& row, const Json& value) {
  const auto number = [&](const Json& old) {
    const Range range = row.range.value_or(Range{-10, 10});
    const bool whole = row.kind == Kind::integer || row.kind == Kind::integer_or_auto;
    double next = range.min + (range.max - range.min) * 0.25;
    if (whole) next = std::floor(next);
    if (!old.is_null() && old.get<double>() == next) next = range.max;
    return whole ? Json(static_cast<std::int64_t>(next)) : Json(next);
  };
  switch (row.kind) {
  case Kind::boolean:
    return !value.get<bool>();
  case Kind::text:
    return value.get<std::string>() + "x";
  case Kind::choice:
    return row.choices[value == row.choices.front() ? 1 : 0];
  case Kind::grid:
    return Json::array({Json::array({Json::array({number(Json()), row.range->max})})});
  case Kind::vector3:
    return Json::array({number(value.is_null() ? Json() : value[0]), row.range->max, row.range->min});
  default:
    return number(value);
  }
}

/// Visits every row that applies to the show, with the struct that holds it and its address.
using Visit = std::function<void(const Parameter&, void*, const std::string&)>;
void walk(const Type& type, void* self, const std::string& at, const Visit& visit) {
  const auto rows = [&](const std::vector<Parameter>& all, void* owner) {
    for (const Parameter& row : all) {
      const std::string here = at + '/' + row.name;
      visit(row, owner, here);
      if (row.kind == Kind::object)
        walk(*row.type, const_cast<void*>(row.nested(owner)), here, visit);
      else if (row.kind == Kind::map || row.kind == Kind::list)
        for (const std::string& key : row.keys(owner))
          walk(*row.type, const_cast<void*>(row.entry(owner, key)), std::string(here).append("/").append(key),
               visit);
    }
  };
  if (!type.alternatives.empty())
    rows(type.alternatives[type.active(self)].type->rows, const_cast<void*>(type.held(self)));
  rows(type.rows, self);
}

bool is_leaf(const Parameter& row) {
  return row.kind != Kind::object && row.kind != Kind::map && row.kind != Kind::list;
}

} // namespace

TEST_CASE("every row says what it is") {
  std::size_t rows = 0;
  for (std::size_t i = 0; i < furnishings; ++i) {
    Show show = furnished(i);
    walk(show_type(), &show, "", [&](const Parameter& row, void* owner, const std::string& at) {
      CAPTURE(at);
      ++rows;
      CHECK_FALSE(row.doc.empty());
      CHECK(row.doc.back() == '.');
      CHECK(row.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos);
      if (row.range) CHECK(row.range->min <= row.range->max);
      if (row.kind == Kind::choice) CHECK(row.choices.size() >= 2);
      if (row.kind == Kind::map || row.kind == Kind::list) REQUIRE(row.range);
      if (row.kind == Kind::vector3 || row.kind == Kind::grid) REQUIRE(row.range);
      if (!is_leaf(row)) {
        REQUIRE(row.type);
        return;
      }
      const Json value = row.read(owner);
      if (row.range && value.is_number()) {
        CHECK(value.get<double>() >= row.range->min);
        CHECK(value.get<double>() <= row.range->max);
      }
      CHECK((row.optional || !value.is_null()));
    });
  }
  CHECK(rows > 1000);
}

TEST_CASE("every leaf: set, read back, found by its address, and seen as the one difference with its cost") {
  std::size_t leaves = 0;
  for (std::size_t i = 0; i < furnishings; ++i) {
    const Show before = furnished(i);
    Show show = before;
    walk(show_type(), &show, "", [&](const Parameter& row, void* owner, const std::string& at) {
      if (!is_leaf(row) || (row.range && row.range->min == row.range->max)) return;
      CAPTURE(at);
      ++leaves;
      const Json old = row.read(owner);
      const Json wanted = another(row, old);
      row.write(owner, wanted);
      CHECK(row.read(owner) == wanted);
      CHECK_FALSE(show == before);

      const auto found = find(show, at);
      REQUIRE(found);
      REQUIRE(found->row);
      CHECK(found->row->name == row.name);
      CHECK(found->owner == owner);

      const auto seen = differences(before, show);
      REQUIRE(seen.size() == 1);
      CHECK(seen[0].pointer == at);
      CHECK(seen[0].cost == row.cost);

      const Json document = to_json(show);
      CHECK(document.at(Json::json_pointer(at)) == wanted);

      row.write(owner, old);
      CHECK(show == before);
    });
  }
  CHECK(leaves > 800);
}

TEST_CASE("an optional value becomes absent by null, and the document leaves it out or says auto") {
  Show show = furnished(0);
  std::size_t optionals = 0;
  walk(show_type(), &show, "", [&](const Parameter& row, void* owner, const std::string& at) {
    if (!is_leaf(row) || !row.optional) return;
    CAPTURE(at);
    ++optionals;
    row.write(owner, another(row, row.read(owner)));
    row.write(owner, nullptr);
    CHECK(row.read(owner).is_null());
    const Json document = to_json(show);
    if (row.kind == Kind::integer_or_auto)
      CHECK(document.at(Json::json_pointer(at)) == "auto");
    else
      CHECK_FALSE(document.contains(Json::json_pointer(at)));
  });
  CHECK(optionals == 5); // look_to of the camera and two key frames, vertical_fov, cubemap_size
}

TEST_CASE("leaf paths are the leaves and kinds, each once, each found") {
  for (std::size_t i = 0; i < furnishings; ++i) {
    Show show = furnished(i);
    std::set<std::string> wanted;
    walk(show_type(), &show, "", [&](const Parameter& row, void*, const std::string& at) {
      if (is_leaf(row)) wanted.insert(at);
    });
    wanted.insert(
        {"/scene/content/kind", "/projections/wall/kind", "/projections/b.2/kind", "/outputs/main/kind"});
    if (std::holds_alternative<CameraTexture>(show.projections["wall"].shape))
      wanted.insert("/projections/wall/deformations/d/kind");
    const auto paths = leaf_paths(show);
    CHECK(std::set<std::string>(paths.begin(), paths.end()) == wanted);
    CHECK(paths.size() == wanted.size());
    for (const std::string& path : paths) CHECK(find(show, path));
  }
}

TEST_CASE("find: structs, entries, kinds, and what is not there") {
  const Show show = furnished(1); // room, cylinder, headless
  const auto root = find(show, "");
  REQUIRE(root);
  CHECK(root->type == &show_type());
  CHECK(root->row == nullptr);

  const auto map = find(show, "/projections");
  REQUIRE(map);
  CHECK(map->row->kind == Kind::map);
  CHECK_FALSE(map->is_entry);

  const auto entry = find(show, "/projections/wall");
  REQUIRE(entry);
  CHECK(entry->is_entry);
  CHECK(entry->type->name == "projection");

  const auto kind = find(show, "/projections/wall/kind");
  REQUIRE(kind);
  CHECK(kind->is_kind);

  CHECK(find(show, "/camera/path/1/look_to"));
  CHECK(find(show, "/scene/content/size"));
  CHECK(find(show, "/scene/style/kind")->row); // a plain choice, in spite of its name
  for (const char* nowhere :
       {"/", "camera", "/Camera", "/projections/none", "/projections/wall/fov", "/projections/wall/kind/x",
        "/scene/content/seed", "/camera/path/2", "/camera/path/01", "/camera/path/-1", "/camera/path/1e0",
        "/camera/path/", "/camera/position/0", "/frame_rate/x", "//", "/camera/path/99999999999999999999"}) {
    CAPTURE(nowhere);
    CHECK_FALSE(find(show, nowhere));
  }
}

TEST_CASE("names with characters that pointers escape are found") {
  Show show;
  show.projections["a/b~c"].shape = Fisheye{};
  CHECK(find(show, "/projections/a~1b~0c/fov"));
  const auto paths = leaf_paths(show);
  CHECK(std::count(paths.begin(), paths.end(), "/projections/a~1b~0c/fov") == 1);
}

TEST_CASE("differences: entries that come and go, kinds that change") {
  const Show from = furnished(1);
  CHECK(differences(from, from).empty());

  Show to = from;
  to.projections["new"];
  to.projections.erase("b.2");
  to.outputs["second"];
  auto seen = differences(from, to);
  REQUIRE(seen.size() == 3);
  CHECK(seen[0].pointer == "/projections/b.2");
  CHECK(seen[0].cost == Cost::rebuild);
  CHECK(seen[1].pointer == "/projections/new");
  CHECK(seen[2].pointer == "/outputs/second");
  CHECK(seen[2].cost == Cost::reopen);

  to = from;
  to.projections["wall"].shape = Fisheye{};
  to.outputs["main"].sink = WindowOutput{};
  to.scene.content = City{};
  seen = differences(from, to);
  REQUIRE(seen.size() == 3);
  CHECK(seen[0].pointer == "/scene/content/kind");
  CHECK(seen[0].cost == Cost::rebuild);
  CHECK(seen[1].pointer == "/projections/wall/kind");
  CHECK(seen[2].pointer == "/outputs/main/kind");
  CHECK(seen[2].cost == Cost::reopen);

  to = from;
  to.camera.path.pop_back();
  seen = differences(from, to);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].pointer == "/camera/path/1");
}

TEST_CASE("a path of ten thousand key frames is compared and found in linear time") {
  Show from;
  from.camera.path.resize(10'000);
  for (std::size_t i = 0; i < from.camera.path.size(); ++i) from.camera.path[i].time = static_cast<double>(i);
  Show to = from;
  to.camera.path.back().position.x = 7;
  const auto seen = differences(from, to);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].pointer == "/camera/path/9999/position");
  CHECK(find(to, "/camera/path/9999/position"));
}

TEST_CASE("costs and units have names") {
  CHECK(cost_name(Cost::uniform) == "uniform");
  CHECK(cost_name(Cost::rebuild) == "rebuild");
  CHECK(cost_name(Cost::reopen) == "reopen");
  CHECK(cost_name(Cost::restart) == "restart");
  CHECK(unit_symbol(Unit::none).empty());
  for (const Unit unit : {Unit::metre, Unit::degree, Unit::second, Unit::hertz, Unit::pixel, Unit::fraction,
                          Unit::factor, Unit::per_metre})
    CHECK_FALSE(unit_symbol(unit).empty());
}
