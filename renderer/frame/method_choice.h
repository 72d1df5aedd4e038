// Which method draws the viewports with method `auto`: both are tried, the quicker one stays. Pure: told the
// times, never asks for them.
#pragma once

#include <algorithm>
#include <limits>

#include "configs/model/show.h"

namespace cupola::frame {

class MethodChoice {
public:
  /// Frames drawn by each method in a trial; the first one of each warms up and does not count.
  static constexpr int frames_each = 3;

  /// Begins a trial: the work is no longer what it was.
  void restart() { *this = {}; }

  [[nodiscard]] bool trying() const { return drawn_ < 2 * frames_each; }

  /// The method for the frame about to be drawn.
  [[nodiscard]] model::Method method() const {
    if (trying()) return drawn_ < frames_each ? model::Method::piecewise : model::Method::cubemap;
    return piecewise_ <= cubemap_ ? model::Method::piecewise : model::Method::cubemap;
  }

  /// A frame by method() took so long; ignored when no trial is under way.
  void record(double milliseconds) {
    if (!trying()) return;
    double& best = drawn_ < frames_each ? piecewise_ : cubemap_;
    if (drawn_ % frames_each > 0) best = std::min(best, milliseconds);
    ++drawn_;
  }

private:
  int drawn_ = 0;
  double piecewise_ = std::numeric_limits<double>::infinity(), cubemap_ = piecewise_;
};

} // namespace cupola::frame
