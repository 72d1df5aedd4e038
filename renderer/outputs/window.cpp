#include "renderer/outputs/window.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <atomic>
#include <utility>

#include "renderer/outputs/main_thread.h"

namespace cupola::outputs {

namespace {

/// What the window system reports on the main thread and the render thread reads.
struct Reported {
  std::string name;
  Messages messages;
  std::atomic<std::uint64_t> size{0}; ///< width in the upper half, height in the lower: read as one value

  void resize(int width, int height) {
    size = static_cast<std::uint64_t>(static_cast<std::uint32_t>(width)) << 32 |
           static_cast<std::uint32_t>(height);
  }
  [[nodiscard]] Size framebuffer() const {
    const std::uint64_t both = size;
    return {static_cast<int>(both >> 32), static_cast<int>(both & 0xffffffffu)};
  }
};

Reported& reported(GLFWwindow* window) { return *static_cast<Reported*>(glfwGetWindowUserPointer(window)); }

void on_resize(GLFWwindow* window, int width, int height) { reported(window).resize(width, height); }

/// The show decides which outputs there are: a click must not take a projector out.
void on_close(GLFWwindow* window) {
  glfwSetWindowShouldClose(window, GLFW_FALSE);
  const Reported& state = reported(window);
  if (state.messages)
    state.messages(MessageLevel::info, "window '" + state.name +
                                           "': closing is ignored; remove the output from the show, or stop "
                                           "the daemon");
}

class Window final : public Output {
public:
  Window(MainThread& main, Context& context, GLFWwindow* window, const WindowOptions& options,
         Monitor monitor)
      : main_(main)
      , context_(context)
      , window_(window)
      , monitor_(std::move(monitor))
      , vsync_(options.vsync)
      , reported_(std::make_shared<Reported>()) {
    reported_->name = options.request.title;
    reported_->messages = context.desktop()->messages();
    const std::string size =
        std::to_string(options.picture.width) + "x" + std::to_string(options.picture.height);
    description_ = (options.request.fullscreen ? "full-screen window, " : "window, ") + size +
                   " on monitor " + monitor_.name;
    glfwSetWindowUserPointer(window, reported_.get());
    glfwSetFramebufferSizeCallback(window, &on_resize);
    glfwSetWindowCloseCallback(window, &on_close);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    reported_->resize(width, height);
  }

  /// The window lives until the main thread has time for it; so does what its callbacks use.
  ~Window() override {
    main_.post([window = window_, desktop = context_.desktop(), state = reported_] {
      desktop->destroy_window(window);
    });
  }

  std::string describe() const override { return description_; }

  void draw(const Frame& frame) override {
    const GLsync drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush(); // or the other context would wait for a fence that was never sent
    glfwMakeContextCurrent(window_);
    if (framebuffer_ == 0) set_up();
    if (interval_changed_) {
      glfwSwapInterval(waiting_ ? 1 : 0);
      interval_changed_ = false;
    }
    glWaitSync(drawn, 0, GL_TIMEOUT_IGNORED);
    blit(frame);
    const GLsync taken = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    back();
    glWaitSync(taken, 0, GL_TIMEOUT_IGNORED); // the next frame must not overwrite what is being read
    glDeleteSync(drawn);
    glDeleteSync(taken);
  }

  void present() override {
    glfwMakeContextCurrent(window_);
    glfwSwapBuffers(window_);
    back();
    ++presented_;
  }

  bool can_wait() const override { return vsync_; }
  void set_waiting(bool waiting) override {
    if (waiting == waiting_) return;
    waiting_ = waiting;
    interval_changed_ = true;
  }
  Pace pace() const override { return {waiting_ ? monitor_.refresh_hz : 0.0}; }
  Counters counters() const override { return {presented_, 0}; }

private:
  void set_up() {
    listen_to_driver(reported_->messages);
    glCreateFramebuffers(1, &framebuffer_); // dies with the window's context
    glDisable(GL_FRAMEBUFFER_SRGB);         // the picture holds encoded values; they go through unchanged
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  }

  void blit(const Frame& frame) {
    const Size size = reported_->framebuffer();
    const Rect to = letterbox({frame.width, frame.height}, size);
    if (to.width == 0) return; // iconified
    // Attached anew each frame: that is when this context sees what the other one has drawn.
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, frame.texture, 0);
    if (to != Rect{0, 0, size.width, size.height}) glClear(GL_COLOR_BUFFER_BIT);
    const bool same_size = to.width == frame.width && to.height == frame.height;
    glBlitNamedFramebuffer(framebuffer_, 0, 0, 0, frame.width, frame.height, to.x, to.y, to.x + to.width,
                           to.y + to.height, GL_COLOR_BUFFER_BIT, same_size ? GL_NEAREST : GL_LINEAR);
  }

  void back() {
    // It was current a moment ago; should the driver have lost it, the loop sees that at the frame's end.
    [[maybe_unused]] const auto current = context_.make_current();
  }

  MainThread& main_;
  Context& context_;
  GLFWwindow* window_;
  Monitor monitor_;
  std::string description_;
  bool vsync_, waiting_ = false, interval_changed_ = true;
  std::shared_ptr<Reported> reported_;
  unsigned framebuffer_ = 0;
  std::uint64_t presented_ = 0;
};

} // namespace

model::Result<std::unique_ptr<Output>> open_window(MainThread& main, Context& context,
                                                   const WindowOptions& options) {
  Desktop& desktop = *context.desktop();
  const auto monitor = desktop.find_monitor(options.request.monitor);
  if (!monitor) return tl::unexpected(monitor.error());
  const auto window = desktop.make_window(options.request);
  if (!window) return tl::unexpected(window.error());
  return std::make_unique<Window>(main, context, *window, options, desktop.monitors()[*monitor]);
}

} // namespace cupola::outputs
