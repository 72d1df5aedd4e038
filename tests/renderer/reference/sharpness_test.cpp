#include "renderer/reference/sharpness.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>

namespace cupola::reference {
namespace {

constexpr int size = 40;

struct Owned {
  std::vector<std::uint8_t> rgba;
  explicit Owned(const std::function<double(int x, int y)>& grey)
      : rgba(std::size_t{4} * size * size, 255) {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (int c = 0; c < 3; ++c)
          rgba[static_cast<std::size_t>(4 * (y * size + x) + c)] =
              static_cast<std::uint8_t>(std::lround(grey(x, y)));
  }
  operator Pixels() const { return {rgba, size, size}; }
};

/// A dark and a bright half; between them a slope `width` pixels wide.
Owned edge(double width, int moved = 0) {
  return Owned([=](int x, int) {
    const double across = (x + 0.5 - size / 2.0 - moved) / width;
    return 20.0 + 200.0 * std::clamp(across + 0.5, 0.0, 1.0);
  });
}

} // namespace

TEST_CASE("the same picture has the same edges") {
  CHECK(edge_sharpness(edge(2.0), edge(2.0)).value() == doctest::Approx(1.0));
}

TEST_CASE("blur lowers edge sharpness, and what is steeper raises it") {
  CHECK(edge_sharpness(edge(4.0), edge(2.0)).value() < 0.8);
  CHECK(edge_sharpness(edge(1.0), edge(4.0)).value() > 1.2);
}

TEST_CASE("an edge in another place does not count") {
  CHECK(edge_sharpness(edge(2.0, 8), edge(2.0)).value() == doctest::Approx(0.0));
}

TEST_CASE("no edge, no figure") {
  const Owned even([](int, int) { return 90.0; });
  CHECK(!edge_sharpness(edge(2.0), even).has_value());
}

TEST_CASE("what the mask leaves out is not looked at") {
  Owned wanted = edge(2.0);
  for (std::size_t i = 3; i < wanted.rgba.size(); i += 4) wanted.rgba[i] = 0;
  CHECK(edge_sharpness(edge(4.0), wanted).has_value());
  CHECK(!edge_sharpness(edge(4.0), wanted, true).has_value());
}

} // namespace cupola::reference
