#include "renderer/content/mipmap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cupola::content {
namespace {

/// x^2.4 by Newton with basic arithmetic alone: the same bits on every machine, which libm's pow is not.
double decode(double code) {
  if (code <= 0.04045) return code / 12.92;
  const double base = (code + 0.055) / 1.055; // x^2.4 = (x^12)^(1/5)
  const double square = base * base;
  const double power = square * square * square * square * square * square;
  double root = square;
  for (int i = 0; i < 80; ++i) {
    const double fourth = root * root * root * root;
    root -= (fourth * root - power) / (5.0 * fourth);
  }
  return root;
}

const std::array<float, 256>& decoded() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> made{};
    for (int i = 0; i < 256; ++i) made[static_cast<std::size_t>(i)] = static_cast<float>(decode(i / 255.0));
    return made;
  }();
  return table;
}

/// Light halfway between a code and the next, as codes count: where rounding changes.
const std::array<float, 255>& borders() {
  static const std::array<float, 255> table = [] {
    std::array<float, 255> made{};
    for (int i = 0; i < 255; ++i)
      made[static_cast<std::size_t>(i)] = static_cast<float>(decode((i + 0.5) / 255.0));
    return made;
  }();
  return table;
}

/// First guesses for 1024 steps of the square root of light.
const std::array<std::uint8_t, 1025>& guesses() {
  static const std::array<std::uint8_t, 1025> table = [] {
    std::array<std::uint8_t, 1025> made{};
    for (int i = 0; i <= 1024; ++i) {
      const auto light = static_cast<float>(i / 1024.0 * (i / 1024.0));
      made[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(
          std::upper_bound(borders().begin(), borders().end(), light) - borders().begin());
    }
    return made;
  }();
  return table;
}

/// Which texels of the finer level one texel covers along an axis, and by how much.
struct Span {
  int first = 0;
  int count = 0;
  std::array<float, 4> weight{};
};

std::vector<Span> spans(int from, int to) {
  std::vector<Span> all(static_cast<std::size_t>(to));
  const double step = static_cast<double>(from) / to; // 1 to 3
  for (int i = 0; i < to; ++i) {
    const double begin = i * step;
    const double end = std::min<double>(from, begin + step);
    Span& span = all[static_cast<std::size_t>(i)];
    span.first = static_cast<int>(begin);
    for (int texel = span.first; texel < from && texel < end && span.count < 4; ++texel)
      span.weight[static_cast<std::size_t>(span.count++)] =
          static_cast<float>((std::min<double>(end, texel + 1) - std::max<double>(begin, texel)) / step);
  }
  return all;
}

MipChain::Level halve(const MipChain::Level& fine, bool srgb) {
  MipChain::Level coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
  coarse.rgba.resize(std::size_t{4} * static_cast<std::size_t>(coarse.width) *
                     static_cast<std::size_t>(coarse.height));
  const std::vector<Span> columns = spans(fine.width, coarse.width);
  const std::vector<Span> rows = spans(fine.height, coarse.height);
  std::uint8_t* out = coarse.rgba.data();
  for (const Span& row : rows) {
    for (const Span& column : columns) {
      std::array<float, 4> sum{};
      for (int y = 0; y < row.count; ++y) {
        const std::size_t start =
            (static_cast<std::size_t>(row.first + y) * static_cast<std::size_t>(fine.width) +
             static_cast<std::size_t>(column.first)) *
            4;
        const std::uint8_t* texel = fine.rgba.data() + start;
        for (int x = 0; x < column.count; ++x, texel += 4) {
          const float weight =
              row.weight[static_cast<std::size_t>(y)] * column.weight[static_cast<std::size_t>(x)];
          for (std::size_t c = 0; c < 4; ++c)
            sum[c] += weight * (srgb && c < 3 ? decoded()[texel[c]] : static_cast<float>(texel[c]) / 255.0f);
        }
      }
      for (std::size_t c = 0; c < 4; ++c)
        *out++ = srgb && c < 3 ? linear_to_srgb(sum[c])
                               : static_cast<std::uint8_t>(std::clamp(sum[c] * 255.0f + 0.5f, 0.0f, 255.0f));
    }
  }
  return coarse;
}

int wrapped(long long texel, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<long long>(texel, 0, size - 1));
  const long long period = wrap == Wrap::mirror ? 2LL * size : size;
  long long rest = texel % period;
  if (rest < 0) rest += period;
  return static_cast<int>(rest < size ? rest : period - 1 - rest);
}

