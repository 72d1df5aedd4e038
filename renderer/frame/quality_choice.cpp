#include "renderer/frame/quality_choice.h"

#include <algorithm>

namespace cupola::frame {

namespace {

/// Low, so that a level is tried rather than passed over; a trial tells the truth. Drawn n times as wide and
/// high, a picture takes between 1 and n * n times as long: the middle.
double guessed_growth(const QualityLevel& from, const QualityLevel& to) {
  return std::max(1.3, static_cast<double>(to.supersampling) / from.supersampling);
}

constexpr double least_growth = 1.05, most_growth = 16.0;
constexpr double far_too_long = 1.5; ///< of the period

} // namespace

std::vector<QualityLevel> quality_ladder(int max_anisotropy, int max_samples, int max_supersampling,
                                         bool software) {
  std::vector<QualityLevel> ladder{{}};
  const auto add = [&](int anisotropy, int samples, int supersampling) {
    const QualityLevel level{std::min(anisotropy, max_anisotropy), std::min(samples, max_samples),
                             supersampling};
    if (supersampling <= max_supersampling && level != ladder.back()) ladder.push_back(level);
  };
  add(software ? 1 : 16, software ? 4 : 1, 1);
  add(16, 4, 1);
  add(16, 8, 1);
  add(16, 4, 2);
  add(16, 4, 3);
  return ladder;
}

QualityChoice::QualityChoice(std::vector<QualityLevel> ladder) { restart(std::move(ladder)); }

void QualityChoice::restart(std::vector<QualityLevel> ladder) {
  ladder_ = std::move(ladder);
  steps_.assign(ladder_.size(), {});
  top_ = ladder_.size() - 1;
  at_ = std::min(at_, top_);
  not_before_ = clock_;
  wait_ = first_wait_ms;
  climbing_ = false;
  below_ = 0.0;
  warming_ = warming_frames;
  begin_window();
}

void QualityChoice::go_to_top() {
  at_ = top_;
  climbing_ = false;
  below_ = 0.0;
  warming_ = warming_frames;
  begin_window();
}

void QualityChoice::begin_window() {
  times_.clear();
  window_length_ = 0.0;
}

bool QualityChoice::record(double milliseconds, double period_ms) {
  clock_ += std::max(milliseconds, period_ms);
  if (warming_ > 0) {
    --warming_;
    return false;
  }
  times_.push_back(milliseconds);
  window_length_ += std::max(milliseconds, period_ms);
  const bool lost = hopeless(period_ms);
  const bool enough = times_.size() >= window_frames && window_length_ >= window_ms;
  const bool long_enough = times_.size() >= fewest_frames && window_length_ >= longest_window_ms;
  if (!lost && !enough && !long_enough) return false;
  const std::size_t slowest = std::min(times_.size() * 9 / 10, times_.size() - 2); // one may always be late
  const auto most = times_.begin() + static_cast<std::ptrdiff_t>(slowest);
  std::nth_element(times_.begin(), most, times_.end());
  const double taken = *most;
  begin_window();
  learn(taken);
  if (climbing_ && clock_ - climbed_ > trial_ms) { // the level holds
    climbing_ = false;
    wait_ = first_wait_ms;
  }
  if (taken > full * period_ms) return at_ > 0 && step_down();
  if (at_ == top_ || clock_ < not_before_ || taken * growth() > roomy * period_ms) return false;
  below_ = taken;
  return step_up();
}

bool QualityChoice::hopeless(double period_ms) const {
  return at_ > 0 && times_.size() == fewest_frames &&
         std::all_of(times_.begin(), times_.end(),
                     [&](double time) { return time > far_too_long * period_ms; });
}

/// Of the first window after a step up: what the step costs.
void QualityChoice::learn(double milliseconds) {
  if (below_ > 0.0) {
    const double growth = std::clamp(milliseconds / below_, least_growth, most_growth);
    Step& step = steps_[at_];
    step.growth = step.measured > 0 ? std::min(step.growth, growth) : growth;
    ++step.measured;
    step.since = clock_;
  }
  below_ = 0.0;
}

/// Of the step up from here.
double QualityChoice::growth() const {
  const Step& step = steps_[at_ + 1];
  const bool believed = step.measured > 1 || (step.measured == 1 && clock_ - step.since < doubt_ms);
  return believed ? step.growth : guessed_growth(ladder_[at_], ladder_[at_ + 1]);
}

bool QualityChoice::step_up() {
  ++at_;
  climbing_ = true;
  climbed_ = clock_;
  warming_ = warming_frames;
  return true;
}

bool QualityChoice::step_down() {
  if (climbing_) wait_ = std::min(2.0 * wait_, longest_wait_ms);
  not_before_ = clock_ + wait_;
  --at_;
  climbing_ = false;
  warming_ = warming_frames;
  return true;
}

void QualityChoice::refuse() {
  if (at_ == 0) return;
  --at_;
  top_ = at_;
  climbing_ = false;
  below_ = 0.0;
  warming_ = warming_frames;
  begin_window();
}

} // namespace cupola::frame
