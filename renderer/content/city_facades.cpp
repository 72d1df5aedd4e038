// Façades: 24 m by 24 m, eight bays by eight storeys, the ground at the bottom. Single windows differ (light,
// curtains, blinds), so that the repetition does not show at once.
#include "renderer/content/canvas.h"
#include "renderer/content/city_pictures.h"
#include "renderer/content/random.h"

namespace cupola::content::city {
namespace {

constexpr int facade_pixels = 1024;
constexpr float edge = 24.0f;
constexpr int cells = 8;
constexpr float cell = 3.0f;

struct Frame {
  float left, top, right, bottom;
};

/// A pane that mirrors the sky above and the street below, some with curtains or a lamp behind.
void pane(Canvas& canvas, const Frame& f, Random& random) {
  const auto shade = static_cast<float>(random.between(0.75, 1.15));
  canvas.gradient(f.left, f.top, f.right, f.bottom, rgb(0x6d8299) * shade, rgb(0x2b333d) * shade);
  const double draw = random.unit();
  const float height = f.bottom - f.top;
  const float width = f.right - f.left;
  if (draw < 0.22) { // blind
    canvas.rectangle(f.left, f.top, f.right, f.top + height * static_cast<float>(random.between(0.25, 0.8)),
                     rgb(0xb9b3a4) * shade);
  } else if (draw < 0.42) { // curtains
    canvas.rectangle(f.left, f.top, f.left + width * 0.22f, f.bottom, rgb(0xc9bfae) * shade);
    canvas.rectangle(f.right - width * 0.22f, f.top, f.right, f.bottom, rgb(0xc0b6a6) * shade);
  } else if (draw < 0.5) { // a lamp behind
    canvas.gradient(f.left, f.top, f.right, f.bottom, rgb(0xd8b878), rgb(0x8f7446));
  }
}

/// Frame, sash bars and sill around a pane.
void sash_window(Canvas& canvas, const Frame& f, Color frame, Color sill, Random& random) {
  canvas.rectangle(f.left - 0.12f, f.top - 0.12f, f.right + 0.12f, f.bottom + 0.1f, frame * 0.55f, 0.5f);
  canvas.rectangle(f.left - 0.07f, f.top - 0.07f, f.right + 0.07f, f.bottom + 0.07f, frame);
  pane(canvas, f, random);
  const float middle = (f.left + f.right) * 0.5f;
  canvas.rectangle(middle - 0.035f, f.top, middle + 0.035f, f.bottom, frame);
  const float bar = f.top + (f.bottom - f.top) * 0.38f;
  canvas.rectangle(f.left, bar - 0.03f, f.right, bar + 0.03f, frame);
  canvas.rectangle(f.left - 0.16f, f.bottom + 0.07f, f.right + 0.16f, f.bottom + 0.2f, sill);
  canvas.rectangle(f.left - 0.16f, f.bottom + 0.2f, f.right + 0.16f, f.bottom + 0.32f, Color(0.1f), 0.35f);
}

template <class Draw>
void each_cell(int first_row, const Draw& draw) {
  for (int row = first_row; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      draw(static_cast<float>(column) * cell, static_cast<float>(row) * cell, row, column);
}

} // namespace

Image paint_glass() {
  Canvas canvas(facade_pixels, edge, rgb(0x3c5468));
  each_cell(0, [&](float x, float y, int row, int column) {
    Random random{11, row, column};
    for (int half = 0; half < 2; ++half) {
      const float left = x + static_cast<float>(half) * 1.5f;
      const auto shade = static_cast<float>(random.between(0.86, 1.12));
      canvas.gradient(left, y, left + 1.5f, y + 2.1f, rgb(0x84a3b8) * shade, rgb(0x51708a) * shade);
      canvas.gradient(left, y + 2.1f, left + 1.5f, y + 3.0f, rgb(0x33475a) * shade, rgb(0x2b3d4e) * shade);
      if (random.chance(0.12))
        canvas.rectangle(left, y, left + 1.5f, y + static_cast<float>(random.between(0.5, 1.6)),
                         rgb(0xc5cfd4), 0.55f);
    }
  });
  for (int i = 0; i <= 2 * cells; ++i) {
    const float x = static_cast<float>(i) * 1.5f;
    canvas.rectangle(x - 0.05f, 0, x + 0.05f, edge, rgb(0xb4bdc2));
  }
  for (int i = 0; i <= cells; ++i) {
    const float y = static_cast<float>(i) * cell;
    canvas.rectangle(0, y - 0.07f, edge, y + 0.07f, rgb(0xaeb8bd));
    canvas.rectangle(0, y + 2.06f, edge, y + 2.12f, rgb(0x8b979e));
  }
  return canvas.image("glass");
}

Image paint_office() {
  Canvas canvas(facade_pixels, edge, rgb(0xb5b0a5));
  canvas.grain(16, 4, 0.10f, 21);
  each_cell(0, [&](float x, float y, int row, int column) {
    Random random{12, row, column};
    canvas.rectangle(x + 0.1f, y + 0.62f, x + 2.9f, y + 2.22f, rgb(0x56544f));
    for (int half = 0; half < 2; ++half) {
      const float left = x + 0.18f + static_cast<float>(half) * 1.34f;
      pane(canvas, {left, y + 0.72f, left + 1.27f, y + 2.15f}, random);
    }
    canvas.rectangle(x + 0.1f, y + 2.22f, x + 2.9f, y + 2.34f, rgb(0xcfcabf));
    canvas.rectangle(x, y + 2.93f, x + 3.0f, y + 3.0f, rgb(0x7d796f), 0.8f);
    canvas.rectangle(x - 0.03f, y, x + 0.03f, y + 3.0f, rgb(0x857f75), 0.8f);
  });
  return canvas.image("office");
}

Image paint_stone() {
  Canvas canvas(facade_pixels, edge, rgb(0xc8b795));
  canvas.grain(12, 5, 0.16f, 31);
  for (int row = 0; row < 40; ++row) { // courses of 0.6 m
    const float y = static_cast<float>(row) * 0.6f;
    for (int i = 0; i < 20; ++i) {
      const float x = static_cast<float>(i) * 1.2f + (row % 2 == 0 ? 0.0f : 0.6f);
      Random random{13, row, i};
      canvas.rectangle(x, y, x + 1.2f, y + 0.6f, random.chance(0.5) ? rgb(0xd8c9a8) : rgb(0xa89672), 0.18f);
      canvas.rectangle(x - 0.015f, y, x + 0.015f, y + 0.6f, rgb(0x6f6248), 0.7f);
    }
    canvas.rectangle(0, y - 0.015f, edge, y + 0.02f, rgb(0x6f6248), 0.7f);
  }
  each_cell(0, [&](float x, float y, int row, int column) {
    Random random{14, row, column};
    canvas.rectangle(x + 0.68f, y + 0.3f, x + 2.32f, y + 2.6f, rgb(0xdccfb2));
    canvas.rectangle(x + 0.6f, y + 0.2f, x + 2.4f, y + 0.42f, rgb(0xe4d9c0));
    sash_window(canvas, {x + 0.9f, y + 0.6f, x + 2.1f, y + 2.4f}, rgb(0x4a4640), rgb(0xe2d7bd), random);
    canvas.rectangle(x, y + 2.86f, x + 3.0f, y + 3.0f, rgb(0xe0d4b8), row % 2 == 1 ? 1.0f : 0.0f);
  });
  return canvas.image("stone");
}

Image paint_brick() {
  Canvas canvas(facade_pixels, edge, rgb(0x9c8a7c));
  for (int row = 0; row < 160; ++row) { // bricks of 0.3 m by 0.15 m
    const float y = static_cast<float>(row) * 0.15f;
    for (int i = -1; i < 80; ++i) {
      Random random{15, row, (i + 80) % 80};
      const float x = static_cast<float>(i) * 0.3f + (row % 2 == 0 ? 0.0f : 0.15f);
      const auto shade = static_cast<float>(random.between(0.82, 1.12));
      canvas.rectangle(x + 0.012f, y + 0.012f, x + 0.288f, y + 0.138f,
                       (random.chance(0.3) ? rgb(0x87432f) : rgb(0x9a5038)) * shade);
    }
  }
  canvas.grain(8, 4, 0.16f, 41);
  each_cell(2, [&](float x, float y, int row, int column) {
    Random random{16, row, column};
    canvas.rectangle(x + 0.78f, y + 0.32f, x + 2.22f, y + 0.56f, rgb(0xc9b9a0));
    sash_window(canvas, {x + 0.9f, y + 0.62f, x + 2.1f, y + 2.3f}, rgb(0xe6e1d6), rgb(0xc9b9a0), random);
  });
  return canvas.image("brick");
}

Image paint_plaster() {
  Canvas canvas(facade_pixels, edge, rgb(0xdcc9a0));
  canvas.grain(6, 5, 0.10f, 51);
  canvas.grain(64, 2, 0.05f, 52);
  each_cell(2, [&](float x, float y, int row, int column) {
    Random random{17, row, column};
    canvas.rectangle(x, y + 2.84f, x + 3.0f, y + 2.96f, rgb(0xefe6d2), 0.9f);
    canvas.rectangle(x + 0.72f, y + 0.42f, x + 2.28f, y + 2.5f, rgb(0xf0e9da));
    sash_window(canvas, {x + 0.95f, y + 0.62f, x + 2.05f, y + 2.3f}, rgb(0xf4f1ea), rgb(0xe5dcc8), random);
    if ((row + column) % 3 == 0 || random.chance(0.3)) { // shutters
      for (const float left : {x + 0.32f, x + 2.2f}) {
        canvas.rectangle(left, y + 0.6f, left + 0.48f, y + 2.35f, rgb(0x4d6b58));
        for (int slat = 0; slat < 8; ++slat) {
          const float top = y + 0.72f + static_cast<float>(slat) * 0.2f;
          canvas.rectangle(left + 0.06f, top, left + 0.42f, top + 0.06f, rgb(0x34493d));
        }
      }
    }
  });
  return canvas.image("plaster");
}

Image paint_shop() { // six rows of 4 m
  Canvas canvas(facade_pixels, edge, rgb(0x5d5852));
  static constexpr std::uint32_t signs[] = {0x8c2f2b, 0x25506b, 0x2f5d3a, 0xb58a2e,
                                            0x4b3a5e, 0x2b2b2e, 0xa85a2c, 0x3e6f73};
  for (int row = 0; row < 6; ++row) {
    const float y = static_cast<float>(row) * 4.0f;
    canvas.rectangle(0, y, edge, y + 4.0f, row % 2 == 0 ? rgb(0x8c8479) : rgb(0x6a655f));
    canvas.rectangle(0, y, edge, y + 0.22f, rgb(0xbab3a6));
    for (int column = 0; column < 4; ++column) {
      Random random{18, row, column};
      const float x = static_cast<float>(column) * 6.0f;
      const Color sign = rgb(signs[random.below(8)]);
      canvas.rectangle(x + 0.35f, y + 0.45f, x + 5.65f, y + 1.15f, sign);
      float at = x + 0.9f; // the letters of the sign, as blocks
      while (at < x + 4.8f) {
        const auto letter = static_cast<float>(random.between(0.16, 0.34));
        canvas.rectangle(at, y + 0.63f, at + letter, y + 0.97f, rgb(0xf0ead8), 0.9f);
        at += letter + 0.12f + (random.chance(0.15) ? 0.3f : 0.0f);
      }
      canvas.rectangle(x + 0.3f, y + 1.25f, x + 5.7f, y + 3.72f, rgb(0x2c2a28));
      canvas.gradient(x + 0.4f, y + 1.35f, x + 3.9f, y + 3.6f, rgb(0x9fa9a6), rgb(0x5d5a50));
      for (int item = 0; item < 7; ++item) { // what is in the window
        const auto left = x + 0.5f + static_cast<float>(item) * 0.47f;
        const auto height = static_cast<float>(random.between(0.3, 1.1));
        canvas.rectangle(left, y + 3.6f - height, left + 0.36f, y + 3.6f, rgb(signs[random.below(8)]) * 1.2f,
                         0.75f);
      }
      canvas.gradient(x + 4.1f, y + 1.35f, x + 5.6f, y + 3.95f, rgb(0x7f8a8c), rgb(0x3a3c3a)); // door
      canvas.rectangle(x + 4.82f, y + 1.35f, x + 4.88f, y + 3.95f, rgb(0x2c2a28));
      canvas.rectangle(x - 0.15f, y + 0.22f, x + 0.15f, y + 4.0f, rgb(0xa29a8d));
    }
    canvas.rectangle(0, y + 3.85f, edge, y + 4.0f, rgb(0x3d3a36));
  }
  return canvas.image("shop");
}

} // namespace cupola::content::city
