#include "renderer/outputs/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace cupola::outputs {
namespace {

using model::Code;
using model::failure;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t max_pixels = std::int64_t{1} << 27;

tl::unexpected<model::Problems> cannot_write(const std::string& what, std::string found,
                                             std::string advice = "") {
  return failure({.code = Code::image_unwritable,
                  .pointer = "",
                  .expected = "to write the picture " + what,
                  .found = std::move(found),
                  .advice = std::move(advice)});
}

tl::unexpected<model::Problems> cannot_read(const std::filesystem::path& file, std::string found) {
  return failure({.code = Code::image_unreadable,
                  .pointer = "",
                  .expected = "a picture in " + file.string(),
                  .found = std::move(found),
                  .advice = ""});
}

/// The library would start threads of its own, one per core, inside a daemon whose threads are counted.
void keep_to_this_thread() {
  static const bool once = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  static_cast<void>(once);
}

const char* library_name(FileFormat format) {
  switch (format) {
  case FileFormat::png:
    return "png";
  case FileFormat::jpeg:
    return "jpeg";
  case FileFormat::exr:
    return "openexr";
  case FileFormat::tiff:
    return "tiff";
  }
  return "";
}

const std::array<float, 256>& linear_of_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = linear_from_srgb(static_cast<float>(i) / 255.0f);
    return values;
  }();
  return table;
}

std::uint8_t plain_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// The rows of a view from top to bottom, with 3 or 4 channels, each converted by `color` or `alpha`.
template <class To, class From, class Color, class Alpha>
std::vector<To> packed(const View<From>& pixels, int channels, Color color, Alpha alpha) {
  const auto width = static_cast<std::size_t>(pixels.width), height = static_cast<std::size_t>(pixels.height);
  std::vector<To> out;
  out.reserve(width * height * static_cast<std::size_t>(channels));
  for (std::size_t y = 0; y < height; ++y) {
    const From* row = pixels.rgba + 4 * width * (pixels.bottom_up ? height - 1 - y : y);
    for (std::size_t x = 0; x < width; ++x, row += 4) {
      for (int c = 0; c < 3; ++c) out.push_back(color(row[c]));
      if (channels == 4) out.push_back(alpha(row[3]));
    }
  }
  return out;
}

struct Encoding {
  FileFormat format{};
  OIIO::TypeDesc stored;  ///< sample type in the file
  OIIO::TypeDesc samples; ///< type of the samples handed over
  int quality = default_jpeg_quality;
};

/// Into memory; a TIFF into the file `name`: its writer goes back and forth, which the library's memory file
/// of Debian 12 does not survive.
model::Result<Bytes> encode(const void* samples, int width, int height, int channels, const Encoding& how,
                            const std::string& name) {
  keep_to_this_thread();
  try {
    auto writer = OIIO::ImageOutput::create(library_name(how.format));
    if (!writer) return cannot_write(name, OIIO::geterror());
    OIIO::ImageSpec spec(width, height, channels, how.stored);
    const bool linear = how.stored != OIIO::TypeDesc::UINT8;
    spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (how.format == FileFormat::png) spec.attribute("png:compressionLevel", 3);
    if (how.format == FileFormat::jpeg) spec.attribute("Compression", "jpeg:" + std::to_string(how.quality));
    Bytes bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    if (how.format != FileFormat::tiff) writer->set_ioproxy(&memory);
    if (!writer->open(name, spec) || !writer->write_image(how.samples, samples) || !writer->close())
      return cannot_write(name, writer->geterror());
    return bytes;
  } catch (const std::exception& error) { return cannot_write(name, error.what()); }
}

template <class Channel>
int channels_of(const View<Channel>& pixels, FileFormat format) {
  return pixels.alpha && format != FileFormat::jpeg ? 4 : 3;
}

model::Result<Bytes> encode_view(const ByteView& pixels, FileFormat format, int quality,
                                 const std::string& name) {
  const int channels = channels_of(pixels, format);
  if (format == FileFormat::exr) {
    const auto samples = packed<float>(
        pixels, channels, [](std::uint8_t byte) { return linear_of_bytes()[byte]; },
        [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0f; });
    return encode(samples.data(), pixels.width, pixels.height, channels,
                  {format, OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT}, name);
  }
  const auto same = [](std::uint8_t byte) { return byte; };
  const auto samples = packed<std::uint8_t>(pixels, channels, same, same);
  return encode(samples.data(), pixels.width, pixels.height, channels,
                {format, OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT8, quality}, name);
}

