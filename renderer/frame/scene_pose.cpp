#include "renderer/frame/scene_pose.h"

#include <utility>

namespace cupola::frame {

void ScenePose::place(const std::shared_ptr<passes::GpuScene>& scene, double time, const glm::vec3& eye) {
  const content::Scene& what = scene->scene();
  if (!what.rig) {
    placed_ = {};
    pose_.vertices.clear();
    return;
  }
  Placed wanted{scene, what.duration > 0.0 ? time : 0.0, eye};
  if (placed_ == wanted) return;
  content::pose(what, time, eye, pose_);
  scene->set_moving_vertices(pose_.vertices);
  placed_ = std::move(wanted);
}

} // namespace cupola::frame
