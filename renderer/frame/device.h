// What the current OpenGL context can do.
#pragma once

#include <string>

namespace cupola::frame {

/// The driver, in words and limits.
struct Device {
  std::string name;    ///< GL_RENDERER
  std::string version; ///< GL_VERSION
  bool software = false;
  int max_samples = 1;
  int max_anisotropy = 1;
  int max_texture = 0; ///< pixels along an edge
};

/// Asks the current context. Render thread.
[[nodiscard]] Device query_device();

} // namespace cupola::frame
