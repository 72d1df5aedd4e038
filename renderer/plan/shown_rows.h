// Which pixel centres of a rectangle show anything, row by row, without asking each.
//
// Between the breaks of a map, what is shown of a row is one run of pixels, and rows that show something
// stand together (discs and rectangles do; a map with other borders needs breaks there).
#pragma once

#include <vector>

#include "renderer/plan/plan.h"

namespace cupola::plan {

/// A run of pixels of a row, x from the left of the rectangle; empty where first >= end.
struct PixelRun {
  int first = 0, end = 0;
};

class ShownRows {
public:
  /// Rows and columns of `part` (in pixels of a picture of `width` × `height`, where no break passes within)
  /// whose centres show something.
  ShownRows(const projection::Map& map, glm::ivec2 picture, const PixelRect& part);

  [[nodiscard]] PixelRun row(int y) const; ///< y of the picture; empty outside the part
  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] const PixelRect& part() const { return part_; }
  [[nodiscard]] bool shows(int x, int y) const;

private:
  void spread(int from, int step, const projection::Map& map);
  [[nodiscard]] PixelRun run(const projection::Map& map, int y, int guess, const PixelRun& like) const;
  [[nodiscard]] bool asked(const projection::Map& map, int x, int y) const;

  glm::ivec2 picture_;
  PixelRect part_;
  std::vector<PixelRun> rows_;
  long count_ = 0;
};

} // namespace cupola::plan
