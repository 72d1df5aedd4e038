// What is drawn into: a picture with depth, multisampled or not, supersampled or not. Render thread only.
#pragma once

#include <array>
#include <cstdint>

#include "configs/model/problem.h"
#include "renderer/gl/handle.h"

namespace cupola::passes {

/// An output's picture. Drawing goes to a framebuffer `scale` times as large with `samples` samples a pixel;
/// finish() averages it, in linear light, into the picture.
class OutputTarget {
public:
  /// Pixels of the picture; samples as the driver has them (see clamp_samples).
  OutputTarget(int width, int height, int scale, int samples);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int scale() const { return scale_; }
  [[nodiscard]] int samples() const { return samples_; }
  [[nodiscard]] GLuint framebuffer() const { return drawn_.id(); }
  [[nodiscard]] GLuint picture() const { return picture_.id(); }
  /// Framebuffer over the finished picture alone (no depth).
  [[nodiscard]] GLuint picture_framebuffer() const { return picture_framebuffer_.id(); }

  void finish(GLuint downsample_program, GLuint empty_array) const;

private:
  int width_, height_, scale_, samples_;
  gl::Texture picture_, resolved_;
  gl::Renderbuffer color_, depth_;
  gl::Framebuffer drawn_, resolved_framebuffer_, picture_framebuffer_;
};

/// What a cubemap is made of.
struct CubemapMake {
  int size, samples;
  bool layered;
  bool mipmaps;
  bool depth; ///< its depth is kept, to be looked up
  bool operator==(const CubemapMake&) const = default;
};

/// A cubemap with its depth; six framebuffers, or one with six layers.
class CubemapTarget {
public:
  explicit CubemapTarget(const CubemapMake& make);

  [[nodiscard]] const CubemapMake& make() const { return make_; }
  [[nodiscard]] bool layered() const { return make_.layered; }
  [[nodiscard]] GLuint texture() const { return texture_.id(); }
  /// Reversed depth along each face's axis. 0 unless it is kept.
  [[nodiscard]] GLuint depth_texture() const { return make_.depth ? depth_.id() : 0; }
  /// To draw face `face` into (any face when layered: all share one framebuffer).
  [[nodiscard]] GLuint framebuffer(int face) const;
  /// After a face has been drawn: resolves its samples. Mipmaps are made by finish().
  void resolve(int face) const;
  void finish() const;

private:
  void make_depth_texture();
  void attach_depth(GLuint framebuffer, int face) const;

  CubemapMake make_;
  gl::Texture texture_, depth_, layered_color_, layered_depth_;
  gl::Renderbuffer face_color_, face_depth_;
  std::array<gl::Framebuffer, 6> faces_;
  gl::Framebuffer drawn_; ///< multisampled, or layered
};

/// The nearest number of samples, not above `wanted`, that the driver really gives for colour and depth; 1 or
/// more.
[[nodiscard]] int clamp_samples(int wanted);

} // namespace cupola::passes
