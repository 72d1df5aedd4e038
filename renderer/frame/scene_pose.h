// What moves in a scene, where it is in this frame. Render thread.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "renderer/content/scene.h"
#include "renderer/passes/gpu_scene.h"

namespace cupola::frame {

class ScenePose {
public:
  /// Places what moves with time and with the eye, here and on the GPU, unless it stands so already.
  void place(const std::shared_ptr<passes::GpuScene>& scene, double time, const glm::vec3& eye);

  /// As last placed; empty for a scene in which nothing moves.
  [[nodiscard]] const content::Pose& pose() const { return pose_; }

private:
  struct Placed {
    std::shared_ptr<passes::GpuScene> scene; ///< null: nothing is placed
    double time = 0.0;
    glm::vec3 eye{0.0f};
    bool operator==(const Placed&) const = default;
  };

  Placed placed_;
  content::Pose pose_;
};

} // namespace cupola::frame
