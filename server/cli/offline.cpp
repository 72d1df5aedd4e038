#include "server/cli/offline.h"

#include <algorithm>
#include <cstdio>
#include <epoxy/gl.h>
#include <fstream>

#include "renderer/content/scene.h"
#include "renderer/plan/plan.h"

namespace cupola::cli {

void print_problems(const model::Problems& problems) {
  for (const model::Problem& problem : problems)
    std::fprintf(stderr, "%s\n", model::to_text(problem).c_str());
}

model::Result<void> write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  if (stream << text && stream.flush()) return {};
  return model::failure(
      {model::Code::image_unwritable, "", "a file that can be written", file.string(), "", {}, {}});
}

bool parse_pair(const std::string& text, const std::string& between, long& a, long& b) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos) return false;
  try {
    std::size_t end_a = 0, end_b = 0;
    const std::string second = text.substr(at + between.size());
    a = std::stol(text.substr(0, at), &end_a);
    b = std::stol(second, &end_b);
    return end_a == at && end_b == second.size();
  } catch (const std::exception&) { return false; }
}

model::Problem bad_option(const char* option, const char* expected, const std::string& found) {
  return {model::Code::bad_request, "", std::string(option) + ' ' + expected, found, "", {}, {}};
}

model::Problems resize(model::Show& show, const std::string& size) {
  long width = 0, height = 0;
  if (!parse_pair(size, "x", width, height) || width < 1 || height < 1 || width > 16384 || height > 16384)
    return {bad_option("--size", "as WIDTHxHEIGHT, 1x1 to 16384x16384", size)};
  for (auto& [name, output] : show.outputs) {
    output.width = static_cast<int>(width);
    output.height = static_cast<int>(height);
  }
  return {};
}

model::Problem unknown_name(const std::string& pointer, const char* expected, const std::string& found,
                            const std::vector<std::string>& names) {
  const std::string near = model::nearest(found, names);
  const std::string advice = near.empty() ? "" : "Did you mean '" + near + "'?";
  return {model::Code::unknown_reference, pointer, expected, found, advice, {}, {}};
}

model::Problems keep_output(model::Show& show, const std::string& name) {
  if (!show.outputs.contains(name)) {
    std::vector<std::string> names;
    for (const auto& [other, output] : show.outputs) names.push_back(other);
    return {unknown_name("/outputs", "an output of the show", name, names)};
  }
  std::erase_if(show.outputs, [&](const auto& entry) { return entry.first != name; });
  return {};
}

ExitCode exit_of_unloaded(const model::Problems& problems) {
  const auto unread = [](const model::Problem& problem) {
    return problem.code == model::Code::file_unreadable || problem.code == model::Code::file_too_large;
  };
  return std::any_of(problems.begin(), problems.end(), unread) ? exit_unusable : exit_no;
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
