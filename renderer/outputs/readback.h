// Pictures from the GPU to memory without a stall: a few buffers, filled by the driver while frames go on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/outputs/output.h"

namespace cupola::outputs {

/// A finished picture in memory. Any thread may read it, and let it go: its buffer is then used again.
struct Pixels {
  const std::uint8_t* rgba = nullptr; ///< 8 bit, sRGB-encoded, width * height * 4 bytes, bottom row first
  int width = 0, height = 0;
  std::uint64_t tag = 0;      ///< as given to start()
  std::shared_ptr<void> hold; ///< the buffer is busy as long as this lives
};

/// 8-bit RGB rows from the top, without padding.
[[nodiscard]] std::vector<std::uint8_t> to_rgb(const Pixels& pixels);

/// Render thread, with its context current; pixels handed out must be let go before the destructor runs.
class Readback {
public:
  /// `buffers`: pictures that can be under way or held at once.
  explicit Readback(std::size_t buffers);
  ~Readback();
  Readback(const Readback&) = delete;
  Readback& operator=(const Readback&) = delete;

  /// Starts reading the picture, scaled down to `max_width` pixels when that is given and less than its
  /// width. False when all buffers are busy.
  bool start(const Frame& frame, std::optional<int> max_width, std::uint64_t tag);

  /// The next finished one in the order of start(), if it is there already.
  [[nodiscard]] std::optional<Pixels> take();

  /// Reads have been started and not yet taken.
  [[nodiscard]] bool pending() const { return !under_way_.empty(); }

private:
  struct Buffer;
  struct Scratch {
    unsigned texture = 0;
    int width = 0, height = 0;
  };
  unsigned scaled_down(const Frame& frame, int width, int height);
  unsigned scratch(Scratch& target, int width, int height);
  void blit(unsigned from, int from_width, int from_height, unsigned to, int to_width, int to_height);

  std::vector<std::shared_ptr<Buffer>> buffers_;
  std::vector<std::shared_ptr<Buffer>> under_way_; ///< in the order started
  unsigned source_ = 0, target_ = 0;               ///< framebuffers
  Scratch ping_, pong_;
};

} // namespace cupola::outputs
