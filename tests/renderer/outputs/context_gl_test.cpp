// The surfaceless render context, on whatever driver this machine has.
#include "renderer/outputs/context.h"

#include <doctest/doctest.h>
#include <epoxy/gl.h>

#include <array>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

using namespace cupola;

namespace {

std::unique_ptr<outputs::Context> make(outputs::Messages messages = {}) {
  auto context = outputs::Context::make_headless(std::move(messages));
  if (!context) FAIL(model::to_text(context.error().front()));
  return std::move(*context);
}

/// Clears a small texture to a colour and reads a pixel back.
std::array<unsigned char, 4> clear_and_read(float red, float green) {
  GLuint texture = 0, framebuffer = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_RGBA8, 4, 4);
  glCreateFramebuffers(1, &framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, texture, 0);
  const std::array color{red, green, 0.0f, 1.0f};
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, color.data());
  std::array<unsigned char, 64> pixels{};
  glGetTextureImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.size(), pixels.data());
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &texture);
  return {pixels[0], pixels[1], pixels[2], pixels[3]};
}

} // namespace

TEST_CASE("a headless context draws into textures, needs no display and says what it is") {
  const auto context = make();
  REQUIRE(context->make_current());
  CHECK(context->desktop() == nullptr);
  CHECK(context->describe().find("EGL") == 0);
  CHECK(context->describe().find("OpenGL 4.") != std::string::npos);
  CHECK_FALSE(context->lost());
  CHECK(clear_and_read(1.0f, 0.0f) == std::array<unsigned char, 4>{255, 0, 0, 255});
  context->release();
}

TEST_CASE("a context made on one thread is used on another") {
  const auto context = make();
  std::array<unsigned char, 4> seen{};
  bool current = false;
  std::thread render([&] {
    current = context->make_current().has_value();
    seen = clear_and_read(0.0f, 1.0f);
    context->release();
  });
  render.join();
  CHECK(current);
  CHECK(seen == std::array<unsigned char, 4>{0, 255, 0, 255});
}

TEST_CASE("a context outlives another one of the same display") {
  auto first = make();
  const auto second = make();
  first.reset();
  REQUIRE(second->make_current());
  CHECK(clear_and_read(1.0f, 1.0f) == std::array<unsigned char, 4>{255, 255, 0, 255});
  second->release();
}

TEST_CASE("errors of the driver reach the messages") {
  std::mutex mutex;
  std::vector<std::string> heard;
  const auto context = make([&](outputs::MessageLevel level, std::string_view text) {
    const std::lock_guard lock(mutex);
    if (level == outputs::MessageLevel::error) heard.emplace_back(text);
  });
  REQUIRE(context->make_current());
  glBindTexture(GL_TEXTURE_2D, 4711); // never made
  glFinish();
  CHECK(glGetError() != GL_NO_ERROR);
  context->release();
  const std::lock_guard lock(mutex);
  CHECK_FALSE(heard.empty());
}
