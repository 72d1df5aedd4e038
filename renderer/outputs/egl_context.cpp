// A context without any surface, through EGL.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "renderer/outputs/context.h"

namespace cupola::outputs {

namespace {

/// EGL has one display per platform and process and ends it at the first eglTerminate, whoever else uses it:
/// so uses are counted.
class Display {
public:
  /// EGL_NO_DISPLAY where it cannot be initialised.
  static EGLDisplay open(EGLDisplay display) {
    const std::lock_guard lock(mutex_);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_DISPLAY;
    ++uses_[display];
    return display;
  }
  static void close(EGLDisplay display) {
    const std::lock_guard lock(mutex_);
    if (--uses_[display] == 0) eglTerminate(display);
  }

private:
  static inline std::mutex mutex_;
  static inline std::map<EGLDisplay, int> uses_;
};

/// A context and its display; moved to the one who keeps it, the rest is closed.
struct Egl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string how;

  Egl() = default;
  Egl(Egl&& other) noexcept { swap(other); }
  Egl& operator=(Egl&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Egl() {
    if (display == EGL_NO_DISPLAY) return;
    if (context != EGL_NO_CONTEXT) {
      if (eglGetCurrentContext() == context)
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(display, context);
    }
    Display::close(display);
  }

private:
  void swap(Egl& other) noexcept {
    std::swap(display, other.display);
    std::swap(context, other.context);
    std::swap(how, other.how);
  }
};

EGLContext create_context(EGLDisplay display) {
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
    const std::array wanted{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
  }
  // First with notice of a GPU reset; not every driver has that.
  for (const bool robust : {true, false}) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       4,
                                   EGL_CONTEXT_MINOR_VERSION,       5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (robust)
      attributes.insert(attributes.end(),
                        {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                         EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    attributes.push_back(EGL_NONE);
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

/// Initialises the display and leaves a new context of it current; no context where that fails.
Egl try_display(EGLDisplay display, std::string how) {
  Egl egl;
  egl.display = Display::open(display);
  if (egl.display == EGL_NO_DISPLAY) return egl;
  egl.how = std::move(how);
  if (!eglBindAPI(EGL_OPENGL_API)) return egl;
  egl.context = create_context(display);
  if (egl.context == EGL_NO_CONTEXT) return egl;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl.context)) {
    eglDestroyContext(display, std::exchange(egl.context, EGL_NO_CONTEXT));
  }
  return egl;
}

bool software_renderer() {
  const auto* text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view name = text ? text : "";
  return name.find("llvmpipe") != name.npos || name.find("softpipe") != name.npos;
}

/// EGL devices that are not a software rasteriser, in the driver's order, then the software ones.
std::vector<EGLDeviceEXT> devices() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base"))
    return {};
  std::array<EGLDeviceEXT, 32> found{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(found.size()), found.data(), &count)) return {};
  std::vector<EGLDeviceEXT> hardware, software;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDeviceEXT device = found[static_cast<std::size_t>(i)];
    const char* text = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    const bool soft =
        text && std::string_view(text).find("EGL_MESA_device_software") != std::string_view::npos;
    (soft ? software : hardware).push_back(device);
  }
  hardware.insert(hardware.end(), software.begin(), software.end());
  return hardware;
}

class HeadlessContext final : public Context {
public:
  HeadlessContext(Egl egl, Messages messages)
      : Context(std::move(messages))
      , egl_(std::move(egl)) {}

  model::Result<void> adopt_current() { return adopt(egl_.how); }

  model::Result<void> make_current() override {
    // The API is a property of the thread.
    if (eglBindAPI(EGL_OPENGL_API) &&
        eglMakeCurrent(egl_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl_.context))
      return {};
    return model::failure({model::Code::gl_unavailable, "", "a context that can be made current",
                           "EGL error " + std::to_string(eglGetError()), ""});
  }

  void release() override {
    eglBindAPI(EGL_OPENGL_API);
    eglMakeCurrent(egl_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

private:
  Egl egl_;
};

/// The best context there is, current; or none.
Egl find_context() {
  Egl best;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    best = try_display(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                       "EGL surfaceless");
    if (best.context != EGL_NO_CONTEXT && !software_renderer()) return best;
  }
  int index = 0;
  for (const EGLDeviceEXT device : devices()) {
    Egl next = try_display(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr),
                           "EGL device " + std::to_string(index++));
    if (next.context == EGL_NO_CONTEXT) continue;
    if (best.context == EGL_NO_CONTEXT || !software_renderer()) {
      std::swap(best, next);
      break;
    }
  }
  return best;
}

} // namespace

model::Result<std::unique_ptr<Context>> Context::make_headless(Messages messages) {
  if (!epoxy_has_egl())
    return model::failure(
        {model::Code::gl_unavailable, "", "the library libEGL.so.1", "no such library", "Install libegl1."});
  Egl egl = find_context();
  if (egl.context == EGL_NO_CONTEXT)
    return model::failure({model::Code::gl_unavailable, "", "an EGL device with OpenGL 4.5 core", "none",
                           "Install the GPU's driver or Mesa (libgl1-mesa-dri), and give the user access to "
                           "/dev/dri (groups video and render)."});
  auto context = std::make_unique<HeadlessContext>(std::move(egl), std::move(messages));
  auto current = context->make_current();
  if (current) current = context->adopt_current();
  context->release();
  if (!current) return tl::unexpected(current.error());
  return context;
}

} // namespace cupola::outputs
