// What the render thread needs to draw one revision of the show; made beside it, immutable.
#pragma once

#include <memory>

#include "configs/model/show.h"
#include "renderer/content/scene.h"
#include "renderer/plan/plan.h"

namespace cupola::frame {

struct Stage {
  std::uint64_t revision = 0;
  std::shared_ptr<const model::Show> show;
  std::shared_ptr<const plan::Plan> plan;
  std::shared_ptr<const content::Scene> scene;
};

} // namespace cupola::frame
