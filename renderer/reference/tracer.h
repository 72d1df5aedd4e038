// The reference method: a picture by rays, on the CPU, through the same projection function and with the same
// materials as the other methods. Slow and right: the judge of both. Embree finds the surfaces; no GL.
#pragma once

#include <atomic>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/content/scene.h"
#include "renderer/projection/map.h"
#include "renderer/reference/picture.h"

namespace cupola::reference {

/// Where the viewport lies in the picture: pixels, x to the right and y downwards from the top left corner.
struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
};

inline constexpr int default_samples = 64;

/// One viewport.
struct Request {
  glm::dvec3 eye{0.0};         ///< world, metres
  glm::dmat3 orientation{1.0}; ///< view axes to world axes
  double near = 0.05;          ///< nothing nearer is drawn, in units of the projection's rays (see render)
  projection::Map map;
  model::Scene scene;         ///< sun, sky, fog and style; its content is not looked at
  glm::dvec3 background{0.0}; ///< linear, where nothing is hit
  Rect rect;
  Rect window{}; ///< pixels of the picture that are traced, the others stay as they are; empty: all of rect
  int samples = default_samples;             ///< rays a pixel, at least 1
  int threads = 0;                           ///< 0: one per core
  std::function<void(double)> progress{};    ///< share done, 0 to 1, rising; called by one thread at a time
  const std::atomic<bool>* cancel = nullptr; ///< looked at between tiles
};

class Tracer {
public:
  /// Builds the ray structure of the scene at time 0, or at `pose`. Takes a while for millions of triangles.
  explicit Tracer(std::shared_ptr<const content::Scene> scene, const content::Pose* pose = nullptr);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Why the last build failed (rays_unavailable: too little memory); empty as a rule. While there are any,
  /// render refuses.
  [[nodiscard]] const model::Problems& problems() const;

  /// The scene at another time: copies the pose and builds anew. Not while a render runs.
  void move(const content::Pose& pose);

  /// Draws a viewport into `picture`. The samples of a pixel are well distributed over its square
  /// (Hammersley's set, the same in every pixel; one sample is the centre), lit singly, and averaged with
  /// equal weight in linear light: the footprint and the arithmetic that a multisampled or supersampled sRGB
  /// framebuffer has. Textures are filtered over the footprint of one sample, so that the picture nears the
  /// true mean over the pixel as samples grow. Where the projection shows nothing, what was in the picture
  /// stays, as when pixels are discarded. Near: a surface at eye + x · ray(s,t) is drawn for x >= near, with
  /// the ray's own length: the same w = near at which the piecewise method clips (a perspective's depth, a
  /// cylinder's distance from the axis, a fisheye's distance). The result does not depend on the number of
  /// threads. False when cancelled, when parts
  /// of the rectangle are undrawn, and where there are problems().
  bool render(const Request& request, Picture& picture) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Sample `index` of `count` in a pixel's unit square.
[[nodiscard]] glm::dvec2 sample_position(int index, int count);

} // namespace cupola::reference
