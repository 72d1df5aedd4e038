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

/// A cubemap of matched density grows with the picture; its plan knows the show's own supersampling alone.
int cubemap_factor(const model::Show& show, const model::Quality& drawn) {
  return show.quality.automatic && !show.quality.cubemap_size ? drawn.supersampling : 1;
}

model::Problems check_sizes(const Stage& stage, const Device& device, const model::Quality& quality) {
  const int scale = quality.supersampling;
  model::Problems problems;
  for (const plan::OutputPlan& output : stage.plan->outputs) {
    const long largest = static_cast<long>(std::max(output.width, output.height)) * scale;
    if (largest > device.max_texture)
      problems.push_back(too_large("/outputs/" + output.name + "/width", device.max_texture, largest));
  }
  if (!stage.plan->cubemap) return problems;
  const long size = static_cast<long>(stage.plan->cubemap->size) * cubemap_factor(*stage.show, quality);
  if (size > device.max_texture)
    problems.push_back(too_large("/quality/cubemap_size", device.max_texture, size));
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
  const model::Quality& quality = made.quality;
  const int samples = made.samples;
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

plan::CubemapPlan enlarged(plan::CubemapPlan plan, int factor) {
  plan.size *= factor;
  for (plan::CubeFace& face : plan.faces)
    face.crop = {face.crop.x * factor, face.crop.y * factor, face.crop.width * factor,
                 face.crop.height * factor};
  return plan;
}

void make_cubemap_target(Realised& made, const Realised* before) {
  const plan::Plan& plan = *made.stage->plan;
  if (!plan.cubemap) return;
  const model::Quality& quality = made.quality;
  const int samples = made.samples;
  made.cubemap_plan = enlarged(*plan.cubemap, cubemap_factor(*made.stage->show, quality));
  const int size = made.cubemap_plan->size;
  const bool layered = quality.cubemap_single_pass && passes::layered_rendering_available();
  int matched = 1;
  bool folds = false;
  for (const plan::OutputPlan& output : plan.outputs)
    for (const plan::ViewportPlan& viewport : output.viewports)
      if (plan::may_use_cubemap(viewport)) {
        matched = std::max(matched, plan::matched_cubemap_size(viewport.map, viewport.rect));
        folds = folds || projection::folds(viewport.map);
      }
  made.cubemap_style_scale = static_cast<float>(size) / static_cast<float>(matched);
  const passes::CubemapMake make{size, samples, layered, quality.cubemap_mipmaps, folds};
  made.cubemap = before && before->cubemap && before->cubemap->make() == make
                     ? before->cubemap
                     : std::make_shared<passes::CubemapTarget>(make);
}

} // namespace

model::Result<Realised> realise(std::shared_ptr<const Stage> stage, const Realised* before,
                                const Device& device, const model::Quality& quality) {
  if (model::Problems problems = check_sizes(*stage, device, quality); !problems.empty())
    return tl::unexpected(problems);
  while (glGetError() != GL_NO_ERROR) {}
  Realised made;
  made.stage = std::move(stage);
  made.quality = quality;
  made.anisotropy = std::min(quality.anisotropy, device.max_anisotropy);
  made.samples = passes::clamp_samples(quality.samples);
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
