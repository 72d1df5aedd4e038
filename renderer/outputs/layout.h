// Where pictures and windows go. Pure.
#pragma once

#include <vector>

namespace cupola::outputs {

/// Pixels; y downwards for windows on a monitor. For pictures in a window the direction does not matter.
struct Rect {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Rect&) const = default;
};

struct Size {
  int width = 0, height = 0;
  bool operator==(const Size&) const = default;
};

/// The largest rectangle of the picture's shape inside the window, centred; black bars fill the rest.
[[nodiscard]] Rect letterbox(Size picture, Size window);

/// Windows side by side in rows, in the order given, all at one scale (1, 3/4, 1/2, 1/3, 1/4 …) and as large
/// as lets them fit the area. `gap`: pixels left between them, for frames and title bars.
[[nodiscard]] std::vector<Rect> tile(const std::vector<Size>& pictures, Size area, int gap);

} // namespace cupola::outputs
