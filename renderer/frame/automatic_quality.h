// /quality/automatic: chooses what a stage is drawn with by the time that its frames take. Render thread
// only.
#pragma once

#include "configs/model/show.h"
#include "renderer/frame/device.h"
#include "renderer/frame/draw_timer.h"
#include "renderer/frame/quality_choice.h"
#include "renderer/frame/stage.h"

namespace cupola::frame {

class AutomaticQuality {
public:
  /// `offline`: no rate is to be held, the best is drawn.
  AutomaticQuality(const Device& device, bool offline);

  /// What `stage` is to be drawn with: its own quality, or with `automatic` the level chosen.
  [[nodiscard]] model::Quality of(const Stage& stage) const;

  /// The least that may be drawn with: of(), or with `automatic` the lowest level.
  [[nodiscard]] static model::Quality plainest(const Stage& stage);

  /// A stage whose work is another takes over.
  void restart(const Stage& stage);

  /// Around the drawing of a frame of `stage`. `usual`: nothing was done beside it that other frames do not
  /// do.
  void begin(const Stage& stage);
  void end(const Stage& stage, bool usual);

  /// A frame takes so long for more than drawing.
  void set_beside(double milliseconds) { beside_ms_ = milliseconds; }

  /// What of() asks for cannot be had: it asks for less, until restart().
  void refuse();

private:
  const Device& device_;
  bool offline_;
  QualityChoice choice_;
  DrawTimer timer_;
  double beside_ms_ = 0.0;
};

} // namespace cupola::frame
