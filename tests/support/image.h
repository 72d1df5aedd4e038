// Pictures in tests: judged against a golden one, with a tolerance and its reason.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cupola::tests {

/// 8 bit RGBA as displays take it, rows from the top.
struct Shot {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

struct Tolerance {
  int max_channel = 0;          ///< a pixel is beyond when a channel of R, G, B differs by more
  double fraction_beyond = 0.0; ///< of all pixels that may be beyond
  std::string because;          ///< why not 0; must be said
};

/// Checks `got` against tests/golden/`golden` ("cylinder/piecewise.png") and prints the figures, also when it
/// passes. On failure the worst pixels are printed, and three pictures are kept in the build folder under
/// failed/: got, wanted, difference magnified. With CUPOLA_UPDATE_GOLDEN=1 in the environment the golden
/// picture is written anew instead. Reports through doctest (CHECK); returns whether it passed.
bool expect_image(const Shot& got, const std::string& golden, const Tolerance& tolerance);

/// The same against a picture at hand; `name` is for messages and for the files kept.
bool expect_same(const Shot& got, const Shot& wanted, const std::string& name, const Tolerance& tolerance);

} // namespace cupola::tests
