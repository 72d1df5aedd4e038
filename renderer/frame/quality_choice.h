// How carefully is drawn with /quality/automatic: the best step of a ladder whose frames hold the show's
// rate. Pure: told the times, never asks for them.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace cupola::frame {

struct QualityLevel {
  int anisotropy = 1, samples = 1, supersampling = 1;
  bool operator==(const QualityLevel&) const = default;
};

/// From the plainest to the best, within what the driver has: textures first, then edges, then everything.
/// With a `software` driver, where filtering textures is dearest, edges come first.
[[nodiscard]] std::vector<QualityLevel> quality_ladder(int max_anisotropy, int max_samples,
                                                       int max_supersampling, bool software);

class QualityChoice {
public:
  // A level is left when its frames take more than `full` of the period, and entered only when they are
  // expected to take at most `roomy`: between the two nothing changes.
  static constexpr double full = 0.95, roomy = 0.75;
  /// Judged together, by the time that nine in ten keep, or all but one.
  static constexpr std::size_t window_frames = 12;
  static constexpr double window_ms = 400.0;           ///< and at least so long
  static constexpr double longest_window_ms = 2'000.0; ///< at low rates fewer frames must do
  /// So many at least; enough also where each took half as long again as the period.
  static constexpr std::size_t fewest_frames = 4;
  static constexpr int warming_frames = 2;     ///< after a change: memory is new, programs are compiled
  static constexpr double trial_ms = 60'000.0; ///< a level left sooner was tried in vain
  static constexpr double first_wait_ms = 5'000.0,
                          longest_wait_ms = 600'000.0; ///< doubled by each trial in vain
  /// What a step costs was measured in a moment that may have been a bad one: believed for so long, then
  /// tried once more. The lower of two is believed.
  static constexpr double doubt_ms = 60'000.0;

  /// Precondition: a ladder of one level at least. Begins at its lowest.
  explicit QualityChoice(std::vector<QualityLevel> ladder);

  [[nodiscard]] const QualityLevel& level() const { return ladder_[at_]; }
  [[nodiscard]] std::size_t index() const { return at_; } ///< of level() in the ladder

  /// Another ladder, for other work: what was learned of times is forgotten. The level stays, or the nearest
  /// below.
  void restart(std::vector<QualityLevel> ladder);

  /// To the best that is not refused, whatever it takes.
  void go_to_top();

  /// A frame at level() took so long, where `period_ms` was asked for. True when level() has changed.
  bool record(double milliseconds, double period_ms);

  /// level() cannot be had (memory): back to the one below, and no higher until restart().
  void refuse();

private:
  void begin_window();
  bool step_up();
  bool step_down();
  [[nodiscard]] bool hopeless(double period_ms) const;
  void learn(double milliseconds);
  [[nodiscard]] double growth() const;

  /// What is known of the time at a level over that at the one below.
  struct Step {
    double growth = 0.0; ///< the lowest measured
    int measured = 0;    ///< so often
    double since = 0.0;  ///< on the clock
  };

  std::vector<QualityLevel> ladder_;
  std::vector<Step> steps_; ///< to each level from the one below
  std::size_t at_ = 0, top_ = 0;
  std::vector<double> times_; ///< of the window in progress
  double window_length_ = 0.0;
  int warming_ = warming_frames;
  double clock_ = 0.0, climbed_ = 0.0, not_before_ = 0.0, wait_ = first_wait_ms; ///< milliseconds of frames
  bool climbing_ = false; ///< the last step was up, less than a trial ago
  double below_ = 0.0;    ///< what a frame took before it; 0: not known
};

} // namespace cupola::frame
