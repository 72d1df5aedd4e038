#include "tests/support/image.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>

namespace cupola::tests {
namespace {

Shot flat(int width, int height, std::uint8_t grey) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height), grey)};
}

const std::filesystem::path failed = std::filesystem::path(CUPOLA_BINARY_DIR) / "failed";

} // namespace

TEST_CASE("a picture within its tolerance passes, also at the very limit") {
  Shot wanted = flat(16, 16, 90), got = wanted;
  got.rgba[0] = 93;  // within 3
  got.rgba[40] = 99; // one of 256 pixels beyond
  CHECK(expect_same(got, wanted, "support/limit", {3, 1.0 / 256.0, "one pixel was changed by hand"}));
}

TEST_CASE("one pixel too many fails" * doctest::should_fail()) {
  Shot wanted = flat(16, 16, 90), got = wanted;
  got.rgba[4] = got.rgba[40] = 200;
  std::filesystem::remove_all(failed / "support/beyond");
  expect_same(got, wanted, "support/beyond.png", {3, 1.0 / 256.0, "two pixels were changed by hand"});
}

TEST_CASE("and keeps three pictures") { // after the case before: doctest runs a file in order
  for (const char* picture : {"got.png", "wanted.png", "difference.png"})
    CHECK(std::filesystem::exists(failed / "support/beyond" / picture));
}

TEST_CASE("another size fails" * doctest::should_fail()) {
  expect_same(flat(4, 4, 1), flat(4, 5, 1), "support/size", {255, 1.0, "only the sizes differ"});
}

TEST_CASE("a tolerance without a reason fails" * doctest::should_fail()) {
  expect_same(flat(4, 4, 1), flat(4, 4, 1), "support/why", {});
}

TEST_CASE("a missing golden picture fails" * doctest::should_fail()) {
  expect_image(flat(4, 4, 1), "support/missing.png", {255, 1.0, "there is none"});
}

} // namespace cupola::tests
