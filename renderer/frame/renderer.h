// Realises stages as GL objects and draws them into one texture per output. Render thread only, with its
// context current; knows nothing of windows, files or clocks.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "renderer/frame/device.h"
#include "renderer/frame/quality_choice.h"
#include "renderer/frame/stage.h"

namespace cupola::frame {

/// A finished picture: a GL_TEXTURE_2D, SRGB8_ALPHA8, GL's row 0 at the bottom. Valid until the next draw().
struct Picture {
  std::string output;
  unsigned texture = 0;
  int width = 0, height = 0;
};

struct FrameStatistics {
  std::uint64_t revision = 0;     ///< of the stage that was drawn
  std::uint64_t triangles = 0;    ///< of the scene
  std::uint64_t drawn = 0;        ///< triangles sent to the rasteriser over all viewports
  std::uint64_t replicated = 0;   ///< (triangle, piece) pairs of all piecewise viewports
  std::uint64_t vertex_bytes = 0; ///< of all vertex and index buffers in use
  QualityLevel quality;           ///< that it was drawn with, as the driver has it
  bool automatic_quality = false; ///< chosen by /quality/automatic
  bool uploading = false;         ///< a newer stage is being realised beside this one
};

/// Frames after which a trial of the method `auto` is over.
inline constexpr int method_trial_frames = 6;

struct RendererOptions {
  bool offline =
      false; ///< every draw is complete: waits for uploads and for pictures of the reference method
  bool measure_methods = false; ///< off-line too `auto` tries both methods; else it is piecewise there
  int reference_samples = 0;    ///< rays a pixel of the reference method; 0: as the show's quality says
  std::function<void(double share)> progress; ///< of a reference picture while off-line; any thread
};

class Renderer {
public:
  /// Fails when the current context is not OpenGL 4.5 core or a shader does not compile.
  [[nodiscard]] static model::Result<std::unique_ptr<Renderer>> make(RendererOptions options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  [[nodiscard]] const Device& device() const;

  /// The stage to draw from now on. The first one is realised at once; a later one beside the running one,
  /// its uploads spread over frames, then swapped in between two frames; until then the old one is drawn.
  /// A newer call replaces a stage still waiting. Cheap when only plain values differ.
  void set_stage(std::shared_ptr<const Stage> stage);

  /// Problems of the last stage that could not be realised (the old one goes on); empties the list.
  [[nodiscard]] model::Problems take_problems();

  /// What a frame takes beside drawing, in milliseconds; waiting for a monitor is no work. /quality/automatic
  /// counts it in from the next frame on.
  void set_beside(double milliseconds);

  /// Draws all outputs at show time `time` (seconds). No stage yet: draws nothing, revision 0.
  FrameStatistics draw(double time);

  /// One per output of the stage drawn last.
  [[nodiscard]] const std::vector<Picture>& pictures() const;

private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

} // namespace cupola::frame
