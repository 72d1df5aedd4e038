#include "renderer/frame/draw_timer.h"

#include <algorithm>
#include <utility>

namespace cupola::frame {

DrawTimer::DrawTimer(bool software)
    : software_(software) {
  if (software) return;
  for (Slot& slot : slots_) slot.query = gl::Query::make(GLenum{GL_TIME_ELAPSED});
}

void DrawTimer::begin() {
  started_ = Clock::now();
  timing_ = !software_ && !slots_[next_].pending;
  if (timing_) glBeginQuery(GL_TIME_ELAPSED, slots_[next_].query.id());
}

void DrawTimer::end(double beside_ms) {
  if (software_) glFinish();
  const double passed =
      beside_ms + std::chrono::duration<double, std::milli>(Clock::now() - started_).count();
  if (software_) finished_ = passed;
  if (!timing_) return;
  glEndQuery(GL_TIME_ELAPSED);
  slots_[next_].processor_ms = passed;
  slots_[next_].pending = true;
  next_ = (next_ + 1) % slots_.size();
  timing_ = false;
}

std::optional<double> DrawTimer::take() {
  if (software_) return std::exchange(finished_, std::nullopt);
  Slot& slot = slots_[oldest_];
  if (!slot.pending) return std::nullopt;
  GLint available = 0;
  glGetQueryObjectiv(slot.query.id(), GL_QUERY_RESULT_AVAILABLE, &available);
  if (!available) return std::nullopt;
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(slot.query.id(), GL_QUERY_RESULT, &nanoseconds);
  slot.pending = false;
  oldest_ = (oldest_ + 1) % slots_.size();
  return std::max(slot.processor_ms, static_cast<double>(nanoseconds) * 1e-6);
}

void DrawTimer::forget() {
  finished_.reset();
  if (software_) return;
  for (Slot& slot : slots_) { // a query under way cannot be taken back: another takes its place
    if (slot.pending) slot.query = gl::Query::make(GLenum{GL_TIME_ELAPSED});
    slot.pending = false;
  }
  oldest_ = next_;
}

} // namespace cupola::frame
