// A renderer for tests of the frame loop alone: the same class, linked in place of the real one. It paints
// each output in the show's background colour and can be told to be slow or to fail.
#pragma once

#include <atomic>
#include <cstdint>

namespace cupola::tests {

struct StandIn {
  std::atomic<int> frames_to_realise = 0;    ///< frames that a later stage needs before it is drawn
  std::atomic<std::uint64_t> fails_at = 0;   ///< a stage of this revision cannot be realised
  std::atomic<int> milliseconds_a_frame = 0; ///< drawing takes at least so long
  std::atomic<int> alive = 0;                ///< renderers that exist
  std::atomic<double> beside_ms = -1.0;      ///< what the loop said last that a frame takes beside drawing
};
StandIn& stand_in();

} // namespace cupola::tests
