// A window that shows its output's picture, letterboxed where the window has another shape.
#pragma once

#include <memory>

#include "renderer/outputs/desktop.h"
#include "renderer/outputs/output.h"

namespace cupola::outputs {

struct WindowOptions {
  WindowRequest request;
  Size picture;
  bool vsync = true;
};

/// Main thread. Opens the window; the output is then used on the render thread, with `context` current. Both
/// references must outlive it.
[[nodiscard]] model::Result<std::unique_ptr<Output>> open_window(MainThread& main, Context& context,
                                                                 const WindowOptions& options);

} // namespace cupola::outputs
