// A picture of an output and its encoded forms.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "configs/model/problem.h"

namespace cupola::control {

/// sRGB, 8 bits a channel, 3 bytes a pixel without padding, row 0 at the top.
struct RgbPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

enum class PictureFormat : std::uint8_t { png, jpeg };

/// At most `width` pixels wide (0: as it is), averaged down in whole pixels' shares; never enlarged.
[[nodiscard]] RgbPicture scaled(const RgbPicture& picture, int width);

/// The bytes of a file. Any thread; takes tens of milliseconds for a large PNG.
[[nodiscard]] model::Result<std::string> encode(const RgbPicture& picture, PictureFormat format);

} // namespace cupola::control
