#include "renderer/outputs/readback.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <atomic>

namespace cupola::outputs {

struct Readback::Buffer {
  std::atomic<bool> busy = false; ///< set on the render thread, cleared by whoever lets the pixels go
  unsigned id = 0;
  std::size_t size = 0;
  const std::uint8_t* mapped = nullptr;
  GLsync done = nullptr;
  int width = 0, height = 0;
  std::uint64_t tag = 0;

  void reserve(std::size_t bytes) {
    if (size >= bytes) return;
    glDeleteBuffers(1, &id);
    glCreateBuffers(1, &id);
    constexpr GLbitfield access = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes), nullptr, access);
    mapped = static_cast<const std::uint8_t*>(
        glMapNamedBufferRange(id, 0, static_cast<GLsizeiptr>(bytes), access));
    size = mapped ? bytes : 0;
  }
};

std::vector<std::uint8_t> to_rgb(const Pixels& pixels) {
  const auto width = static_cast<std::size_t>(pixels.width), height = static_cast<std::size_t>(pixels.height);
  std::vector<std::uint8_t> rgb(width * height * 3);
  std::uint8_t* out = rgb.data();
  for (std::size_t y = height; y-- > 0;) {
    const std::uint8_t* in = pixels.rgba + y * width * 4;
    for (std::size_t x = 0; x < width; ++x, in += 4, out += 3) {
      out[0] = in[0];
      out[1] = in[1];
      out[2] = in[2];
    }
  }
  return rgb;
}

Readback::Readback(std::size_t buffers) {
  for (std::size_t i = 0; i < buffers; ++i) buffers_.push_back(std::make_shared<Buffer>());
  glCreateFramebuffers(1, &source_);
  glCreateFramebuffers(1, &target_);
}

Readback::~Readback() {
  for (const auto& buffer : buffers_) {
    if (buffer->done) glDeleteSync(buffer->done);
    glDeleteBuffers(1, &buffer->id);
  }
  glDeleteFramebuffers(1, &source_);
  glDeleteFramebuffers(1, &target_);
  glDeleteTextures(1, &ping_.texture);
  glDeleteTextures(1, &pong_.texture);
}

unsigned Readback::scratch(Scratch& target, int width, int height) {
  if (target.width != width || target.height != height) {
    glDeleteTextures(1, &target.texture);
    glCreateTextures(GL_TEXTURE_2D, 1, &target.texture);
    glTextureStorage2D(target.texture, 1, GL_SRGB8_ALPHA8, width, height);
    target.width = width;
    target.height = height;
  }
  return target.texture;
}

void Readback::blit(unsigned from, int from_width, int from_height, unsigned to, int to_width,
                    int to_height) {
  glNamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, from, 0);
  glNamedFramebufferTexture(target_, GL_COLOR_ATTACHMENT0, to, 0);
  glBlitNamedFramebuffer(source_, target_, 0, 0, from_width, from_height, 0, 0, to_width, to_height,
                         GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

/// By halves, then the rest: a single bilinear step would skip pixels. Averaged in linear light.
unsigned Readback::scaled_down(const Frame& frame, int width, int height) {
  const bool scissor = glIsEnabled(GL_SCISSOR_TEST), encoding = glIsEnabled(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  unsigned from = frame.texture;
  int from_width = frame.width, from_height = frame.height;
  Scratch* next = &ping_;
  while (from_width > width || from_height > height) {
    const int to_width = std::max(width, from_width / 2), to_height = std::max(height, from_height / 2);
    const unsigned to = scratch(*next, to_width, to_height);
    blit(from, from_width, from_height, to, to_width, to_height);
    from = to;
    from_width = to_width;
    from_height = to_height;
    next = next == &ping_ ? &pong_ : &ping_;
  }
  if (!encoding) glDisable(GL_FRAMEBUFFER_SRGB);
  if (scissor) glEnable(GL_SCISSOR_TEST);
  return from;
}

bool Readback::start(const Frame& frame, std::optional<int> max_width, std::uint64_t tag) {
  const auto free =
      std::find_if(buffers_.begin(), buffers_.end(), [](const auto& buffer) { return !buffer->busy; });
  if (free == buffers_.end()) return false;
  Buffer& buffer = **free;
  buffer.width = frame.width;
  buffer.height = frame.height;
  unsigned texture = frame.texture;
  if (max_width && *max_width > 0 && *max_width < frame.width) {
    buffer.width = *max_width;
    buffer.height =
        std::max(1, static_cast<int>(static_cast<std::int64_t>(frame.height) * *max_width / frame.width));
    texture = scaled_down(frame, buffer.width, buffer.height);
  }
  const std::size_t bytes =
      static_cast<std::size_t>(buffer.width) * static_cast<std::size_t>(buffer.height) * 4;
  buffer.reserve(bytes);
  if (!buffer.mapped) return false;
  buffer.tag = tag;

  GLint bound = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &bound);
  glNamedFramebufferTexture(source_, GL_COLOR_ATTACHMENT0, texture, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.id);
  glReadPixels(0, 0, buffer.width, buffer.height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(bound));
  buffer.done = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  buffer.busy = true;
  under_way_.push_back(*free);
  return true;
}

std::optional<Pixels> Readback::take() {
  if (under_way_.empty()) return std::nullopt;
  const std::shared_ptr<Buffer> buffer = under_way_.front();
  const GLenum state = glClientWaitSync(buffer->done, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  if (state == GL_TIMEOUT_EXPIRED) return std::nullopt;
  glDeleteSync(buffer->done);
  buffer->done = nullptr;
  under_way_.erase(under_way_.begin());
  Pixels pixels{buffer->mapped, buffer->width, buffer->height, buffer->tag, nullptr};
  pixels.hold = std::shared_ptr<void>(nullptr, [buffer](void*) { buffer->busy = false; });
  return pixels;
}

} // namespace cupola::outputs
