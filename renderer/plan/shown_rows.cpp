#include "renderer/plan/shown_rows.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace cupola::plan {

namespace {

constexpr int looks = 64; ///< places along an edge at which a shown pixel is looked for

/// Places in a range, its middle first: evenly spread, and both ends.
std::vector<int> places(int first, int size) {
  std::vector<int> out{first + size / 2};
  for (int i = 1; i < looks; ++i)
    out.push_back(first + (size / 2 + static_cast<int>(long(size) * i / looks)) % size);
  out.insert(out.end(), {first, first + size - 1});
  return out;
}

/// The last position from `from` on, in steps of ±1 and before `limit`, that still holds; `from` does.
/// `guess`: near the answer.
template <class Holds>
int last_that(int from, int limit, int guess, const Holds& holds) {
  const int step = limit > from ? 1 : -1;
  if (step * (guess - from) < 0) guess = from;
  if (step * (limit - guess) <= 0) guess = limit - step;
  int good = from, bad = limit;
  // Widening steps around the guess, then halves.
  if (holds(guess)) {
    good = guess;
    for (int reach = 1; step * (limit - (good + step * reach)) > 0; reach *= 2) {
      if (!holds(good + step * reach)) {
        bad = good + step * reach;
        break;
      }
      good += step * reach;
    }
  } else {
    bad = guess;
    for (int reach = 1; step * (bad - step * reach - from) > 0; reach *= 2) {
      if (holds(bad - step * reach)) {
        good = bad - step * reach;
        break;
      }
      bad -= step * reach;
    }
  }
  while (step * (bad - good) > 1) {
    const int middle = good + (bad - good) / 2;
    (holds(middle) ? good : bad) = middle;
  }
  return good;
}

} // namespace

ShownRows::ShownRows(const projection::Map& map, glm::ivec2 picture, const PixelRect& part)
    : picture_(picture)
    , part_(part)
    , rows_(static_cast<std::size_t>(std::max(part.height, 0))) {
  if (part.width <= 0 || part.height <= 0) return;
  const std::vector<int> across = places(part.x, part.width);
  for (const int y : places(part.y, part.height))
    for (const int x : across) {
      if (!asked(map, x, y)) continue;
      rows_[static_cast<std::size_t>(y - part.y)] = run(map, y, x, {part.x, part.x + part.width});
      spread(y, 1, map);
      spread(y, -1, map);
      for (const PixelRun& row : rows_) count_ += std::max(0, row.end - row.first);
      return;
    }
}

/// The rows after `from`, until nothing is shown.
void ShownRows::spread(int from, int step, const projection::Map& map) {
  PixelRun last = rows_[static_cast<std::size_t>(from - part_.y)];
  for (int y = from + step; y >= part_.y && y < part_.y + part_.height; y += step) {
    std::optional<int> inside; // where the run was; its middle first
    for (const int x : places(last.first, last.end - last.first)) {
      if (!asked(map, x, y)) continue;
      inside = x;
      break;
    }
    if (!inside) return;
    last = rows_[static_cast<std::size_t>(y - part_.y)] = run(map, y, *inside, last);
  }
}

PixelRun ShownRows::run(const projection::Map& map, int y, int inside, const PixelRun& like) const {
  const auto holds = [&](int x) { return asked(map, x, y); };
  return {last_that(inside, part_.x - 1, like.first, holds),
          last_that(inside, part_.x + part_.width, like.end - 1, holds) + 1};
}

bool ShownRows::asked(const projection::Map& map, int x, int y) const {
  const glm::dvec2 st(-1.0 + (2.0 * x + 1.0) / picture_.x, 1.0 - (2.0 * y + 1.0) / picture_.y);
  return projection::ray(map, st).has_value();
}

PixelRun ShownRows::row(int y) const {
  if (y < part_.y || y >= part_.y + part_.height) return {};
  return rows_[static_cast<std::size_t>(y - part_.y)];
}

bool ShownRows::shows(int x, int y) const {
  const PixelRun run = row(y);
  return x >= run.first && x < run.end;
}

} // namespace cupola::plan
