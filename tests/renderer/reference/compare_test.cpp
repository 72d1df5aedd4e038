#include "renderer/reference/compare.h"

#include <cmath>
#include <doctest/doctest.h>

namespace cupola::reference {
namespace {

struct Owned {
  int width, height;
  std::vector<std::uint8_t> rgba;
  Owned(int w, int h, std::uint8_t grey)
      : width(w)
      , height(h)
      , rgba(static_cast<std::size_t>(4 * w * h), grey) {
    for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
  }
  std::uint8_t& at(int x, int y, int c) { return rgba[static_cast<std::size_t>(4 * (y * width + x) + c)]; }
  operator Pixels() const { return {rgba, width, height}; }
};

/// The pictures that tests/renderer/reference/compare_figures.py makes too.
Owned pattern(int width, int height, std::uint32_t seed, int amplitude) {
  Owned out(width, height, 0);
  std::uint32_t state = seed;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        state = state * 1664525u + 1013904223u;
        const int noise = static_cast<int>(state >> 24) % (2 * amplitude + 1) - amplitude;
        const int value = 128 + 5 * (x % 16) - 3 * (y % 20) + 10 * c + noise;
        out.at(x, y, c) = static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
      }
  return out;
}

} // namespace

TEST_CASE("equal pictures") {
  const Owned a(20, 13, 77);
  const Comparison result = compare(a, a);
  CHECK(std::isinf(result.psnr_db));
  CHECK(result.ssim.value() == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(result.max_difference == 0);
  CHECK(result.compared == 260);
  CHECK(result.fraction_beyond() == 0.0);
}

TEST_CASE("PSNR, largest difference and fraction by hand") {
  Owned wanted(10, 4, 100), got(10, 4, 100);
  got.at(3, 2, 1) = 112; // +12 in one of 120 samples
  got.at(7, 0, 0) = 95;  // -5
  const Comparison result = compare(got, wanted, {.threshold = 5});
  CHECK(result.psnr_db == doctest::Approx(10.0 * std::log10(255.0 * 255.0 * 120.0 / (144.0 + 25.0))));
  CHECK(result.max_difference == 12);
  CHECK(result.worst_x == 3);
  CHECK(result.worst_y == 2);
  CHECK(result.beyond == 1); // 5 is not beyond 5
  CHECK(result.fraction_beyond() == doctest::Approx(1.0 / 40.0));
  CHECK_FALSE(result.ssim.has_value()); // no window of 11 × 11 fits
}

TEST_CASE("black against white is 0 dB; two flat greys have the SSIM of their means alone") {
  CHECK(compare(Owned(12, 12, 0), Owned(12, 12, 255)).psnr_db == doctest::Approx(0.0));
  const double c1 = 2.55 * 2.55;
  const Comparison greys = compare(Owned(15, 12, 100), Owned(15, 12, 120));
  CHECK(greys.ssim.value() ==
        doctest::Approx((2.0 * 100.0 * 120.0 + c1) / (100.0 * 100.0 + 120.0 * 120.0 + c1)).epsilon(1e-9));
  CHECK(greys.psnr_db == doctest::Approx(20.0 * std::log10(255.0 / 20.0)));
}

TEST_CASE("the figures of an independent computation in numpy") { // compare_figures.py prints them
  const Owned a = pattern(40, 33, 1, 20), b = pattern(40, 33, 2, 35);
  const Comparison result = compare(a, b, {.threshold = 30});
  CHECK(result.psnr_db == doctest::Approx(20.741995496633).epsilon(1e-9));
  CHECK(result.ssim.value() == doctest::Approx(0.660095673137).epsilon(1e-9));
  CHECK(result.max_difference == 55);
  CHECK(result.beyond == 671);
}

TEST_CASE("the mask leaves out what the wanted picture does not show") {
  Owned wanted(24, 24, 50), got(24, 24, 50);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 12; ++x) {
      wanted.at(x, y, 3) = 0;
      got.at(x, y, 0) = 255;
    }
  const Comparison masked = compare(got, wanted, {.mask = true});
  CHECK(masked.compared == 288);
  CHECK(std::isinf(masked.psnr_db));
  CHECK(masked.max_difference == 0);
  CHECK(masked.ssim.has_value());
  CHECK(compare(got, wanted).max_difference == 205);
  for (std::size_t i = 3; i < wanted.rgba.size(); i += 4) wanted.rgba[i] = 0;
  const Comparison nothing = compare(got, wanted, {.mask = true});
  CHECK(nothing.compared == 0);
  CHECK_FALSE(nothing.ssim.has_value());
}

TEST_CASE("the difference picture is magnified, clamped and opaque") {
  Owned wanted(3, 1, 10), got(3, 1, 10);
  got.at(0, 0, 0) = 14;
  got.at(1, 0, 1) = 0;
  got.at(2, 0, 2) = 200;
  const auto picture = difference_picture(got, wanted, 10);
  CHECK(picture == std::vector<std::uint8_t>{40, 0, 0, 255, 0, 100, 0, 255, 0, 0, 255, 255});
}

} // namespace cupola::reference
