// A stage as GL objects: what of it needs memory on the GPU. Made beside the running one. Render thread only.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/frame/renderer.h"
#include "renderer/frame/stage.h"
#include "renderer/passes/gpu_scene.h"
#include "renderer/passes/strip_range.h"
#include "renderer/passes/targets.h"

namespace cupola::frame {

/// GL objects of one stage; those that did not change are shared with the stage before.
struct Realised {
  std::shared_ptr<const Stage> stage;
  std::shared_ptr<passes::GpuScene> scene;
  bool scene_ready = false;
  std::map<std::string, std::shared_ptr<passes::OutputTarget>> outputs;
  std::shared_ptr<passes::CubemapTarget> cubemap; ///< null when no viewport wants it
  float cubemap_style_scale = 1.0f;               ///< face pixels per output pixel
  std::optional<plan::CubemapPlan> cubemap_plan; ///< as it is drawn: supersampled too, with automatic quality
  model::Quality quality;                        ///< what it is drawn with
  int anisotropy = 1, samples = 1;               ///< of it, what the driver has
};

/// Makes what `stage` needs to be drawn with `quality` (the show's own, or what /quality/automatic has
/// chosen), taking over from `before` (may be null) what fits. The scene's upload is begun, not done. Fails
/// when a size is beyond the driver's limits.
[[nodiscard]] model::Result<Realised> realise(std::shared_ptr<const Stage> stage, const Realised* before,
                                              const Device& device, const model::Quality& quality);

} // namespace cupola::frame
