#include "renderer/reference/compare.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace cupola::reference {
namespace {

constexpr int window = 11;
constexpr double sigma = 1.5;

bool same_size(const Pixels& a, const Pixels& b) {
  return a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0 &&
         a.rgba.size() == b.rgba.size() &&
         a.rgba.size() == 4 * static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
}

std::array<double, window> gaussian() {
  std::array<double, window> weights{};
  double sum = 0.0;
  for (int i = 0; i < window; ++i) {
    const double x = i - window / 2;
    sum += weights[static_cast<std::size_t>(i)] = std::exp(-x * x / (2.0 * sigma * sigma));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

struct Plane {
  std::size_t width = 0, height = 0;
  std::vector<double> values;
};

Plane luma(const Pixels& picture) {
  Plane plane{static_cast<std::size_t>(picture.width), static_cast<std::size_t>(picture.height), {}};
  plane.values.reserve(plane.width * plane.height);
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    plane.values.push_back(0.299 * picture.rgba[i] + 0.587 * picture.rgba[i + 1] +
                           0.114 * picture.rgba[i + 2]);
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out{a.width, a.height, std::vector<double>(a.values.size())};
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
  return out;
}

/// Weighted means over all windows that lie inside: 10 pixels less each way.
Plane smoothed(const Plane& plane) {
  static const std::array<double, window> weights = gaussian();
  Plane across{plane.width - window + 1, plane.height, {}};
  across.values.reserve(across.width * across.height);
  for (std::size_t y = 0; y < across.height; ++y)
    for (std::size_t x = 0; x < across.width; ++x) {
      double sum = 0.0;
      for (std::size_t i = 0; i < window; ++i) sum += weights[i] * plane.values[y * plane.width + x + i];
      across.values.push_back(sum);
    }
  Plane out{across.width, plane.height - window + 1, {}};
  out.values.assign(out.width * out.height, 0.0);
  for (std::size_t y = 0; y < out.height; ++y)
    for (std::size_t i = 0; i < window; ++i)
      for (std::size_t x = 0; x < out.width; ++x)
        out.values[y * out.width + x] += weights[i] * across.values[(y + i) * across.width + x];
  return out;
}

std::optional<double> structural_similarity(const Pixels& got, const Pixels& wanted, bool mask) {
  if (got.width < window || got.height < window) return std::nullopt;
  constexpr double c1 = (0.01 * 255.0) * (0.01 * 255.0), c2 = (0.03 * 255.0) * (0.03 * 255.0);
  const Plane a = luma(got), b = luma(wanted);
  const Plane mean_a = smoothed(a), mean_b = smoothed(b);
  const Plane square_a = smoothed(product(a, a)), square_b = smoothed(product(b, b));
  const Plane cross = smoothed(product(a, b));
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t y = 0; y < cross.height; ++y)
    for (std::size_t x = 0; x < cross.width; ++x) {
      if (mask && wanted.rgba[4 * ((y + window / 2) * a.width + x + window / 2) + 3] == 0) continue;
      const std::size_t i = y * cross.width + x;
      const double ma = mean_a.values[i], mb = mean_b.values[i];
      const double va = square_a.values[i] - ma * ma, vb = square_b.values[i] - mb * mb;
      const double covariance = cross.values[i] - ma * mb;
      sum += (2.0 * ma * mb + c1) * (2.0 * covariance + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
      ++count;
    }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

} // namespace

Comparison compare(const Pixels& got, const Pixels& wanted, const CompareOptions& options) {
  assert(same_size(got, wanted));
  Comparison result;
  std::uint64_t squares = 0; // exact: 2^28 pixels of 3 · 255² fit
  for (std::size_t i = 0; i < got.rgba.size(); i += 4) {
    if (options.mask && wanted.rgba[i + 3] == 0) continue;
    ++result.compared;
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int difference = std::abs(int{got.rgba[i + c]} - int{wanted.rgba[i + c]});
      squares += static_cast<std::uint64_t>(difference * difference);
      worst = std::max(worst, difference);
    }
    if (worst > options.threshold) ++result.beyond;
    if (worst > result.max_difference) {
      result.max_difference = worst;
      const auto pixel = static_cast<int>(i / 4);
      result.worst_x = pixel % got.width;
      result.worst_y = pixel / got.width;
    }
  }
  const double mean =
      static_cast<double>(squares) / (3.0 * static_cast<double>(std::max<std::size_t>(result.compared, 1)));
  result.psnr_db =
      squares == 0 ? std::numeric_limits<double>::infinity() : 10.0 * std::log10(255.0 * 255.0 / mean);
  if (options.ssim) result.ssim = structural_similarity(got, wanted, options.mask);
  return result;
}

std::vector<std::uint8_t> difference_picture(const Pixels& got, const Pixels& wanted, int magnification) {
  assert(same_size(got, wanted));
  std::vector<std::uint8_t> out(got.rgba.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = i % 4 == 3 ? std::uint8_t{255}
                        : static_cast<std::uint8_t>(std::min(
                              255, magnification * std::abs(int{got.rgba[i]} - int{wanted.rgba[i]})));
  return out;
}

} // namespace cupola::reference
