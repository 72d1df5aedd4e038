// Pictures in files and in memory: PNG, JPEG, EXR and TIFF, through OpenImageIO (whose headers stay in the
// .cpp). Pixels are RGBA, rows from the top unless a view says otherwise, alpha not multiplied into the
// colour. Two kinds of picture: 8 bit sRGB, as displays take it, and float in linear light. Thread: any.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "configs/model/problem.h"

namespace cupola::outputs {

/// 8 bit, colour sRGB-encoded, alpha linear. rgba.size() == 4 · width · height.
struct ByteImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Linear light, 1 is display white. rgba.size() == 4 · width · height.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> rgba;
};

/// Pixels that belong to somebody else, tightly packed.
template <class Channel>
struct View {
  const Channel* rgba = nullptr;
  int width = 0, height = 0;
  bool bottom_up = false; ///< the first row is the lowest, as OpenGL reads back
  bool alpha = true;      ///< false: the alpha channel is left out of the file
};
using ByteView = View<std::uint8_t>;
using FloatView = View<float>;

[[nodiscard]] inline ByteView view(const ByteImage& image) {
  return {image.rgba.data(), image.width, image.height};
}
[[nodiscard]] inline FloatView view(const FloatImage& image) {
  return {image.rgba.data(), image.width, image.height};
}

enum class FileFormat : std::uint8_t { png, jpeg, exr, tiff };

/// By file extension, with or without its dot, in any case: png, jpg, jpeg, exr, tif, tiff.
[[nodiscard]] std::optional<FileFormat> format_of(std::string_view extension);

inline constexpr int default_jpeg_quality = 92;

/// Writes the picture in the format that the path's extension names. The file appears whole or not at all: a
/// temporary file beside it is renamed. From bytes, EXR gets half floats in linear light and the others the
/// bytes; from floats, PNG and JPEG get sRGB-encoded bytes, EXR half floats and TIFF 32 bit floats. JPEG has
/// no alpha channel. Fails with image_unwritable: unknown extension, missing folder, full disk, no
/// permission, empty picture.
[[nodiscard]] model::Result<void> write_image(const std::filesystem::path& file, ByteView pixels);
[[nodiscard]] model::Result<void> write_image(const std::filesystem::path& file, FloatView pixels);

/// A whole PNG or JPEG file in memory. `quality`: 1 to 100. PNG is packed for speed, not for size.
[[nodiscard]] model::Result<std::vector<std::uint8_t>> encode_png(ByteView pixels);
[[nodiscard]] model::Result<std::vector<std::uint8_t>> encode_jpeg(ByteView pixels,
                                                                   int quality = default_jpeg_quality);

/// Reads PNG, JPEG, EXR, TIFF, PNM and PFM, HDR, BMP, WebP, GIF, JPEG 2000 and DPX, known by their content;
/// grey becomes RGB, missing alpha is opaque, rows stand as stored (a camera's note of its orientation is not
/// heeded). Integer samples are taken as sRGB-encoded, floating ones as linear, and converted to what is
/// asked for. Fails with image_unreadable: missing, not a regular file, not a picture, damaged, more than
/// 2^27 pixels.
[[nodiscard]] model::Result<ByteImage> read_image(const std::filesystem::path& file);
[[nodiscard]] model::Result<FloatImage> read_linear_image(const std::filesystem::path& file);

/// One channel between linear light and the sRGB encoding [IEC 61966-2-1], over [0,1]; outside it is clamped.
[[nodiscard]] float srgb_from_linear(float linear);
[[nodiscard]] float linear_from_srgb(float encoded);
/// Rounded to the nearest of 256 steps; NaN becomes 0.
[[nodiscard]] std::uint8_t srgb_byte(float linear);

} // namespace cupola::outputs