glm::vec4 fetch(const MipChain::Level& level, bool srgb, const Texture& texture, long long x, long long y) {
  const auto column = static_cast<std::size_t>(wrapped(x, level.width, texture.wrap_s));
  const auto row = static_cast<std::size_t>(wrapped(y, level.height, texture.wrap_t));
  const std::uint8_t* texel = level.rgba.data() + (row * static_cast<std::size_t>(level.width) + column) * 4;
  const float alpha = static_cast<float>(texel[3]) / 255.0f;
  if (srgb) return {decoded()[texel[0]], decoded()[texel[1]], decoded()[texel[2]], alpha};
  return glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f;
}

/// Far outside any sensible range a coordinate is no place any more; keeps the conversion to integers
/// defined.
double bounded(double texels) { return std::isfinite(texels) ? std::clamp(texels, -1e15, 1e15) : 0.0; }

glm::vec4 bilinear(const MipChain::Level& level, bool srgb, const Texture& texture, glm::vec2 uv) {
  const double x = bounded(static_cast<double>(uv.x) * level.width - 0.5);
  const double y = bounded(static_cast<double>(uv.y) * level.height - 0.5);
  const double left = std::floor(x);
  const double top = std::floor(y);
  const auto fx = static_cast<float>(x - left);
  const auto fy = static_cast<float>(y - top);
  const auto i = static_cast<long long>(left);
  const auto j = static_cast<long long>(top);
  const glm::vec4 upper =
      fetch(level, srgb, texture, i, j) * (1.0f - fx) + fetch(level, srgb, texture, i + 1, j) * fx;
  const glm::vec4 lower =
      fetch(level, srgb, texture, i, j + 1) * (1.0f - fx) + fetch(level, srgb, texture, i + 1, j + 1) * fx;
  return upper * (1.0f - fy) + lower * fy;
}

} // namespace

float srgb_to_linear(std::uint8_t code) { return decoded()[code]; }

std::uint8_t linear_to_srgb(float linear) {
  const float light = std::clamp(linear, 0.0f, 1.0f);
  std::size_t code = guesses()[static_cast<std::size_t>(std::sqrt(light) * 1024.0f)];
  while (code < 255 && light >= borders()[code]) ++code;
  while (code > 0 && light < borders()[code - 1]) --code;
  return static_cast<std::uint8_t>(code);
}

MipChain make_mipmaps(const Image& image) {
  MipChain chain;
  chain.srgb = image.srgb;
  if (image.width <= 0 || image.height <= 0) return chain;
  chain.levels.push_back({image.width, image.height, image.rgba});
  while (chain.levels.back().width > 1 || chain.levels.back().height > 1)
    chain.levels.push_back(halve(chain.levels.back(), image.srgb));
  return chain;
}

glm::vec4 sample(const MipChain& image, const Texture& texture, glm::vec2 uv, float lod) {
  if (image.levels.empty()) return glm::vec4(1.0f);
  if (!texture.mipmaps || !(lod > 0.0f)) {
    const MipChain::Level& level = image.levels.front();
    if (!texture.nearest || lod > 0.0f) return bilinear(level, image.srgb, texture, uv);
    const double x = std::floor(bounded(static_cast<double>(uv.x) * level.width));
    const double y = std::floor(bounded(static_cast<double>(uv.y) * level.height));
    return fetch(level, image.srgb, texture, static_cast<long long>(x), static_cast<long long>(y));
  }
  const auto last = static_cast<float>(image.levels.size() - 1);
  const float clamped = std::min(lod, last);
  const float lower = std::floor(clamped);
  const auto index = static_cast<std::size_t>(lower);
  const float mix = clamped - lower;
  const glm::vec4 fine = bilinear(image.levels[index], image.srgb, texture, uv);
  if (mix == 0.0f) return fine;
  return fine * (1.0f - mix) + bilinear(image.levels[index + 1], image.srgb, texture, uv) * mix;
}

} // namespace cupola::content
