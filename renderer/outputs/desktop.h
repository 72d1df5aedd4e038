// The window system, through GLFW: monitors, windows, and the hidden window whose context the render thread
// uses. Main thread only, unless a comment says otherwise.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "renderer/outputs/context.h"
#include "renderer/outputs/layout.h"

struct GLFWwindow;

namespace cupola::outputs {

struct Monitor {
  std::string name;
  Rect place;              ///< on the virtual screen, pixels, y downwards
  Rect work;               ///< the part that no panel covers
  double refresh_hz = 0.0; ///< 0: the system does not say
};

/// What a window is made with.
struct WindowRequest {
  std::string title;
  std::string monitor;     ///< name, or index from 0 as text; "" is the primary one
  bool fullscreen = false; ///< covers the monitor; `place` is ignored
  bool decorated = true;
  Rect place; ///< pixels from the monitor's top left corner
};

/// Windows have contexts of their own that share the hidden window's objects. GLFW keeps one state for the
/// whole process, so there is at most one Desktop at a time.
class Desktop {
public:
  /// Fails, quietly and at once, without a display.
  [[nodiscard]] static model::Result<std::unique_ptr<Desktop>> open(Messages messages);
  ~Desktop();
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;

  /// Called on whichever thread notices that the display is gone, before the process ends: it must end it.
  /// The X library gives no other choice.
  static void when_lost(void (*end)());

  /// Handles what the window system has to say. Call it some tens of times a second.
  void listen();

  [[nodiscard]] std::vector<Monitor> monitors() const;

  /// Index into monitors() of a name, an index as text, or "" for the primary one; a problem naming those
  /// that exist otherwise.
  [[nodiscard]] model::Result<std::size_t> find_monitor(const std::string& wanted) const;

  [[nodiscard]] model::Result<GLFWwindow*> make_window(const WindowRequest& request);
  /// The window's context must not be current anywhere.
  void destroy_window(GLFWwindow* window);

  /// The window whose context the render thread uses.
  [[nodiscard]] GLFWwindow* hidden() const { return hidden_; }
  [[nodiscard]] const Messages& messages() const { return messages_; }

private:
  explicit Desktop(Messages messages);
  GLFWwindow* make(int width, int height, const std::string& title);

  Messages messages_;
  GLFWwindow* hidden_ = nullptr;
  bool robust_ = true; ///< with notice of a GPU reset; all contexts alike, or they could not share
};

} // namespace cupola::outputs
