// What an output is to the frame loop: something that a finished picture is presented on. Windows, image
// files and headless outputs are equals; nothing above this room asks which one it has.
// Render thread only, with the render context current, unless a comment says otherwise.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/outputs/context.h"

namespace cupola::outputs {

/// A finished picture: a GL_TEXTURE_2D with SRGB8_ALPHA8 storage, GL's row 0 at the bottom.
struct Frame {
  unsigned texture = 0;
  int width = 0, height = 0;
  std::uint64_t number = 0; ///< counts the frames of the loop, from 1
};

struct Counters {
  std::uint64_t presented = 0; ///< pictures that reached the output
  std::uint64_t dropped = 0;   ///< pictures that it could not take
};

/// How an output's frames are bound to a monitor.
struct Pace {
  double refresh_hz = 0.0; ///< present() waits for this monitor's refresh; 0: it does not wait
};

class Output {
public:
  Output() = default;
  virtual ~Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// In words, for status and log: "window 1280x720 on monitor eDP-1".
  [[nodiscard]] virtual std::string describe() const = 0;

  /// First half of presenting: takes the picture. The picture may be overwritten once all outputs have been
  /// through present().
  virtual void draw(const Frame& frame) = 0;

  /// Second half: shows what draw() took. All outputs draw before the first presents, so that they show the
  /// same frame at the same time. May wait for the monitor.
  virtual void present() = 0;

  /// At most one output of a loop waits for its monitor; the others show at the same refresh.
  [[nodiscard]] virtual bool can_wait() const { return false; }
  virtual void set_waiting(bool) {}
  [[nodiscard]] virtual Pace pace() const { return {}; }

  [[nodiscard]] virtual Counters counters() const = 0;

  /// What went wrong since the last call; empties the list.
  [[nodiscard]] virtual model::Problems take_problems() { return {}; }
};

} // namespace cupola::outputs
