#include "renderer/frame/device.h"

#include <epoxy/gl.h>

#include "renderer/passes/targets.h"

namespace cupola::frame {

Device query_device() {
  Device device;
  const auto text = [](GLenum name) {
    const GLubyte* words = glGetString(name);
    return words ? std::string(reinterpret_cast<const char*>(words)) : std::string();
  };
  device.name = text(GL_RENDERER);
  device.version = text(GL_VERSION);
  for (const char* software : {"llvmpipe", "softpipe", "SWR"})
    if (device.name.find(software) != std::string::npos) device.software = true;
  device.max_samples = passes::clamp_samples(64);
  GLfloat anisotropy = 1.0f;
  if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic") ||
      epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic"))
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &anisotropy);
  device.max_anisotropy = static_cast<int>(anisotropy);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &device.max_texture);
  return device;
}

} // namespace cupola::frame
