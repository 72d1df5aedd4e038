// Builder for rows of the parameter table: the only place that knows how a C++ member becomes JSON.
#pragma once

#include <charconv>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "configs/model/parameters.h"

namespace cupola::model {

/// One word per enumerator, in order of their values from 0.
template <class E>
struct Words;

template <class M>
inline constexpr bool is_optional = false;
template <class M>
inline constexpr bool is_optional<std::optional<M>> = true;

template <class T>
class Describe {
public:
  Describe(std::string name, std::string doc)
      : type_(std::make_shared<Type>()) {
    type_->name = std::move(name);
    type_->doc = std::move(doc);
  }

  template <class M>
  Describe& number(std::string name, M T::*member, Unit unit, std::optional<Range> range, Cost cost,
                   std::string doc) {
    Parameter row = leaf(std::move(name), Kind::number, cost, std::move(doc));
    row.unit = unit;
    row.range = range;
    row.optional = is_optional<M>;
    row.read = [member](const void* owner) { return encode(static_cast<const T*>(owner)->*member); };
    row.write = [member](void* owner, const nlohmann::ordered_json& value) {
      decode(value, static_cast<T*>(owner)->*member);
    };
    return push(std::move(row));
  }

  template <class M>
  Describe& integer(std::string name, M T::*member, Unit unit, Range range, Cost cost, std::string doc) {
    number(std::move(name), member, unit, range, cost, std::move(doc));
    type_->rows.back().kind = is_optional<M> ? Kind::integer_or_auto : Kind::integer;
    return *this;
  }

  Describe& boolean(std::string name, bool T::*member, Cost cost, std::string doc) {
    number(std::move(name), member, Unit::none, std::nullopt, cost, std::move(doc));
    type_->rows.back().kind = Kind::boolean;
    return *this;
  }

  Describe& text(std::string name, std::string T::*member, Cost cost, std::string doc,
                 bool required = false) {
    number(std::move(name), member, Unit::none, std::nullopt, cost, std::move(doc));
    type_->rows.back().kind = Kind::text;
    type_->rows.back().required = required;
    return *this;
  }

  /// A text that must be one of the words given.
  Describe& word(std::string name, std::string T::*member, std::vector<std::string> words, Cost cost,
                 std::string doc) {
    text(std::move(name), member, cost, std::move(doc));
    type_->rows.back().kind = Kind::choice;
    type_->rows.back().choices = std::move(words);
    return *this;
  }

  template <class E>
  Describe& choice(std::string name, E T::*member, Cost cost, std::string doc) {
    Parameter row = leaf(std::move(name), Kind::choice, cost, std::move(doc));
    for (const char* word : Words<E>::all) row.choices.emplace_back(word);
    row.read = [member](const void* owner) {
      return nlohmann::ordered_json(
          Words<E>::all[static_cast<std::size_t>(static_cast<const T*>(owner)->*member)]);
    };
    row.write = [member, choices = row.choices](void* owner, const nlohmann::ordered_json& value) {
      for (std::size_t i = 0; i < choices.size(); ++i)
        if (value == choices[i]) static_cast<T*>(owner)->*member = static_cast<E>(i);
    };
    return push(std::move(row));
  }

  template <class M>
  Describe& vector3(std::string name, M T::*member, Unit unit, Range range, Cost cost, std::string doc) {
    number(std::move(name), member, unit, range, cost, std::move(doc));
    type_->rows.back().kind = Kind::vector3;
    return *this;
  }

  Describe& grid(std::string name, std::vector<std::vector<glm::dvec2>> T::*member, Unit unit, Range range,
                 Cost cost, std::string doc) {
    number(std::move(name), member, unit, range, cost, std::move(doc));
    type_->rows.back().kind = Kind::grid;
    return *this;
  }

  template <class M>
  Describe& object(std::string name, M T::*member, const Type& type, std::string doc) {
    Parameter row = leaf(std::move(name), Kind::object, Cost::uniform, std::move(doc));
    row.type = &type;
    row.nested = [member](const void* owner) -> const void* {
      return &(static_cast<const T*>(owner)->*member);
    };
    return push(std::move(row));
  }

  template <class M>
  Describe& map(std::string name, std::map<std::string, M> T::*member, const Type& type, Range entries,
                Cost cost, std::string doc) {
    Parameter row = leaf(std::move(name), Kind::map, cost, std::move(doc));
    row.type = &type;
    row.range = entries;
    row.keys = [member](const void* owner) {
      std::vector<std::string> names;
      for (const auto& [key, value] : static_cast<const T*>(owner)->*member) names.push_back(key);
      return names;
    };
    row.entry = [member](const void* owner, std::string_view key) -> const void* {
      const auto& all = static_cast<const T*>(owner)->*member;
      const auto it = all.find(std::string(key));
      return it == all.end() ? nullptr : &it->second;
    };
    row.clear = [member](void* owner) { (static_cast<T*>(owner)->*member).clear(); };
    row.add = [member](void* owner, std::string_view key) -> void* {
      return &(static_cast<T*>(owner)->*member)[std::string(key)];
    };
    return push(std::move(row));
  }

