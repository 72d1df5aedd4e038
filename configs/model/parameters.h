// The table: one row per parameter of a show. From it come parsing and its errors, the JSON Schema, the
// reference page, network addresses, and what a change costs. Nothing is listed a second time by hand.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "configs/model/show.h"

namespace cupola::model {

enum class Unit : std::uint8_t { none, metre, degree, second, hertz, pixel, fraction, factor, per_metre };
[[nodiscard]] std::string_view unit_symbol(Unit unit); ///< "m", "°", … or ""

/// What an edit of the parameter needs. Ordered: a change costs the greatest of its edits.
enum class Cost : std::uint8_t {
  uniform, ///< the next frame
  rebuild, ///< prepared beside the running show, then swapped
  reopen,  ///< an output is closed and opened
  restart  ///< refused live: edit the file and restart
};
[[nodiscard]] std::string_view cost_name(Cost cost);

struct Range {
  double min, max;
  bool min_exclusive = false;
};

enum class Kind : std::uint8_t {
  boolean,
  integer,
  number,
  text,
  choice,          ///< text, one of `choices`
  vector3,         ///< array of three numbers, each in `range`
  grid,            ///< array of rows of pairs of numbers, each in `range`; empty: none
  integer_or_auto, ///< integer, or "auto" when absent
  object,          ///< a nested struct described by `type`
  map,             ///< object of named structs described by `type`
  list             ///< array of structs described by `type`
};

struct Type;

/// One row. The functions take the address of the struct that the row belongs to.
struct Parameter {
  std::string name; ///< key in JSON, last part of the address
  Kind kind{};
  Unit unit = Unit::none;
  std::optional<Range> range; ///< numbers; for map and list: of the number of entries
  Cost cost = Cost::uniform;
  std::string doc;
  bool required = false;            ///< no default makes sense
  bool optional = false;            ///< may be absent, which means something else than the default
  std::vector<std::string> choices; ///< Kind::choice
  const Type* type = nullptr;       ///< Kind::object, map, list

  /// Leaves: the value as JSON; null where an optional one is absent.
  std::function<nlohmann::ordered_json(const void* owner)> read;
  /// Leaves: stores a value that has been checked against kind, range and choices; null makes it absent.
  std::function<void(void* owner, const nlohmann::ordered_json& value)> write;

  /// Kind::object: the nested struct.
  std::function<const void*(const void* owner)> nested;
  /// Kind::map and list: the names (or "0", "1", …) in order.
  std::function<std::vector<std::string>(const void* owner)> keys;
  /// Kind::map and list: the entry with this key, nullptr where there is none.
  std::function<const void*(const void* owner, std::string_view key)> entry;
  /// Kind::map and list: empties, and adds an entry with its defaults (lists append, the key is ignored).
  std::function<void(void* owner)> clear;
  std::function<void*(void* owner, std::string_view key)> add;
};

/// One of the alternatives of a struct that holds a variant, chosen by the key "kind".
struct Alternative {
  std::string name;
  std::string doc;
  std::shared_ptr<const Type> type;
};

/// The description of a struct: its rows and, where it holds a variant, the alternatives' rows beside them.
struct Type {
  std::string name;
  std::string doc;
  std::vector<Parameter> rows;
  std::vector<Alternative> alternatives;
  bool kind_required = false; ///< "kind" must be given (else the first alternative is the default)
  Cost kind_cost = Cost::rebuild;
  std::function<std::size_t(const void* self)> active;          ///< index of the alternative held
  std::function<const void*(const void* self)> held;            ///< its address
  std::function<void*(void* self, std::size_t index)> activate; ///< holds that alternative, with defaults
};

/// A key as one reference token of a JSON pointer (RFC 6901): ~ becomes ~0 and / becomes ~1.
[[nodiscard]] std::string escaped(std::string_view key);

/// The root: the description of Show.
[[nodiscard]] const Type& show_type();

/// A show as a complete document: every parameter, defaults included, absent optionals left out.
[[nodiscard]] nlohmann::ordered_json to_json(const Show& show);

/// The row that a JSON pointer names inside this show, following maps, lists and the alternatives held.
/// "kind" of a struct with alternatives is reported through `is_kind`.
struct Found {
  const Parameter* row = nullptr; ///< nullptr with is_kind, or for the root
  const void* owner = nullptr;    ///< struct that the row belongs to
  const Type* type = nullptr;     ///< the struct's own type
  bool is_kind = false;
  bool is_entry = false; ///< the pointer names an entry of a map or list, not the whole of it
};
[[nodiscard]] std::optional<Found> find(const Show& show, std::string_view pointer);

/// All addresses of leaves of this show ("/projections/wall/horizontal_fov"), in document order.
[[nodiscard]] std::vector<std::string> leaf_paths(const Show& show);

struct Difference {
  std::string pointer; ///< deepest address at which the two shows differ
  Cost cost;
};
/// Where two shows differ, and what each difference costs. Entries that came or went cost what their map
/// says; a changed "kind" costs its type's kind_cost.
[[nodiscard]] std::vector<Difference> differences(const Show& from, const Show& to);

} // namespace cupola::model
