// Numbers that are the same on every machine: integer mixing, and sine and cosine from basic arithmetic
// alone.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace cupola::content {

/// One well mixed number out of another (the finaliser of splitmix64).
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// A stream of numbers that belongs to a place: the same whatever else was drawn before.
class Random {
public:
  Random(std::initializer_list<std::int64_t> key) {
    for (const std::int64_t part : key) state_ = mix_bits(state_ ^ static_cast<std::uint64_t>(part));
  }
  [[nodiscard]] std::uint64_t bits() { return mix_bits(state_ += 0x9e3779b97f4a7c15ULL); }
  /// 0 to 1, 1 excluded.
  [[nodiscard]] double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  [[nodiscard]] double between(double low, double high) { return low + (high - low) * unit(); }
  /// 0 to count - 1.
  [[nodiscard]] int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  [[nodiscard]] bool chance(double probability) { return unit() < probability; }

private:
  std::uint64_t state_ = 0x6a09e667f3bcc908ULL;
};

/// Sine of a number of full turns; within 1e-9 of the truth.
[[nodiscard]] inline double sine_of_turns(double turns) {
  double x = turns - std::floor(turns + 0.5); // -0.5 to 0.5
  if (x > 0.25) x = 0.5 - x;
  if (x < -0.25) x = -0.5 - x;
  const double a = x * 6.283185307179586;
  const double s = a * a;
  double sum = 1.0; // Taylor's series, from its far end
  for (int n = 8; n >= 1; --n) sum = 1.0 - s * sum / ((2.0 * n) * (2.0 * n + 1.0));
  return a * sum;
}
[[nodiscard]] inline double cosine_of_turns(double turns) { return sine_of_turns(turns + 0.25); }

} // namespace cupola::content
