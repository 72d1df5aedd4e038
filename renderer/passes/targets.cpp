#include "renderer/passes/targets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace cupola::passes {

namespace {

constexpr GLenum color_format = GL_SRGB8_ALPHA8;
constexpr GLenum depth_format = GL_DEPTH_COMPONENT32F;

gl::Renderbuffer make_renderbuffer(GLenum format, int width, int height, int samples) {
  gl::Renderbuffer made = gl::Renderbuffer::make();
  if (samples > 1)
    glNamedRenderbufferStorageMultisample(made.id(), samples, format, width, height);
  else
    glNamedRenderbufferStorage(made.id(), format, width, height);
  return made;
}

gl::Texture make_texture(int width, int height) {
  gl::Texture made = gl::Texture::make(GL_TEXTURE_2D);
  glTextureStorage2D(made.id(), 1, color_format, width, height);
  glTextureParameteri(made.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(made.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(made.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(made.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return made;
}

} // namespace

int clamp_samples(int wanted) {
  if (wanted <= 1) return 1;
  const auto offered = [](GLenum target, GLenum format) {
    GLint count = 0;
    glGetInternalformativ(target, format, GL_NUM_SAMPLE_COUNTS, 1, &count);
    std::vector<GLint> counts(static_cast<std::size_t>(std::max(count, 0)));
    if (count > 0) glGetInternalformativ(target, format, GL_SAMPLES, count, counts.data());
    return counts;
  };
  const std::vector<GLint> color = offered(GL_RENDERBUFFER, color_format);
  const std::vector<GLint> depth = offered(GL_RENDERBUFFER, depth_format);
  int best = 1;
  for (const GLint samples : color)
    if (samples <= wanted && std::find(depth.begin(), depth.end(), samples) != depth.end())
      best = std::max(best, samples);
  return best;
}

OutputTarget::OutputTarget(int width, int height, int scale, int samples)
    : width_(width)
    , height_(height)
    , scale_(scale)
    , samples_(samples) {
  const int drawn_width = width * scale, drawn_height = height * scale;
  picture_ = make_texture(width, height);
  picture_.label("picture");
  picture_framebuffer_ = gl::Framebuffer::make();
  glNamedFramebufferTexture(picture_framebuffer_.id(), GL_COLOR_ATTACHMENT0, picture_.id(), 0);
  drawn_ = gl::Framebuffer::make();
  depth_ = make_renderbuffer(depth_format, drawn_width, drawn_height, samples);
  glNamedFramebufferRenderbuffer(drawn_.id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.id());
  if (scale > 1) resolved_ = make_texture(drawn_width, drawn_height);
  if (samples > 1) {
    color_ = make_renderbuffer(color_format, drawn_width, drawn_height, samples);
    glNamedFramebufferRenderbuffer(drawn_.id(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.id());
    if (scale > 1) {
      resolved_framebuffer_ = gl::Framebuffer::make();
      glNamedFramebufferTexture(resolved_framebuffer_.id(), GL_COLOR_ATTACHMENT0, resolved_.id(), 0);
    }
  } else {
    glNamedFramebufferTexture(drawn_.id(), GL_COLOR_ATTACHMENT0, scale > 1 ? resolved_.id() : picture_.id(),
                              0);
  }
}

void OutputTarget::finish(GLuint downsample_program, GLuint empty_array) const {
  const int drawn_width = width_ * scale_, drawn_height = height_ * scale_;
  if (samples_ > 1)
    glBlitNamedFramebuffer(drawn_.id(), scale_ > 1 ? resolved_framebuffer_.id() : picture_framebuffer_.id(),
                           0, 0, drawn_width, drawn_height, 0, 0, drawn_width, drawn_height,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
  if (scale_ == 1) return;
  glBindFramebuffer(GL_FRAMEBUFFER, picture_framebuffer_.id());
  glViewport(0, 0, width_, height_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glUseProgram(downsample_program);
  glUniform1i(0, scale_);
  glBindTextureUnit(0, resolved_.id());
  glBindSampler(0, 0);
  glBindVertexArray(empty_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

CubemapTarget::CubemapTarget(const CubemapMake& make)
    : make_(make) {
  const auto& [size, samples, layered, mipmaps, depth] = make_;
  texture_ = gl::Texture::make(GL_TEXTURE_CUBE_MAP);
  texture_.label("cubemap");
  glTextureStorage2D(texture_.id(), mipmaps ? std::bit_width(static_cast<unsigned>(size)) : 1, color_format,
                     size, size);
  glTextureParameteri(texture_.id(), GL_TEXTURE_MIN_FILTER, mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  glTextureParameteri(texture_.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  if (depth || (layered && samples == 1)) make_depth_texture();
  for (int face = 0; face < 6; ++face) {
    gl::Framebuffer& made = faces_[static_cast<std::size_t>(face)];
    made = gl::Framebuffer::make();
    glNamedFramebufferTextureLayer(made.id(), GL_COLOR_ATTACHMENT0, texture_.id(), 0, face);
    if (depth) attach_depth(made.id(), face);
  }
  if (layered) {
    drawn_ = gl::Framebuffer::make();
    if (samples > 1) {
      layered_color_ = gl::Texture::make(GL_TEXTURE_2D_MULTISAMPLE_ARRAY);
      glTextureStorage3DMultisample(layered_color_.id(), samples, color_format, size, size, 6, GL_TRUE);
      layered_depth_ = gl::Texture::make(GL_TEXTURE_2D_MULTISAMPLE_ARRAY);
      glTextureStorage3DMultisample(layered_depth_.id(), samples, depth_format, size, size, 6, GL_TRUE);
      glNamedFramebufferTexture(drawn_.id(), GL_COLOR_ATTACHMENT0, layered_color_.id(), 0);
      glNamedFramebufferTexture(drawn_.id(), GL_DEPTH_ATTACHMENT, layered_depth_.id(), 0);
    } else {
      glNamedFramebufferTexture(drawn_.id(), GL_COLOR_ATTACHMENT0, texture_.id(), 0);
      glNamedFramebufferTexture(drawn_.id(), GL_DEPTH_ATTACHMENT, depth_.id(), 0);
    }
    return;
  }
  if (samples == 1 && depth) return;
  face_depth_ = make_renderbuffer(depth_format, size, size, samples);
  if (samples > 1) {
    drawn_ = gl::Framebuffer::make();
    face_color_ = make_renderbuffer(color_format, size, size, samples);
    glNamedFramebufferRenderbuffer(drawn_.id(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, face_color_.id());
    glNamedFramebufferRenderbuffer(drawn_.id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, face_depth_.id());
  } else {
    for (const gl::Framebuffer& face : faces_)
      glNamedFramebufferRenderbuffer(face.id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, face_depth_.id());
  }
}

void CubemapTarget::make_depth_texture() {
  depth_ = gl::Texture::make(GL_TEXTURE_CUBE_MAP);
  glTextureStorage2D(depth_.id(), 1, depth_format, make_.size, make_.size);
  glTextureParameteri(depth_.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(depth_.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void CubemapTarget::attach_depth(GLuint framebuffer, int face) const {
  glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, depth_.id(), 0, face);
}

GLuint CubemapTarget::framebuffer(int face) const {
  return drawn_ ? drawn_.id() : faces_[static_cast<std::size_t>(face)].id();
}

void CubemapTarget::resolve(int face) const {
  if (make_.samples == 1) return;
  GLuint source = drawn_.id();
  gl::Framebuffer layer;
  if (make_.layered) {
    layer = gl::Framebuffer::make();
    glNamedFramebufferTextureLayer(layer.id(), GL_COLOR_ATTACHMENT0, layered_color_.id(), 0, face);
    glNamedFramebufferTextureLayer(layer.id(), GL_DEPTH_ATTACHMENT, layered_depth_.id(), 0, face);
    source = layer.id();
  }
  const int size = make_.size;
  glBlitNamedFramebuffer(source, faces_[static_cast<std::size_t>(face)].id(), 0, 0, size, size, 0, 0, size,
                         size, GL_COLOR_BUFFER_BIT | (make_.depth ? GL_DEPTH_BUFFER_BIT : 0u), GL_NEAREST);
}

void CubemapTarget::finish() const {
  if (make_.mipmaps) glGenerateTextureMipmap(texture_.id());
}

} // namespace cupola::passes
