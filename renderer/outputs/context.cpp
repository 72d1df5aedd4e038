#include "renderer/outputs/context.h"

#include <epoxy/gl.h>

namespace cupola::outputs {

namespace {

MessageLevel level_of(GLenum type, GLenum severity) {
  if (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH) return MessageLevel::error;
  if (severity == GL_DEBUG_SEVERITY_MEDIUM) return MessageLevel::warning;
  return MessageLevel::info;
}

void APIENTRY pass_on(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                      const void* user) {
  const auto size = length < 0 ? std::string_view(text).size() : static_cast<std::size_t>(length);
  (*static_cast<const Messages*>(user))(level_of(type, severity), std::string_view(text, size));
}

std::string words(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "";
}

} // namespace

void listen_to_driver(const Messages& messages) {
  if (!messages) return;
  glEnable(GL_DEBUG_OUTPUT);
  glDebugMessageCallback(&pass_on, &messages);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
}

model::Result<void> Context::adopt(const std::string& how) {
  const std::string version = words(GL_VERSION);
  if (epoxy_gl_version() < 45)
    return model::failure({model::Code::gl_unavailable, "", "OpenGL 4.5 core", version,
                           "Update the driver, or use Mesa's software rasteriser."});
  description_ = how + ", " + words(GL_RENDERER) + ", OpenGL " + version;
  listen_to_driver(messages_);
  return {};
}

bool Context::lost() const { return glGetGraphicsResetStatus() != GL_NO_ERROR; }

} // namespace cupola::outputs
