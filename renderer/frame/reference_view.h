// A viewport rendered by rays on the CPU while the show runs: a thread of its own traces, and the viewport
// shows the newest picture that is finished. Render thread only, but for what the thread does inside.
#pragma once

#include <functional>
#include <memory>

#include "renderer/frame/stage.h"
#include "renderer/gl/handle.h"
#include "renderer/plan/camera.h"

namespace cupola::frame {

struct ReferenceOptions {
  int samples = 0;                      ///< rays a pixel; 0: as many as the show's quality draws a pixel with
  int threads = 1;                      ///< 0: one per core; a running show keeps the others for itself
  std::function<void(double)> progress; ///< share of the picture in the making, 0 to 1; any thread
};

class ReferenceView {
public:
  ReferenceView();
  ~ReferenceView(); ///< stops a picture in the making
  ReferenceView(const ReferenceView&) = delete;
  ReferenceView& operator=(const ReferenceView&) = delete;

  /// Starts the next picture if none is in the making.
  void request(std::shared_ptr<const Stage> stage, const plan::ViewportPlan& viewport,
               const plan::CameraPose& camera, double time);
  /// Off-line: each request is waited for, so that the picture is that of the frame. Returns without one when
  /// tracing failed.
  void wait();
  /// Stops a picture in the making and lets go of the newest one. False while the thread still works: only a
  /// view for which this was true is destroyed without waiting.
  bool forget();
  /// There is a picture to show, or tracing failed and there will be none.
  [[nodiscard]] bool has_answer() const;
  /// For the pictures requested from now on.
  void set_options(ReferenceOptions options);
  /// Why the last picture failed; empties the list.
  [[nodiscard]] model::Problems take_problems();
  /// The newest picture as a texture, GL's row 0 at the bottom; 0 while there is none.
  [[nodiscard]] GLuint texture();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cupola::frame
