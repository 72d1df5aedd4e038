#include "server/cli/offline.h"

#include <algorithm>
#include <cstdio>
#include <epoxy/gl.h>

#include "renderer/content/scene.h"
#include "renderer/plan/plan.h"

namespace cupola::cli {

void print_problems(const model::Problems& problems) {
  for (const model::Problem& problem : problems)
    std::fprintf(stderr, "%s\n", model::to_text(problem).c_str());
}

model::Result<OfflineRenderer> make_offline_renderer(frame::RendererOptions options) {
  OfflineRenderer made;
  const auto report = [](outputs::MessageLevel level, std::string_view words) {
    if (level == outputs::MessageLevel::error)
      std::fprintf(stderr, "%.*s\n", static_cast<int>(words.size()), words.data());
  };
  auto context = outputs::Context::make_headless(report);
  if (!context) return tl::unexpected(context.error());
  made.context = std::move(*context);
  if (auto current = made.context->make_current(); !current) return tl::unexpected(current.error());
  options.offline = true;
  auto renderer = frame::Renderer::make(std::move(options));
  if (!renderer) return tl::unexpected(renderer.error());
  made.renderer = std::move(*renderer);
  return made;
}

model::Result<std::shared_ptr<const frame::Stage>> make_stage(const model::Show& show,
                                                              const std::filesystem::path& folder,
                                                              std::shared_ptr<const content::Scene> scene,
                                                              Warnings warnings) {
  auto planned = plan::make_plan(show);
  if (!planned) return tl::unexpected(planned.error());
  if (warnings == Warnings::printed) print_problems(planned->warnings);
  if (!scene) {
    auto loaded = content::load_scene(show.scene.content, folder);
    if (!loaded) return tl::unexpected(loaded.error());
    if (warnings == Warnings::printed) print_problems(loaded->warnings);
    scene = loaded->scene;
  }
  auto stage = std::make_shared<frame::Stage>();
  stage->revision = 1;
  stage->show = std::make_shared<model::Show>(show);
  stage->plan = std::make_shared<plan::Plan>(std::move(planned->plan));
  stage->scene = std::move(scene);
  return stage;
}

outputs::ByteImage read_picture(const frame::Picture& picture) {
  outputs::ByteImage image;
  image.width = picture.width;
  image.height = picture.height;
  image.rgba.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(picture.texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(image.rgba.size()),
                    image.rgba.data());
  const std::size_t row = static_cast<std::size_t>(picture.width) * 4;
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height) / 2; ++y)
    std::swap_ranges(image.rgba.begin() + static_cast<std::ptrdiff_t>(y * row),
                     image.rgba.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                     image.rgba.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
  return image;
}

} // namespace cupola::cli