model::Result<Bytes> encode_view(const FloatView& pixels, FileFormat format, int quality,
                                 const std::string& name) {
  const int channels = channels_of(pixels, format);
  if (format == FileFormat::png || format == FileFormat::jpeg) {
    const auto samples = packed<std::uint8_t>(pixels, channels, srgb_byte, plain_byte);
    return encode(samples.data(), pixels.width, pixels.height, channels,
                  {format, OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT8, quality}, name);
  }
  const auto same = [](float value) { return value; };
  const auto samples = packed<float>(pixels, channels, same, same);
  const auto stored = format == FileFormat::exr ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT;
  return encode(samples.data(), pixels.width, pixels.height, channels,
                {format, stored, OIIO::TypeDesc::FLOAT}, name);
}

/// "" or what went wrong.
std::string write_whole(int descriptor, const Bytes& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count < 0 ? std::strerror(errno) : "nothing could be written";
    done += static_cast<std::size_t>(count);
  }
  return {};
}

/// "" or what went wrong.
std::string write_whole(const std::filesystem::path& file, const Bytes& bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return std::strerror(errno);
  std::string wrong = write_whole(descriptor, bytes);
  if (::close(descriptor) != 0 && wrong.empty()) wrong = std::strerror(errno); // a full disk may show here
  return wrong;
}

/// A name in the same folder that nothing else uses.
std::filesystem::path temporary_beside(const std::filesystem::path& file) {
  static std::atomic<unsigned> serial{0};
  std::string name = file.filename().string();
  name.insert(0, 1, '.');
  name.append(".").append(std::to_string(::getpid())).append(".").append(std::to_string(serial++));
  std::filesystem::path temporary = file;
  return temporary.replace_filename(name.append(".part"));
}

template <class Channel>
bool empty(const View<Channel>& pixels) {
  return !pixels.rgba || pixels.width <= 0 || pixels.height <= 0;
}

template <class Channel>
model::Result<void> write_view(const std::filesystem::path& file, const View<Channel>& pixels) {
  const auto format = format_of(file.extension().string());
  if (!format)
    return cannot_write(file.string(), "the extension '" + file.extension().string() + "'",
                        "Use png, jpg, exr or tif.");
  if (empty(pixels)) return cannot_write(file.string(), "a picture without pixels");
  const std::filesystem::path temporary = temporary_beside(file);
  const auto bytes = encode_view(pixels, *format, default_jpeg_quality, temporary.string());
  std::string wrong;
  if (!bytes)
    wrong = bytes.error().front().found;
  else if (*format != FileFormat::tiff)
    wrong = write_whole(temporary, *bytes);
  if (wrong.empty() && ::rename(temporary.c_str(), file.c_str()) != 0) wrong = std::strerror(errno);
  if (wrong.empty()) return {};
  ::unlink(temporary.c_str());
  return cannot_write(file.string(), wrong);
}

/// A picture file, open, that is flat and not too large.
struct Opened {
  std::unique_ptr<OIIO::ImageInput> reader;
  int width = 0, height = 0, channels = 0; ///< 1 to 4 of the file's channels
  bool linear = false;                     ///< floating samples
};

/// "" or why the path cannot be a picture. Looks before opening: a FIFO would never answer.
std::string unfit(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return S_ISDIR(status.st_mode) ? "a directory" : "a special file";
  return {};
}

/// The reader that knows the file by its content. The library by itself would try everything that it can
/// load, video decoders with network protocols among them.
std::unique_ptr<OIIO::ImageInput> reader_of(const std::filesystem::path& file) {
  for (const char* format :
       {"png", "jpeg", "openexr", "tiff", "pnm", "hdr", "bmp", "webp", "gif", "jpeg2000", "dpx"}) {
    auto reader = OIIO::ImageInput::create(format);
    if (reader && reader->valid_file(file.string())) return reader;
  }
  static_cast<void>(OIIO::geterror()); // of formats that this build of the library lacks
  return nullptr;
}

model::Result<Opened> open_picture(const std::filesystem::path& file) {
  if (const std::string why = unfit(file); !why.empty()) return cannot_read(file, why);
  keep_to_this_thread();
  try {
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);
    auto reader = reader_of(file);
    if (!reader) return cannot_read(file, "none of the formats known");
    OIIO::ImageSpec found;
    if (!reader->open(file.string(), found, wish)) return cannot_read(file, reader->geterror());
    const OIIO::ImageSpec& spec = reader->spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels < 1 || spec.depth > 1)
      return cannot_read(file, "something that is not a flat picture");
    if (std::int64_t{spec.width} * spec.height > max_pixels)
      return cannot_read(file, std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
    return Opened{std::move(reader), spec.width, spec.height, std::min(spec.nchannels, 4),
                  spec.format.is_floating_point()};
  } catch (const std::exception& error) { return cannot_read(file, error.what()); }
}

