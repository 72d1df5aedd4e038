// Move-only owners of GL object names. They know how to die and nothing else. Render thread only.
#pragma once

#include <epoxy/gl.h>
#include <string_view>
#include <utility>

namespace cupola::gl {

/// Owns one GL name; empty when default-made or moved from. `Traits` has make() and destroy(name).
template <class Traits>
class Handle {
public:
  Handle() = default;
  explicit Handle(GLuint id)
      : id_(id) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ != 0) Traits::destroy(id_);
  }

  /// A fresh object; `args` as the traits want them (a texture's target).
  template <class... Args>
  [[nodiscard]] static Handle make(Args... args) {
    return Handle(Traits::make(args...));
  }

  [[nodiscard]] GLuint id() const { return id_; }
  [[nodiscard]] explicit operator bool() const { return id_ != 0; }

  /// Name for debuggers and driver messages.
  void label(std::string_view text) const {
    glObjectLabel(Traits::identifier, id_, static_cast<GLsizei>(text.size()), text.data());
  }

private:
  GLuint id_ = 0;
};

struct BufferTraits {
  static constexpr GLenum identifier = GL_BUFFER;
  static GLuint make() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct TextureTraits {
  static constexpr GLenum identifier = GL_TEXTURE;
  static GLuint make(GLenum target) {
    GLuint id = 0;
    glCreateTextures(target, 1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct SamplerTraits {
  static constexpr GLenum identifier = GL_SAMPLER;
  static GLuint make() {
    GLuint id = 0;
    glCreateSamplers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteSamplers(1, &id); }
};
struct RenderbufferTraits {
  static constexpr GLenum identifier = GL_RENDERBUFFER;
  static GLuint make() {
    GLuint id = 0;
    glCreateRenderbuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteRenderbuffers(1, &id); }
};
struct FramebufferTraits {
  static constexpr GLenum identifier = GL_FRAMEBUFFER;
  static GLuint make() {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct VertexArrayTraits {
  static constexpr GLenum identifier = GL_VERTEX_ARRAY;
  static GLuint make() {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct ProgramTraits {
  static constexpr GLenum identifier = GL_PROGRAM;
  static GLuint make() { return glCreateProgram(); }
  static void destroy(GLuint id) { glDeleteProgram(id); }
};
struct QueryTraits {
  static constexpr GLenum identifier = GL_QUERY;
  static GLuint make(GLenum target) {
    GLuint id = 0;
    glCreateQueries(target, 1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};
using Buffer = Handle<BufferTraits>;
using Texture = Handle<TextureTraits>;
using Sampler = Handle<SamplerTraits>;
using Renderbuffer = Handle<RenderbufferTraits>;
using Framebuffer = Handle<FramebufferTraits>;
using VertexArray = Handle<VertexArrayTraits>;
using Program = Handle<ProgramTraits>;
using Query = Handle<QueryTraits>;

/// A fence; owns its sync object.
class Fence {
public:
  Fence() = default;
  Fence(Fence&& other) noexcept
      : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  ~Fence() {
    if (sync_) glDeleteSync(sync_);
  }
  [[nodiscard]] static Fence insert() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    return fence;
  }
  /// True when the commands before the fence have ended, waiting at most so long. An empty fence has ended.
  [[nodiscard]] bool ended(GLuint64 nanoseconds = 0) const {
    if (!sync_) return true;
    const GLenum state = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, nanoseconds);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
  }

private:
  GLsync sync_ = nullptr;
};

} // namespace cupola::gl
