#include "renderer/frame/automatic_quality.h"

#include <algorithm>
#include <optional>

namespace cupola::frame {

namespace {

constexpr int most_supersampling = 3;
constexpr long most_bytes = 1l << 31; ///< of what is drawn into; a driver's memory cannot be asked for
constexpr long pixel_bytes = 4, sample_bytes = 8; ///< colour; colour and depth

/// What is drawn into fits the driver's limits, and no more memory than one may ask for.
bool fits(const Stage& stage, const Device& device, const QualityLevel& level) {
  const long enlarged = static_cast<long>(level.supersampling) * level.supersampling;
  long edge = 1, bytes = 0;
  for (const plan::OutputPlan& output : stage.plan->outputs) {
    edge = std::max<long>({edge, output.width, output.height});
    bytes += static_cast<long>(output.width) * output.height * enlarged * level.samples * sample_bytes;
  }
  if (stage.plan->cubemap) {
    const model::Quality& quality = stage.show->quality;
    const long size = stage.plan->cubemap->size;
    const bool grows = !quality.cubemap_size;
    if (grows) edge = std::max(edge, size);
    const long faces_with_depth = quality.cubemap_single_pass ? 6 : 1;
    bytes += size * size * (grows ? enlarged : 1) *
             (6 * pixel_bytes + faces_with_depth * level.samples * sample_bytes);
  }
  return edge * level.supersampling <= device.max_texture && bytes <= most_bytes;
}

/// As far as it fits; every level needs more than those below it.
std::vector<QualityLevel> ladder_of(const Stage& stage, const Device& device) {
  std::vector<QualityLevel> ladder =
      quality_ladder(device.max_anisotropy, device.max_samples, most_supersampling, device.software);
  while (ladder.size() > 1 && !fits(stage, device, ladder.back())) ladder.pop_back();
  return ladder;
}

model::Quality with(model::Quality quality, const QualityLevel& level) {
  quality.anisotropy = level.anisotropy;
  quality.samples = level.samples;
  quality.supersampling = level.supersampling;
  return quality;
}

} // namespace

AutomaticQuality::AutomaticQuality(const Device& device, bool offline)
    : device_(device)
    , offline_(offline)
    , choice_({QualityLevel{}})
    , timer_(device.software) {}

model::Quality AutomaticQuality::of(const Stage& stage) const {
  if (!stage.show->quality.automatic) return stage.show->quality;
  const std::vector<QualityLevel> ladder = ladder_of(stage, device_);
  const std::size_t best = ladder.size() - 1;
  return with(stage.show->quality, ladder[std::min(choice_.index(), best)]);
}

model::Quality AutomaticQuality::plainest(const Stage& stage) {
  return stage.show->quality.automatic ? with(stage.show->quality, {}) : stage.show->quality;
}

void AutomaticQuality::restart(const Stage& stage) {
  choice_.restart(ladder_of(stage, device_));
  if (offline_) choice_.go_to_top();
  timer_.forget();
}

void AutomaticQuality::begin(const Stage& stage) {
  if (stage.show->quality.automatic && !offline_) timer_.begin();
}

void AutomaticQuality::end(const Stage& stage, bool usual) {
  if (!stage.show->quality.automatic || offline_) return;
  timer_.end(beside_ms_);
  if (!usual) timer_.forget();
  const double period_ms = 1000.0 / stage.show->frame_rate;
  while (const std::optional<double> milliseconds = timer_.take()) {
    if (!choice_.record(*milliseconds, period_ms)) continue;
    timer_.forget(); // what is under way was drawn at the level before
    return;
  }
}

void AutomaticQuality::refuse() { choice_.refuse(); }

} // namespace cupola::frame