/// All samples as `From`, made RGBA by `color` and `alpha`; `opaque` stands for an alpha that the file lacks.
template <class From, class Color, class Alpha>
auto read_rgba(const Opened& picture, const std::filesystem::path& file, OIIO::TypeDesc type, From opaque,
               Color color, Alpha alpha) -> model::Result<std::vector<decltype(color(opaque))>> {
  try {
    const auto channels = static_cast<std::size_t>(picture.channels);
    const std::size_t pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    std::vector<From> samples(pixels * channels);
    if (!picture.reader->read_image(0, 0, 0, picture.channels, type, samples.data()))
      return cannot_read(file, picture.reader->geterror());
    const bool grey = channels < 3, has_alpha = channels % 2 == 0;
    std::vector<decltype(color(opaque))> out;
    out.reserve(4 * pixels);
    for (std::size_t i = 0; i < samples.size(); i += channels) {
      for (std::size_t c = 0; c < 3; ++c) out.push_back(color(samples[grey ? i : i + c]));
      out.push_back(alpha(has_alpha ? samples[i + channels - 1] : opaque));
    }
    return out;
  } catch (const std::exception& error) {
    return cannot_read(file, error.what());
  } // too little memory, for one
}

} // namespace

std::optional<FileFormat> format_of(std::string_view extension) {
  std::string word(extension.starts_with('.') ? extension.substr(1) : extension);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  if (word == "png") return FileFormat::png;
  if (word == "jpg" || word == "jpeg") return FileFormat::jpeg;
  if (word == "exr") return FileFormat::exr;
  if (word == "tif" || word == "tiff") return FileFormat::tiff;
  return std::nullopt;
}

model::Result<void> write_image(const std::filesystem::path& file, ByteView pixels) {
  return write_view(file, pixels);
}
model::Result<void> write_image(const std::filesystem::path& file, FloatView pixels) {
  return write_view(file, pixels);
}

model::Result<Bytes> encode_png(ByteView pixels) {
  if (empty(pixels)) return cannot_write("as PNG", "a picture without pixels");
  return encode_view(pixels, FileFormat::png, default_jpeg_quality, "picture.png");
}

model::Result<Bytes> encode_jpeg(ByteView pixels, int quality) {
  if (empty(pixels)) return cannot_write("as JPEG", "a picture without pixels");
  return encode_view(pixels, FileFormat::jpeg, std::clamp(quality, 1, 100), "picture.jpg");
}

model::Result<ByteImage> read_image(const std::filesystem::path& file) {
  const auto picture = open_picture(file);
  if (!picture) return tl::unexpected(picture.error());
  const auto same = [](std::uint8_t byte) { return byte; };
  auto rgba = picture->linear
                  ? read_rgba(*picture, file, OIIO::TypeDesc::FLOAT, 1.0f, srgb_byte, plain_byte)
                  : read_rgba(*picture, file, OIIO::TypeDesc::UINT8, std::uint8_t{255}, same, same);
  if (!rgba) return tl::unexpected(std::move(rgba.error()));
  return ByteImage{picture->width, picture->height, std::move(*rgba)};
}

model::Result<FloatImage> read_linear_image(const std::filesystem::path& file) {
  const auto picture = open_picture(file);
  if (!picture) return tl::unexpected(picture.error());
  const auto same = +[](float value) { return value; };
  auto rgba =
      read_rgba(*picture, file, OIIO::TypeDesc::FLOAT, 1.0f, picture->linear ? same : linear_from_srgb, same);
  if (!rgba) return tl::unexpected(std::move(rgba.error()));
  return FloatImage{picture->width, picture->height, std::move(*rgba)};
}

float srgb_from_linear(float linear) {
  const float value = std::clamp(linear, 0.0f, 1.0f);
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

float linear_from_srgb(float encoded) {
  const float value = std::clamp(encoded, 0.0f, 1.0f);
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t srgb_byte(float linear) {
  if (!(linear > 0.0f)) return 0;
  return static_cast<std::uint8_t>(std::lround(255.0f * srgb_from_linear(linear)));
}

} // namespace cupola::outputs
