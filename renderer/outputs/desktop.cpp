#include "renderer/outputs/desktop.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

// GLFW must not pull in GL headers of its own.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "renderer/outputs/main_thread.h"

namespace cupola::outputs {

namespace {

std::string last_error() {
  const char* text = nullptr;
  const int code = glfwGetError(&text);
  return code == GLFW_NO_ERROR ? "no reason given" : text ? text : std::to_string(code);
}

model::Problem unavailable(std::string expected, std::string found, std::string advice) {
  return {model::Code::output_unavailable, "", std::move(expected), std::move(found), std::move(advice)};
}

bool display_named() {
  const auto named = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value && *value;
  };
  return named("DISPLAY");
}

bool all_digits(const std::string& text) {
  return !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
}

} // namespace

void Desktop::when_lost(void (*end)()) {
  // GLFW has loaded the library; its headers would be a dependency for one function.
  static void (*ends)() = nullptr;
  ends = end;
  using Handler = int (*)(void*);
  if (void* library = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD)) {
    if (auto* set = reinterpret_cast<Handler (*)(Handler)>(dlsym(library, "XSetIOErrorHandler")))
      set([](void*) {
        ends();
        return 0;
      });
    dlclose(library);
  }
}

Desktop::Desktop(Messages messages)
    : messages_(std::move(messages)) {}

model::Result<std::unique_ptr<Desktop>> Desktop::open(Messages messages) {
  if (!display_named())
    return model::failure(unavailable("a display", "the environment variable DISPLAY is not set",
                                      "Start from a graphical session, or use headless outputs."));
  if (!glfwInit())
    return model::failure(unavailable("a display", last_error(), "Use headless outputs without one."));
  std::unique_ptr<Desktop> desktop(new Desktop(std::move(messages)));
  for (const bool robust : {true, false}) {
    desktop->robust_ = robust;
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    desktop->hidden_ = desktop->make(16, 16, "cupola");
    if (desktop->hidden_) return desktop;
  }
  return model::failure({model::Code::gl_unavailable, "", "a window with OpenGL 4.5 core", last_error(),
                         "Update the driver, or use headless outputs."});
}

Desktop::~Desktop() {
  if (hidden_) glfwDestroyWindow(hidden_);
  glfwTerminate();
}

void Desktop::listen() { glfwPollEvents(); }

std::vector<Monitor> Desktop::monitors() const {
  int count = 0;
  GLFWmonitor** const found = glfwGetMonitors(&count);
  std::vector<Monitor> monitors;
  for (int i = 0; i < count; ++i) {
    Monitor monitor;
    if (const char* name = glfwGetMonitorName(found[i])) monitor.name = name;
    glfwGetMonitorPos(found[i], &monitor.place.x, &monitor.place.y);
    glfwGetMonitorWorkarea(found[i], &monitor.work.x, &monitor.work.y, &monitor.work.width,
                           &monitor.work.height);
    if (const GLFWvidmode* mode = glfwGetVideoMode(found[i])) {
      monitor.place.width = mode->width;
      monitor.place.height = mode->height;
      monitor.refresh_hz = mode->refreshRate;
    }
    monitors.push_back(std::move(monitor));
  }
  return monitors;
}

model::Result<std::size_t> Desktop::find_monitor(const std::string& wanted) const {
  const std::vector<Monitor> all = monitors();
  if (wanted.empty() && !all.empty()) return 0; // GLFW lists the primary one first
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == wanted) return i;
  if (all_digits(wanted) && std::stoul(wanted) < all.size()) return std::stoul(wanted);

  std::string names;
  for (std::size_t i = 0; i < all.size(); ++i)
    names += (i ? ", " : "") + std::to_string(i) + " (" + all[i].name + ')';
  return model::failure(unavailable("one of the monitors " + (names.empty() ? "(none is connected)" : names),
                                    '"' + wanted + '"', "Connect the monitor or name another."));
}

GLFWwindow* Desktop::make(int width, int height, const std::string& title) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  // GLX presents several times faster than EGL on X11 with a software rasteriser.
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_NATIVE_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, robust_ ? GLFW_LOSE_CONTEXT_ON_RESET : GLFW_NO_ROBUSTNESS);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "cupola");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, title.c_str());
  return glfwCreateWindow(width, height, title.c_str(), nullptr, hidden_);
}

model::Result<GLFWwindow*> Desktop::make_window(const WindowRequest& request) {
  const auto monitor = find_monitor(request.monitor);
  if (!monitor) return tl::unexpected(monitor.error());
  const Rect whole = monitors()[*monitor].place;

  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE); // shown once it stands in its place
  glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE); // a wall must not vanish when another window gets focus
  glfwWindowHint(GLFW_DECORATED, request.decorated && !request.fullscreen);
  const Rect place = request.fullscreen ? whole : request.place;
  GLFWwindow* window = make(std::max(1, place.width), std::max(1, place.height), request.title);
  if (!window)
    return model::failure(unavailable("a window of " + std::to_string(place.width) + "x" +
                                          std::to_string(place.height) + " pixels",
                                      last_error(), ""));
  if (request.fullscreen) {
    int count = 0;
    GLFWmonitor** const all = glfwGetMonitors(&count);
    glfwSetWindowMonitor(window, all[*monitor], 0, 0, whole.width, whole.height, GLFW_DONT_CARE);
    glfwSetInputMode(window, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
  } else {
    glfwSetWindowPos(window, whole.x + place.x, whole.y + place.y);
  }
  glfwShowWindow(window);
  return window;
}

void Desktop::destroy_window(GLFWwindow* window) { glfwDestroyWindow(window); }

namespace {

class WindowedContext final : public Context {
public:
  WindowedContext(MainThread& main, std::unique_ptr<Desktop> desktop, Messages messages)
      : Context(std::move(messages))
      , main_(main)
      , desktop_(std::move(desktop)) {}

  ~WindowedContext() override {
    main_.run([this] { desktop_.reset(); });
  }

  model::Result<void> adopt_current() { return adopt("a hidden window"); }

  model::Result<void> make_current() override {
    glfwMakeContextCurrent(desktop_->hidden());
    if (glfwGetCurrentContext() == desktop_->hidden()) return {};
    return model::failure(
        {model::Code::gl_unavailable, "", "a context that can be made current", last_error(), ""});
  }

  void release() override { glfwMakeContextCurrent(nullptr); }

  Desktop* desktop() override { return desktop_.get(); }

private:
  MainThread& main_;
  std::unique_ptr<Desktop> desktop_;
};

} // namespace

model::Result<std::unique_ptr<Context>> Context::make_windowed(MainThread& main, Messages messages) {
  auto desktop = Desktop::open(messages);
  if (!desktop) return tl::unexpected(desktop.error());
  auto context = std::make_unique<WindowedContext>(main, std::move(*desktop), std::move(messages));
  auto current = context->make_current();
  if (current) current = context->adopt_current();
  context->release();
  if (!current) return tl::unexpected(current.error());
  return context;
}

} // namespace cupola::outputs
