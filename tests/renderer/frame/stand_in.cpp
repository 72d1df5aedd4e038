#include "tests/renderer/frame/stand_in.h"

#include <epoxy/gl.h>

#include <array>
#include <chrono>
#include <thread>
#include <utility>

#include "renderer/frame/renderer.h"

namespace cupola::tests {

StandIn& stand_in() {
  static StandIn one;
  return one;
}

} // namespace cupola::tests

namespace cupola::frame {

struct Renderer::Impl {
  Device device{"stand-in", "4.5", true, 1, 1, 1024};
  std::shared_ptr<const Stage> drawn, waiting;
  int frames_left = 0;
  model::Problems problems;
  std::vector<Picture> pictures;
  GLuint framebuffer = 0;

  void remove_pictures() {
    for (const Picture& picture : pictures) glDeleteTextures(1, &picture.texture);
    pictures.clear();
  }

  void realise() {
    if (waiting->revision == tests::stand_in().fails_at) {
      problems.push_back({model::Code::gl_limit, "", "a show that can be realised", "one that cannot", ""});
      waiting.reset();
      return;
    }
    drawn = std::exchange(waiting, nullptr);
    remove_pictures();
    for (const auto& [name, output] : drawn->show->outputs) {
      Picture picture{name, 0, output.width, output.height};
      glCreateTextures(GL_TEXTURE_2D, 1, &picture.texture);
      glTextureStorage2D(picture.texture, 1, GL_SRGB8_ALPHA8, output.width, output.height);
      pictures.push_back(picture);
    }
  }
};

Renderer::Renderer(std::unique_ptr<Impl> impl)
    : impl_(std::move(impl)) {
  ++tests::stand_in().alive;
}
Renderer::~Renderer() {
  impl_->remove_pictures();
  glDeleteFramebuffers(1, &impl_->framebuffer);
  --tests::stand_in().alive;
}

model::Result<std::unique_ptr<Renderer>>
Renderer::make(RendererOptions /*options*/) { // NOLINT(performance-unnecessary-value-param): as the real one
  auto impl = std::make_unique<Impl>();
  glCreateFramebuffers(1, &impl->framebuffer);
  return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

const Device& Renderer::device() const { return impl_->device; }

void Renderer::set_stage(std::shared_ptr<const Stage> stage) {
  impl_->waiting = std::move(stage);
  impl_->frames_left = impl_->drawn ? tests::stand_in().frames_to_realise.load() : 0;
  if (impl_->frames_left == 0) impl_->realise();
}

model::Problems Renderer::take_problems() { return std::exchange(impl_->problems, {}); }

FrameStatistics Renderer::draw(double) {
  if (impl_->waiting && --impl_->frames_left <= 0) impl_->realise();
  std::this_thread::sleep_for(std::chrono::milliseconds(tests::stand_in().milliseconds_a_frame));
  if (!impl_->drawn) return {};
  const auto& background = impl_->drawn->show->background;
  const std::array color{static_cast<float>(background.x), static_cast<float>(background.y),
                         static_cast<float>(background.z), 1.0f};
  glEnable(GL_FRAMEBUFFER_SRGB);
  for (const Picture& picture : impl_->pictures) {
    glNamedFramebufferTexture(impl_->framebuffer, GL_COLOR_ATTACHMENT0, picture.texture, 0);
    glClearNamedFramebufferfv(impl_->framebuffer, GL_COLOR, 0, color.data());
  }
  FrameStatistics statistics;
  statistics.revision = impl_->drawn->revision;
  statistics.uploading = impl_->waiting != nullptr;
  return statistics;
}

const std::vector<Picture>& Renderer::pictures() const { return impl_->pictures; }
void Renderer::set_beside(double milliseconds) { tests::stand_in().beside_ms = milliseconds; }

} // namespace cupola::frame