  template <class M>
  Describe& list(std::string name, std::vector<M> T::*member, const Type& type, Range entries, Cost cost,
                 std::string doc) {
    Parameter row = leaf(std::move(name), Kind::list, cost, std::move(doc));
    row.type = &type;
    row.range = entries;
    row.keys = [member](const void* owner) {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < (static_cast<const T*>(owner)->*member).size(); ++i)
        names.push_back(std::to_string(i));
      return names;
    };
    row.entry = [member](const void* owner, std::string_view key) -> const void* {
      const auto& all = static_cast<const T*>(owner)->*member;
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
      const bool canonical = !key.empty() && (key.size() == 1 || key.front() != '0');
      if (error != std::errc{} || end != key.data() + key.size() || !canonical || index >= all.size())
        return nullptr;
      return &all[index];
    };
    row.clear = [member](void* owner) { (static_cast<T*>(owner)->*member).clear(); };
    row.add = [member](void* owner, std::string_view) -> void* {
      return &(static_cast<T*>(owner)->*member).emplace_back();
    };
    return push(std::move(row));
  }

  /// The struct holds a variant, chosen by the key "kind". `alternatives` in the variant's order.
  template <class V>
  Describe& variant(V T::*member, bool required, Cost cost, std::vector<Alternative> alternatives) {
    type_->alternatives = std::move(alternatives);
    type_->kind_required = required;
    type_->kind_cost = cost;
    type_->active = [member](const void* self) { return (static_cast<const T*>(self)->*member).index(); };
    type_->held = [member](const void* self) {
      return std::visit([](const auto& held) -> const void* { return &held; },
                        static_cast<const T*>(self)->*member);
    };
    type_->activate = [member](void* self, std::size_t index) {
      V& target = static_cast<T*>(self)->*member;
      emplace<V>(target, index, std::make_index_sequence<std::variant_size_v<V>>{});
      return std::visit([](auto& held) -> void* { return &held; }, target);
    };
    return *this;
  }

  [[nodiscard]] std::shared_ptr<const Type> share() const { return type_; }
  [[nodiscard]] Type take() const { return *type_; }

private:
  template <class M>
  static nlohmann::ordered_json encode(const M& value) {
    return value;
  }
  static nlohmann::ordered_json encode(const Angle& value) { return value.degrees; }
  static nlohmann::ordered_json encode(const glm::dvec3& v) {
    return nlohmann::ordered_json::array({v.x, v.y, v.z});
  }
  static nlohmann::ordered_json encode(const std::vector<std::vector<glm::dvec2>>& grid) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& row : grid) {
      auto& line = out.emplace_back(nlohmann::ordered_json::array());
      for (const glm::dvec2& pair : row) line.push_back(nlohmann::ordered_json::array({pair.x, pair.y}));
    }
    return out;
  }
  template <class M>
  static nlohmann::ordered_json encode(const std::optional<M>& value) {
    return value ? encode(*value) : nlohmann::ordered_json();
  }

  template <class M>
  static void decode(const nlohmann::ordered_json& value, M& target) {
    target = value.get<M>();
  }
  static void decode(const nlohmann::ordered_json& value, Angle& target) {
    target.degrees = value.get<double>();
  }
  static void decode(const nlohmann::ordered_json& value, glm::dvec3& target) {
    target = {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }
  static void decode(const nlohmann::ordered_json& value, std::vector<std::vector<glm::dvec2>>& target) {
    target.clear();
    for (const auto& line : value) {
      auto& row = target.emplace_back();
      row.reserve(line.size());
      for (const auto& pair : line) row.emplace_back(pair[0].get<double>(), pair[1].get<double>());
    }
  }
  template <class M>
  static void decode(const nlohmann::ordered_json& value, std::optional<M>& target) {
    if (value.is_null())
      target.reset();
    else
      decode(value, target.emplace());
  }

  template <class V, std::size_t... I>
  static void emplace(V& target, std::size_t index, std::index_sequence<I...>) {
    ((index == I ? static_cast<void>(target.template emplace<I>()) : static_cast<void>(0)), ...);
  }

  static Parameter leaf(std::string name, Kind kind, Cost cost, std::string doc) {
    Parameter row;
    row.name = std::move(name);
    row.kind = kind;
    row.cost = cost;
    row.doc = std::move(doc);
    return row;
  }
  Describe& push(Parameter row) {
    type_->rows.push_back(std::move(row));
    return *this;
  }

  std::shared_ptr<Type> type_;
};

} // namespace cupola::model
