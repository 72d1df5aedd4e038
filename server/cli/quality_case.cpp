#include "server/cli/quality_case.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "renderer/content/scene.h"
#include "renderer/plan/camera.h"
#include "renderer/plan/plan.h"
#include "renderer/reference/compare.h"
#include "renderer/reference/sharpness.h"
#include "server/cli/bench_show.h"
#include "server/cli/offline.h"

namespace cupola::cli {

namespace {

constexpr double room_scale = 2.6 / 60.0; ///< of the way round the city

reference::Pixels pixels(const outputs::ByteImage& image) { return {image.rgba, image.width, image.height}; }

} // namespace

QualityWorld make_world(const model::Content& content) {
  auto loaded = content::load_scene(content, ".");
  if (!loaded) {
    print_problems(loaded.error());
    return {};
  }
  return {loaded->scene, std::make_unique<reference::Tracer>(loaded->scene)};
}

model::Show quality_show(const model::Content& content, const model::Style& style, const model::Shape& shape,
                         int width, int height, int poses) {
  model::Show show = city_show(shape, width, height, poses);
  show.scene.content = content;
  show.scene.style = style;
  show.camera.loop = false;
  show.camera.path.pop_back();
  if (std::holds_alternative<model::Room>(content))
    for (model::Keyframe& key : show.camera.path)
      key.position = {key.position.x * room_scale, (key.position.y - 12.0) / 12.0,
                      key.position.z * room_scale};
  return show;
}

QualityCase::QualityCase(model::Show show, int poses, int reference_samples, const QualityWorld& world)
    : show_(std::move(show))
    , world_(world)
    , mask_(std::holds_alternative<model::Fisheye>(show_.projections["view"].shape)) {
  const auto planned = plan::make_plan(show_);
  if (!planned) {
    print_problems(planned.error());
    return;
  }
  const plan::ViewportPlan& viewport = planned->plan.outputs.front().viewports.front();
  matched_ = plan::matched_cubemap_size(viewport.map, viewport.rect);
  for (int pose = 0; pose < poses; ++pose) {
    const plan::CameraPose camera = plan::camera_at(show_.camera, pose);
    reference::Request request;
    request.eye = camera.position;
    request.orientation = camera.orientation;
    request.near = show_.camera.near;
    request.map = viewport.map;
    request.scene = show_.scene;
    request.background = show_.background;
    request.rect = {0, 0, viewport.rect.width, viewport.rect.height};
    request.samples = reference_samples;
    reference::Picture picture(request.rect.width, request.rect.height, glm::dvec3(0.0));
    world.tracer->render(request, picture);
    references_.push_back({picture.width, picture.height, reference::encoded(picture)});
  }
}

bool QualityCase::measure(frame::Renderer& renderer, const QualitySetting& setting, int poses, int frames,
                          QualityFigures& figures) {
  viewport_of(show_).method = setting.method;
  show_.quality.samples = setting.samples;
  show_.quality.supersampling = setting.supersampling;
  show_.quality.anisotropy = setting.anisotropy;
  show_.quality.cubemap_mipmaps = setting.mipmaps;
  show_.quality.cubemap_size = std::max(static_cast<int>(std::lround(matched_ * setting.cubemap_scale)), 16);
  auto stage = make_stage(show_, ".", world_.scene);
  if (!stage) {
    print_problems(stage.error());
    return false;
  }
  renderer.set_stage(*stage);
  figures = {};
  drawn_.clear();
  for (int i = 0; i < poses; ++i) {
    const int pose = i * this->poses() / poses;
    renderer.draw(pose);
    if (model::Problems failed = renderer.take_problems(); !failed.empty()) {
      print_problems(failed);
      return false;
    }
    if (frames > 0) figures.milliseconds += quickest_frame(renderer, frames, pose) / poses;
    drawn_.push_back(read_picture(renderer.pictures().front()));
    const reference::Pixels got = pixels(drawn_.back()), wanted = pixels(reference(pose));
    const reference::Comparison compared =
        reference::compare(got, wanted, {.mask = mask_, .ssim = frames == 0});
    figures.psnr_db += compared.psnr_db / poses;
    if (frames > 0) continue;
    figures.ssim += compared.ssim.value_or(0.0) / poses;
    figures.sharpness += reference::edge_sharpness(got, wanted, mask_).value_or(0.0) / poses;
  }
  return true;
}

} // namespace cupola::cli
