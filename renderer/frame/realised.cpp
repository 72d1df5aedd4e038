#include "renderer/frame/realised.h"

#include <algorithm>

#include "renderer/passes/cubemap_pass.h"

namespace cupola::frame {

namespace {

model::Problem too_large(std::string pointer, int limit, long found) {
  return {model::Code::gl_limit,
          std::move(pointer),
          "at most " + std::to_string(limit) + " pixels along an edge",
          std::to_string(found),
          "The driver's limit. Lower the size or quality/supersampling.",
          {},
          {}};
}

model::Problems check_sizes(const Stage& stage, const Device& device) {
  model::Problems problems;
  const int scale = stage.show->quality.supersampling;
  for (const plan::OutputPlan& output : stage.plan->outputs) {
    const long largest = static_cast<long>(std::max(output.width, output.height)) * scale;
    if (largest > device.max_texture)
      problems.push_back(too_large("/outputs/" + output.name + "/width", device.max_texture, largest));
  }
  if (stage.plan->cubemap && stage.plan->cubemap->size > device.max_texture)
    problems.push_back(too_large("/quality/cubemap_size", device.max_texture, stage.plan->cubemap->size));
  return problems;
}

void take_over_scene(Realised& made, const Realised* before) {
  const content::Scene* wanted = made.stage->scene.get();
  if (before && before->scene && &before->scene->scene() == wanted) {
    made.scene = before->scene;
    made.scene_ready = before->scene_ready;
    if (made.anisotropy != before->anisotropy) made.scene->set_anisotropy(made.anisotropy);
    return;
  }
  made.scene = std::make_shared<passes::GpuScene>(made.stage->scene, made.anisotropy);
}

void make_outputs(Realised& made, const Realised* before) {
  const model::Quality& quality = made.stage->show->quality;
  const int samples = passes::clamp_samples(quality.samples);
  for (const plan::OutputPlan& output : made.stage->plan->outputs) {
    if (before) {
      const auto old = before->outputs.find(output.name);
      if (old != before->outputs.end() && old->second->width() == output.width &&
          old->second->height() == output.height && old->second->scale() == quality.supersampling &&
          old->second->samples() == samples) {
        made.outputs.emplace(*old);
        continue;
      }
    }
    made.outputs.emplace(output.name, std::make_shared<passes::OutputTarget>(output.width, output.height,
                                                                             quality.supersampling, samples));
  }
}

void make_cubemap_target(Realised& made, const Realised* before) {
  const plan::Plan& plan = *made.stage->plan;
  if (!plan.cubemap) return;
  const model::Quality& quality = made.stage->show->quality;
  const int samples = passes::clamp_samples(quality.samples);
  const bool layered = quality.cubemap_single_pass && passes::layered_rendering_available();
  int matched = 1;
  for (const plan::OutputPlan& output : plan.outputs)
    for (const plan::ViewportPlan& viewport : output.viewports)
      if (plan::may_use_cubemap(viewport))
        matched = std::max(matched, plan::matched_cubemap_size(viewport.map, viewport.rect));
  made.cubemap_style_scale = static_cast<float>(plan.cubemap->size) / static_cast<float>(matched);
  if (before && before->cubemap && before->cubemap->size() == plan.cubemap->size &&
      before->cubemap->samples() == samples && before->cubemap->layered() == layered &&
      before->cubemap->mipmaps() == quality.cubemap_mipmaps) {
    made.cubemap = before->cubemap;
    return;
  }
  made.cubemap =
      std::make_shared<passes::CubemapTarget>(plan.cubemap->size, samples, layered, quality.cubemap_mipmaps);
}

} // namespace

model::Result<Realised> realise(std::shared_ptr<const Stage> stage, const Realised* before,
                                const Device& device) {
  if (model::Problems problems = check_sizes(*stage, device); !problems.empty())
    return tl::unexpected(problems);
  while (glGetError() != GL_NO_ERROR) {}
  Realised made;
  made.stage = std::move(stage);
  made.anisotropy = std::min(made.stage->show->quality.anisotropy, device.max_anisotropy);
  make_outputs(made, before);
  make_cubemap_target(made, before);
  take_over_scene(made, before);
  if (glGetError() == GL_OUT_OF_MEMORY)
    return model::failure({model::Code::gl_limit,
                           "",
                           "memory on the GPU for this show",
                           "the driver has none left",
                           "Lower sizes, samples or supersampling.",
                           {},
                           {}});
  return made;
}

} // namespace cupola::frame
