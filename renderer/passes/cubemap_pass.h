// The first half of the image-based method: the scene into the faces of a cubemap. Render thread only.
#pragma once

#include "renderer/passes/scene_pass.h"
#include "renderer/passes/targets.h"
#include "renderer/plan/plan.h"

namespace cupola::passes {

/// View axes to face coordinates: (s·w, t·w, w) with w the distance along the face's axis, as GL's table of
/// cubemap faces has them. Faces are mirrored against a perspective view.
[[nodiscard]] glm::dmat3 cube_face_matrix(int face);

/// True when the driver lets a vertex shader choose the layer: faces in a single pass are possible.
[[nodiscard]] bool layered_rendering_available();

/// Draws the faces that are seen, each cropped to what is seen of it. `style_scale`: face pixels per output
/// pixel.
DrawCounts draw_cubemap(ScenePass& pass, const FrameScene& scene, const plan::CubemapPlan& plan,
                        const CubemapTarget& target, const glm::vec3& background, float style_scale);

} // namespace cupola::passes
