// Collects problems with their places. Private to the room.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "configs/loader/loader.h"

namespace cupola::loader {

class Report {
public:
  /// A report longer than this ends in one line with the number of those left out.
  static constexpr std::size_t limit = 200;

  /// `keys` and `values` may be empty: problems then have pointers only.
  Report(const Positions& keys, const Positions& values)
      : keys_(keys)
      , values_(values) {}

  /// Located at the value of its pointer, or at the nearest parent that stands in the text. A place already
  /// set stays.
  void add(model::Problem problem);
  /// Located at the key instead.
  void add_at_key(model::Problem problem);

  /// True when an error concerns this value, a part of it, or what it is a part of.
  [[nodiscard]] bool refused(std::string_view pointer) const;

  /// No more will be kept: callers may spare the effort of a good explanation.
  [[nodiscard]] bool full() const { return problems_.size() >= limit; }

  /// All of them in the order of the text.
  [[nodiscard]] model::Problems take();

private:
  const Positions& keys_;
  const Positions& values_;
  model::Problems problems_;
  std::size_t left_out_ = 0;
  bool error_left_out_ = false;
};

} // namespace cupola::loader
