// The frame loop: the render thread. Once per frame it takes the newest stage, draws it, presents it on all
// outputs and keeps the show's rate. It never waits for a network, a disk or another thread's work.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "renderer/frame/renderer.h"
#include "renderer/frame/stage.h"
#include "renderer/outputs/context.h"

namespace cupola::outputs {
class MainThread;
}

namespace cupola::frame {

struct OutputStatus {
  std::string name;
  std::string description; ///< "window, 1280x720 on monitor eDP-1"
  int width = 0, height = 0;
  std::uint64_t presented = 0, dropped = 0;
};

/// What the loop has done lately. Times in milliseconds, over the last seconds.
struct LoopStatus {
  Device device;
  std::string context;      ///< how OpenGL was reached
  std::uint64_t frames = 0; ///< presented on all outputs, since the start
  std::uint64_t late = 0;   ///< frames that missed their time, since the start
  double fps = 0.0;
  double frame_mean_ms = 0.0; ///< from the start of drawing to the end of presenting
  double frame_max_ms = 0.0;
  double show_time = 0.0; ///< seconds
  FrameStatistics last;   ///< of the newest frame
  std::vector<OutputStatus> outputs;
};

/// One picture of an output, as it was in one frame.
struct Snapshot {
  std::string output;
  std::uint64_t revision = 0, frame = 0;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb; ///< 8 bit, sRGB-encoded, width * height * 3 bytes, rows from the top
};

/// Called once, on the thread "snapshot" (or, when the loop has ended, on the caller's). Fails when there is
/// no such output, or too many requests wait.
using SnapshotCallback = std::function<void(model::Result<Snapshot>)>;

/// What the loop asks and tells. All are called on the render thread and must not block.
struct LoopHooks {
  /// The newest stage; never null. The same pointer as long as nothing changed.
  std::function<std::shared_ptr<const Stage>()> stage;
  /// All outputs have presented `frame`, which showed `revision`. After every frame.
  std::function<void(std::uint64_t revision, std::uint64_t frame)> shown;
  /// `revision` cannot be shown: its outputs could not be opened or its resources not realised. What was
  /// shown before goes on.
  std::function<void(std::uint64_t revision, const model::Problems& problems)> failed;
  /// Something is wrong beside the show: a full disk, a lost context.
  std::function<void(const model::Problems& problems)> problems;
  /// The render thread ends now, asked for or not.
  std::function<void()> ended;
};

enum class LoopEnd : std::uint8_t {
  stopped,      ///< as asked
  failed,       ///< could not start: the first stage's outputs or the renderer
  context_lost, ///< the driver has reset the GPU; only a new process helps
};

class Loop {
public:
  /// Starts the thread "render". `context` is not current anywhere; it and `main` outlive the loop. `main` is
  /// served by the main thread until `ended` has been called.
  Loop(outputs::Context& context, outputs::MainThread& main, LoopHooks hooks);

  /// Stops and joins; on the main thread, which serves what the render thread hands over meanwhile.
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Any thread. Asks the loop to end after the frame in progress.
  void stop() noexcept;

  /// Any thread. How the loop ended; nullopt while it runs.
  [[nodiscard]] std::optional<LoopEnd> end() const;

  /// Any thread.
  [[nodiscard]] LoopStatus status() const;

  /// Any thread. The picture of the next frame; scaled down to `max_width` pixels across when that is less
  /// than the output's width.
  void snapshot(std::string output, std::optional<int> max_width, SnapshotCallback callback);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cupola::frame
