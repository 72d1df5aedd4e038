// How far two pictures are apart, in the usual figures. Pure, any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cupola::reference {

/// 8 bit RGBA as displays take it (sRGB-encoded), rows from the top, rgba.size() == 4 · width · height.
struct Pixels {
  std::span<const std::uint8_t> rgba;
  int width = 0, height = 0;
};

struct CompareOptions {
  bool mask = false; ///< pixels where `wanted` has alpha 0 are left out: outside a fisheye's circle
  int threshold = 0; ///< a pixel is "beyond" when a channel differs by more
  bool ssim = true;  ///< false: left out, which is most of the work
};

struct Comparison {
  std::size_t compared = 0; ///< pixels; 0 where the mask leaves none
  double psnr_db = 0.0; ///< 10·log10(255² / mean squared error) over R, G and B; infinite when all are equal
  std::optional<double> ssim;   ///< absent where no window fits: pictures under 11 pixels, or all masked
  int max_difference = 0;       ///< largest of all channels, 0 to 255
  int worst_x = 0, worst_y = 0; ///< a pixel that has it
  std::size_t beyond = 0;       ///< pixels beyond the threshold
  [[nodiscard]] double fraction_beyond() const {
    return compared == 0 ? 0.0 : static_cast<double>(beyond) / static_cast<double>(compared);
  }
};

/// Compares R, G and B; alpha serves the mask alone. Precondition: both pictures have the same size, not
/// empty. SSIM [Wang, Bovik, Sheikh, Simoncelli 2004]: luma (0.299, 0.587, 0.114), Gaussian window of 11 × 11
/// with σ = 1.5, K1 = 0.01, K2 = 0.03, mean over the windows that lie wholly inside (with a mask: whose
/// centre counts).
[[nodiscard]] Comparison compare(const Pixels& got, const Pixels& wanted, const CompareOptions& options = {});

/// The absolute difference of each channel times `magnification`, opaque; same size, same precondition.
[[nodiscard]] std::vector<std::uint8_t> difference_picture(const Pixels& got, const Pixels& wanted,
                                                           int magnification);

} // namespace cupola::reference
