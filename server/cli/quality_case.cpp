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

/// The parts of a picture, one below the other; between them pixels with alpha 0.
outputs::ByteImage stacked(const outputs::ByteImage& picture, const std::vector<reference::Rect>& parts) {
  constexpr int gap = 1;
  outputs::ByteImage out;
  for (const reference::Rect& part : parts) {
    out.width = std::max(out.width, part.width);
    out.height += part.height + gap;
  }
  out.rgba.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 4, 0);
  std::size_t row = 0;
  for (const reference::Rect& part : parts) {
    for (int y = part.y; y < part.y + part.height; ++y, ++row)
      std::copy_n(picture.rgba.begin() + 4 * (std::ptrdiff_t{y} * picture.width + std::ptrdiff_t{part.x}),
                  4 * std::ptrdiff_t{part.width},
                  out.rgba.begin() + 4 * static_cast<std::ptrdiff_t>(row) * out.width);
    row += gap;
  }
  return out;
}

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

QualityCase::QualityCase(model::Show show, int poses, int reference_samples, const QualityWorld& world,
                         const Tiles& tiles)
    : show_(std::move(show))
    , world_(world)
    , tiles_(tiles) {
  const auto planned = plan::make_plan(show_);
  if (!planned) {
    print_problems(planned.error());
    return;
  }
  const plan::ViewportPlan& viewport = planned->plan.outputs.front().viewports.front();
  matched_ = plan::matched_cubemap_size(viewport.map, viewport.rect);
  if (tiles_.window.width == 0) tiles_.window = {0, 0, viewport.rect.width, viewport.rect.height};
  reference::Request request;
  request.near = show_.camera.near;
  request.map = viewport.map;
  request.scene = show_.scene;
  request.background = show_.background;
  request.rect = {0, 0, viewport.rect.width, viewport.rect.height};
  request.samples = reference_samples;
  for (int pose = 0; pose < poses; ++pose) {
    const plan::CameraPose camera = plan::camera_at(show_.camera, pose);
    request.eye = camera.position;
    request.orientation = camera.orientation;
    reference::Picture picture(request.rect.width, request.rect.height, glm::dvec3(0.0));
    const std::vector<reference::Rect> parts = tiles_of(pose);
    for (const reference::Rect& part : parts) {
      request.window = part;
      world.tracer->render(request, picture);
    }
    references_.push_back(stacked({picture.width, picture.height, reference::encoded(picture)}, parts));
  }
}

std::vector<reference::Rect> QualityCase::tiles_of(int pose) const {
  const reference::Rect& window = tiles_.window;
  if (tiles_.edge == 0) return {window};
  std::vector<reference::Rect> parts;
  const int across = window.width / tiles_.edge, down = window.height / tiles_.edge;
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x)
      if ((x + 5 * y + 7 * pose) % tiles_.share == 0) // all over the picture, no row or column without
        parts.push_back({window.x + x * tiles_.edge, window.y + y * tiles_.edge, tiles_.edge, tiles_.edge});
  return parts;
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
    drawn_.push_back(stacked(read_picture(renderer.pictures().front()), tiles_of(pose)));
    const reference::Pixels got = pixels(drawn_.back()), wanted = pixels(reference(pose));
    const reference::Comparison compared =
        reference::compare(got, wanted, {.mask = true, .ssim = frames == 0});
    figures.psnr_db += compared.psnr_db / poses;
    if (frames > 0) continue;
    figures.ssim += compared.ssim.value_or(0.0) / poses;
    figures.sharpness += reference::edge_sharpness(got, wanted, true).value_or(0.0) / poses;
  }
  return true;
}

} // namespace cupola::cli
