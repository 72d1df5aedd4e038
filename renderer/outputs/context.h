// The render context: OpenGL 4.5 core without a window, or shared with windows. Made on the main thread, then
// made current on the render thread and used there alone.
// Without windows the default framebuffer is incomplete: everything is drawn into framebuffer objects.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "configs/model/problem.h"

namespace cupola::outputs {

class Desktop;
class MainThread;

enum class MessageLevel : std::uint8_t { info, warning, error };

/// Where messages of the driver and of outputs go. Called on any thread; must not block.
using Messages = std::function<void(MessageLevel, std::string_view)>;

class Context {
public:
  /// EGL without any surface: Mesa's surfaceless platform, or the first EGL device that works; hardware is
  /// preferred to a software rasteriser. Needs no display.
  [[nodiscard]] static model::Result<std::unique_ptr<Context>> make_headless(Messages messages);

  /// A hidden window's context, whose objects all windows share. Main thread. Fails without a display.
  /// `main` must outlive the context.
  [[nodiscard]] static model::Result<std::unique_ptr<Context>> make_windowed(MainThread& main,
                                                                             Messages messages);
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Binds the context to the calling thread; it must not be current on another one.
  [[nodiscard]] virtual model::Result<void> make_current() = 0;
  virtual void release() = 0;

  /// How it was made, with the driver's name: "EGL surfaceless, llvmpipe (…), OpenGL 4.5 …".
  [[nodiscard]] const std::string& describe() const { return description_; }

  /// Where windows can be opened; nullptr without a display.
  [[nodiscard]] virtual Desktop* desktop() { return nullptr; }

  /// The driver has reset the GPU: no object of this context is good any more. With it current.
  [[nodiscard]] bool lost() const;

protected:
  explicit Context(Messages messages)
      : messages_(std::move(messages)) {}

  /// With the context current for the first time: checks the version, sends the driver's messages on.
  [[nodiscard]] model::Result<void> adopt(const std::string& how);

  Messages messages_;
  std::string description_;
};

/// Sends the driver's messages (KHR_debug) of the current context to `messages`, which must outlive it.
void listen_to_driver(const Messages& messages);

} // namespace cupola::outputs
