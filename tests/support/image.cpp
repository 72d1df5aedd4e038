#include "tests/support/image.h"

#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fmt/format.h>

#include "renderer/outputs/image_file.h"
#include "renderer/reference/compare.h"

namespace cupola::tests {
namespace {

namespace fs = std::filesystem;
constexpr int magnification = 8;
constexpr std::size_t worst_shown = 8;

reference::Pixels pixels(const Shot& shot) { return {shot.rgba, shot.width, shot.height}; }

void keep(const fs::path& folder, const char* what, const Shot& shot) {
  const outputs::ByteView view{shot.rgba.data(), shot.width, shot.height};
  if (const auto written = outputs::write_image(folder / what, view); !written)
    MESSAGE(model::to_text(written.error().front()));
}

/// "3,17: got 10 20 30, wanted 11 90 30" for the pixels that differ most.
std::string worst_pixels(const Shot& got, const Shot& wanted) {
  struct Place {
    int difference;
    std::size_t pixel;
  };
  std::vector<Place> places;
  for (std::size_t i = 0; i < got.rgba.size(); i += 4) {
    int difference = 0;
    for (std::size_t c = i; c < i + 3; ++c)
      difference = std::max(difference, std::abs(int{got.rgba[c]} - int{wanted.rgba[c]}));
    if (difference > 0) places.push_back({difference, i / 4});
  }
  const std::size_t count = std::min(worst_shown, places.size());
  std::partial_sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count), places.end(),
                    [](const Place& a, const Place& b) { return a.difference > b.difference; });
  std::string text;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = 4 * places[n].pixel, width = static_cast<std::size_t>(got.width);
    text += fmt::format("\n  {},{}: got {} {} {}, wanted {} {} {}", places[n].pixel % width,
                        places[n].pixel / width, got.rgba[i], got.rgba[i + 1], got.rgba[i + 2],
                        wanted.rgba[i], wanted.rgba[i + 1], wanted.rgba[i + 2]);
  }
  return text;
}

void keep_failed(const Shot& got, const Shot& wanted, const std::string& name) {
  const fs::path folder = fs::path(CUPOLA_BINARY_DIR) / "failed" / fs::path(name).replace_extension();
  std::error_code error;
  fs::create_directories(folder, error);
  keep(folder, "got.png", got);
  keep(folder, "wanted.png", wanted);
  keep(folder, "difference.png",
       {got.width, got.height, reference::difference_picture(pixels(got), pixels(wanted), magnification)});
  MESSAGE("got.png, wanted.png and difference.png are in " << folder.string());
}

} // namespace

bool expect_same(const Shot& got, const Shot& wanted, const std::string& name, const Tolerance& tolerance) {
  CHECK_MESSAGE(!tolerance.because.empty(), name << ": a tolerance needs a reason");
  const bool same_size =
      got.width == wanted.width && got.height == wanted.height && got.width > 0 && got.height > 0;
  CHECK_MESSAGE(same_size, name << ": " << got.width << " x " << got.height << " pixels, wanted "
                                << wanted.width << " x " << wanted.height);
  if (!same_size) return false;
  const auto figures = reference::compare(pixels(got), pixels(wanted), {.threshold = tolerance.max_channel});
  const std::string text =
      fmt::format("{}: PSNR {:.2f} dB, SSIM {:.4f}, largest difference {}, {:.4f} % of the pixels beyond {} "
                  "(allowed {:.4f} %: {})",
                  name, figures.psnr_db, figures.ssim.value_or(1.0), figures.max_difference,
                  100.0 * figures.fraction_beyond(), tolerance.max_channel, 100.0 * tolerance.fraction_beyond,
                  tolerance.because);
  const bool passed = figures.fraction_beyond() <= tolerance.fraction_beyond;
  if (passed)
    fmt::print("{}\n", text);
  else
    keep_failed(got, wanted, name);
  CHECK_MESSAGE(passed, text << worst_pixels(got, wanted));
  return passed;
}

bool expect_image(const Shot& got, const std::string& golden, const Tolerance& tolerance) {
  const fs::path file = fs::path(CUPOLA_SOURCE_DIR) / "tests" / "golden" / golden;
  if (const char* update = std::getenv("CUPOLA_UPDATE_GOLDEN"); update && std::string(update) == "1") {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    const auto written =
        outputs::write_image(file, outputs::ByteView{got.rgba.data(), got.width, got.height});
    CHECK_MESSAGE(written.has_value(), "cannot write " << file.string());
    MESSAGE("written anew: " << file.string());
    return written.has_value();
  }
  const auto wanted = outputs::read_image(file);
  if (!wanted) {
    const fs::path folder = fs::path(CUPOLA_BINARY_DIR) / "failed" / fs::path(golden).replace_extension();
    std::error_code error;
    fs::create_directories(folder, error);
    keep(folder, "got.png", got);
  }
  CHECK_MESSAGE(wanted.has_value(), model::to_text(wanted.error().front()) << " Make it with ./dev golden.");
  return wanted && expect_same(got, {wanted->width, wanted->height, wanted->rgba}, golden, tolerance);
}

} // namespace cupola::tests
