#include "renderer/outputs/image_file.h"

#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <limits>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace cupola::outputs {
namespace {

/// A folder of its own, gone with the test.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("cupola-image-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path), {}));
  }
  static inline int count = 0;
};

/// The letter F in red on white, 5 × 7: no symmetry, so that a flip or a turn shows. The foot is half
/// transparent.
ByteImage letter_f() {
  const char* rows[7] = {"#####", "#....", "#....", "####.", "#....", "#....", "#...."};
  ByteImage image{5, 7, {}};
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 5; ++x) {
      const bool ink = rows[y][x] == '#';
      for (int value : {ink ? 200 : 255, ink ? 30 : 255, ink ? 10 : 255, y == 6 ? 128 : 255})
        image.rgba.push_back(static_cast<std::uint8_t>(value));
    }
  return image;
}

int byte_at(const ByteImage& image, int x, int y, int channel) {
  return image.rgba[static_cast<std::size_t>(4 * (y * image.width + x) + channel)];
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_CASE("the sRGB curve has the standard's values, and each byte survives the way there and back") {
  CHECK(srgb_from_linear(0.0f) == 0.0f);
  CHECK(srgb_from_linear(1.0f) == doctest::Approx(1.0f));
  CHECK(srgb_from_linear(0.0031308f) == doctest::Approx(0.04045f).epsilon(1e-4));
  CHECK(srgb_from_linear(0.214041f) == doctest::Approx(0.5f).epsilon(1e-5)); // middle grey
  CHECK(srgb_from_linear(-3.0f) == 0.0f);
  CHECK(srgb_byte(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(srgb_byte(std::numeric_limits<float>::infinity()) == 255);
  for (int byte = 0; byte < 256; ++byte)
    CHECK(srgb_byte(linear_from_srgb(static_cast<float>(byte) / 255.0f)) == byte);
}

TEST_CASE("bytes survive PNG and TIFF exactly, alpha included") {
  const Folder folder;
  const ByteImage image = letter_f();
  for (const char* name : {"f.png", "f.tif", "f.TIFF"}) {
    CAPTURE(name);
    REQUIRE(write_image(folder.path / name, view(image)));
    const auto back = read_image(folder.path / name);
    if (!back) MESSAGE(model::to_text(back.error().front()));
    REQUIRE(back);
    CHECK(back->width == 5);
    CHECK(back->height == 7);
    CHECK(back->rgba == image.rgba);
  }
  CHECK(folder.entries() == 3); // no temporary file stays behind
}

TEST_CASE("a bottom-up view is turned upright") {
  const Folder folder;
  const ByteImage image = letter_f();
  ByteView flipped = view(image);
  flipped.bottom_up = true;
  REQUIRE(write_image(folder.path / "f.png", flipped));
  const auto back = read_image(folder.path / "f.png");
  REQUIRE(back);
  CHECK(byte_at(*back, 4, 6, 0) == 200); // the F's top bar now lies at the bottom
  CHECK(byte_at(*back, 4, 0, 0) == 255);
}

TEST_CASE("alpha can be left out") {
  const Folder folder;
  const ByteImage image = letter_f();
  ByteView opaque = view(image);
  opaque.alpha = false;
  REQUIRE(write_image(folder.path / "f.png", opaque));
  const auto back = read_image(folder.path / "f.png");
  REQUIRE(back);
  CHECK(byte_at(*back, 0, 6, 3) == 255);
  CHECK(byte_at(*back, 0, 6, 0) == 200);
}

TEST_CASE("JPEG keeps the picture about, and without alpha") {
  const Folder folder;
  ByteImage flat{32, 16, {}};
  for (int i = 0; i < 32 * 16; ++i)
    for (int value : {40, 120, 220, 7}) flat.rgba.push_back(static_cast<std::uint8_t>(value));
  REQUIRE(write_image(folder.path / "flat.jpg", view(flat)));
  const auto back = read_image(folder.path / "flat.jpg");
  REQUIRE(back);
  CHECK(std::abs(byte_at(*back, 17, 9, 0) - 40) <= 2); // the YCbCr rounding of JPEG
  CHECK(std::abs(byte_at(*back, 17, 9, 1) - 120) <= 2);
  CHECK(std::abs(byte_at(*back, 17, 9, 2) - 220) <= 2);
  CHECK(byte_at(*back, 17, 9, 3) == 255);
}

TEST_CASE("floats survive EXR and TIFF in linear light, beyond white too") {
  const Folder folder;
  const FloatImage image{2, 1, {0.25f, 3.5f, 0.0f, 1.0f, 1.0f, 0.5f, 0.125f, 0.5f}};
  for (const char* name : {"x.exr", "x.tif"}) {
    CAPTURE(name);
    REQUIRE(write_image(folder.path / name, view(image)));
    const auto back = read_linear_image(folder.path / name);
    REQUIRE(back);
    REQUIRE(back->rgba.size() == 8);
    for (std::size_t i = 0; i < 8; ++i) CHECK(back->rgba[i] == doctest::Approx(image.rgba[i]).epsilon(1e-6));
  }
}

TEST_CASE("bytes and floats meet through the sRGB curve") {
  const Folder folder;
  const FloatImage grey{1, 1, {0.2158605f, 0.0f, 1.0f, 1.0f}};
  REQUIRE(write_image(folder.path / "grey.png", view(grey)));
  const auto bytes = read_image(folder.path / "grey.png");
  REQUIRE(bytes);
  CHECK(bytes->rgba == std::vector<std::uint8_t>{128, 0, 255, 255});

  const ByteImage image = letter_f();
  REQUIRE(write_image(folder.path / "f.exr", view(image))); // half floats hold every byte of the curve
  const auto back = read_image(folder.path / "f.exr");
  REQUIRE(back);
  CHECK(back->rgba == image.rgba);
  const auto linear = read_linear_image(folder.path / "f.exr");
  REQUIRE(linear);
  CHECK(linear->rgba[0] == doctest::Approx(linear_from_srgb(200.0f / 255.0f)).epsilon(1e-3));
}

TEST_CASE("encoding in memory gives whole files") {
  const Folder folder;
  const ByteImage image = letter_f();
  const auto png = encode_png(view(image));
  REQUIRE(png);
  std::ofstream(folder.path / "m.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(png->data()), static_cast<std::streamsize>(png->size()));
  const auto back = read_image(folder.path / "m.png");
  REQUIRE(back);
  CHECK(back->rgba == image.rgba);

  const auto jpeg = encode_jpeg(view(image), 80);
  REQUIRE(jpeg);
  REQUIRE(jpeg->size() > 4);
  CHECK((*jpeg)[0] == 0xff); // start of image … end of image
  CHECK((*jpeg)[1] == 0xd8);
  CHECK((*jpeg)[jpeg->size() - 2] == 0xff);
  CHECK((*jpeg)[jpeg->size() - 1] == 0xd9);
  CHECK_FALSE(encode_png({}));
  CHECK_FALSE(encode_jpeg({}));
}

TEST_CASE("grey pictures become RGB, and a picture without alpha is opaque") {
  const Folder folder;
  std::ofstream(folder.path / "grey.pgm", std::ios::binary) << "P5\n2 1\n255\n" << char(10) << char(100);
  const auto grey = read_image(folder.path / "grey.pgm");
  REQUIRE(grey);
  CHECK(grey->rgba == std::vector<std::uint8_t>{10, 10, 10, 255, 100, 100, 100, 255});
  const auto linear = read_linear_image(folder.path / "grey.pgm");
  REQUIRE(linear);
  CHECK(linear->rgba[4] == doctest::Approx(linear_from_srgb(100.0f / 255.0f)));
  CHECK(linear->rgba[7] == 1.0f);
}

TEST_CASE("what cannot be written is a problem and leaves nothing behind") {
  const Folder folder;
  const ByteImage image = letter_f();
  const auto code = [](const auto& result) { return result.error().front().code; };
  const auto extension = write_image(folder.path / "f.bmp2", view(image));
  REQUIRE_FALSE(extension);
  CHECK(code(extension) == model::Code::image_unwritable);
  CHECK(extension.error().front().advice == "Use png, jpg, exr or tif.");
  CHECK_FALSE(write_image(folder.path / "noextension", view(image)));
  CHECK_FALSE(write_image(folder.path / "missing" / "f.png", view(image)));
  CHECK_FALSE(write_image(folder.path / "f.png", ByteView{}));
  std::filesystem::create_directories(folder.path / "taken.png" / "inside");
  CHECK_FALSE(write_image(folder.path / "taken.png", view(image)));
  CHECK(folder.entries() == 1); // the folder taken.png
  if (std::filesystem::exists("/dev/full")) {
    std::filesystem::create_symlink("/dev/full", folder.path / "full.png");
    REQUIRE(
        write_image(folder.path / "full.png", view(image))); // the link is replaced, never written through
    CHECK(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder.path / "full.png")));
  }
}

TEST_CASE("what cannot be read is a problem") {
  const Folder folder;
  const auto refused = [](const std::filesystem::path& file) {
    const auto result = read_image(file);
    return !result && result.error().front().code == model::Code::image_unreadable &&
           !result.error().front().found.empty();
  };
  CHECK(refused(folder.path / "missing.png"));
  CHECK(refused(folder.path));
  std::ofstream(folder.path / "text.png") << "this is not a picture";
  CHECK(refused(folder.path / "text.png"));
  std::ofstream(folder.path / "empty.png").flush();
  CHECK(refused(folder.path / "empty.png"));
  REQUIRE(::mkfifo((folder.path / "pipe.png").c_str(), 0600) == 0);
  CHECK(refused(folder.path / "pipe.png"));
  // A picture of 60,000 x 60,000 pixels, which nobody has memory for, in a file of a few bytes.
  std::ofstream(folder.path / "vast.ppm", std::ios::binary) << "P6\n60000 60000\n255\n";
  CHECK(refused(folder.path / "vast.ppm"));
  // A PNG cut in the middle of its pixels.
  ByteImage noise{64, 64, std::vector<std::uint8_t>(64 * 64 * 4)};
  std::uint32_t state = 1;
  for (auto& byte : noise.rgba)
    byte = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  REQUIRE(write_image(folder.path / "whole.png", view(noise)));
  const std::string whole = bytes_of(folder.path / "whole.png");
  std::ofstream(folder.path / "cut.png", std::ios::binary)
      .write(whole.data(), static_cast<std::streamsize>(whole.size() / 2));
  CHECK(refused(folder.path / "cut.png"));
}

} // namespace cupola::outputs
