// From the live show to what the renderer draws. Render thread.
#pragma once

#include <memory>

#include "renderer/frame/stage.h"
#include "server/state/live_state.h"

namespace cupola::daemon {

class Stages {
public:
  explicit Stages(const state::LiveState& live)
      : live_(live) {}

  /// The newest; the same pointer as long as the revision is the same.
  [[nodiscard]] std::shared_ptr<const frame::Stage> newest() {
    const auto snapshot = live_.current();
    if (!stage_ || snapshot->revision != stage_->revision)
      stage_ = std::make_shared<const frame::Stage>(
          frame::Stage{snapshot->revision, snapshot->show, snapshot->plan,
                       std::static_pointer_cast<const content::Scene>(snapshot->resources)});
    return stage_;
  }

private:
  const state::LiveState& live_;
  std::shared_ptr<const frame::Stage> stage_;
};

} // namespace cupola::daemon
