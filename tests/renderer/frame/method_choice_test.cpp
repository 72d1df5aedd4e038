#include "renderer/frame/method_choice.h"

#include <doctest/doctest.h>

using cupola::frame::MethodChoice;
using cupola::model::Method;

namespace {

/// Draws a whole trial in which a frame by pieces and one by the cubemap take so long.
void try_both(MethodChoice& choice, double pieces, double cubemap) {
  while (choice.trying()) choice.record(choice.method() == Method::piecewise ? pieces : cubemap);
}

} // namespace

TEST_CASE("the quicker method stays") {
  MethodChoice choice;
  CHECK(choice.trying());
  try_both(choice, 10.0, 20.0);
  CHECK(choice.method() == Method::piecewise);
  choice.record(1000.0); // later frames do not matter
  CHECK(choice.method() == Method::piecewise);
  choice.restart();
  CHECK(choice.trying());
  try_both(choice, 21.0, 20.0);
  CHECK(choice.method() == Method::cubemap);
}

TEST_CASE("a first frame that compiles and uploads does not count, nor does one that was disturbed") {
  MethodChoice choice;
  int piecewise = 0;
  while (choice.trying()) {
    if (choice.method() == Method::piecewise) {
      const double times[] = {500.0, 10.0, 80.0};
      choice.record(times[piecewise++]);
    } else {
      choice.record(12.0);
    }
  }
  CHECK(piecewise == MethodChoice::frames_each);
  CHECK(choice.method() == Method::piecewise);
}
