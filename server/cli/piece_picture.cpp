#include "server/cli/piece_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <iterator>

#include "renderer/plan/measure.h"

namespace cupola::cli {

namespace {

constexpr double line_width = 1.0, halo_width = 3.0; // pixels
constexpr double halo_strength = 0.5;                // of white over the picture
constexpr double dash = 4.0;                         // pixels, and between dashes

/// How much of each pixel lines cover. Where borders meet the greater part counts, so that a border which two
/// pieces have in common is as black as any.
class Ink {
public:
  explicit Ink(const plan::PixelRect& rect)
      : rect_(rect)
      , line_(static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height))
      , halo_(line_.size()) {}

  void polygon(const std::vector<glm::dvec2>& corners, bool dashed) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      segment(corners[i] + 0.5, corners[(i + 1) % corners.size()] + 0.5, dashed);
  }

  void blend(outputs::ByteImage& picture) const {
    for (int y = 0; y < rect_.height; ++y)
      for (int x = 0; x < rect_.width; ++x) {
        const std::size_t at = index(x, y);
        const auto pixel =
            4 * (static_cast<std::size_t>(rect_.y + y) * static_cast<std::size_t>(picture.width) +
                 static_cast<std::size_t>(rect_.x + x));
        for (std::size_t c = pixel; c < pixel + 3; ++c) {
          const double light = picture.rgba[c] + (255.0 - picture.rgba[c]) * halo_strength * halo_[at];
          picture.rgba[c] = static_cast<std::uint8_t>(std::lround(light * (1.0 - line_[at])));
        }
      }
  }

private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(rect_.width) + static_cast<std::size_t>(x);
  }

  void segment(glm::dvec2 a, glm::dvec2 b, bool dashed) {
    const double length = glm::length(b - a), reach = halo_width;
    if (length == 0.0) return;
    const glm::dvec2 along = (b - a) / length;
    const int top = std::max(0, static_cast<int>(std::floor(std::min(a.y, b.y) - reach)));
    const int bottom = std::min(rect_.height, static_cast<int>(std::ceil(std::max(a.y, b.y) + reach)));
    const int left = std::max(0, static_cast<int>(std::floor(std::min(a.x, b.x) - reach)));
    const int right = std::min(rect_.width, static_cast<int>(std::ceil(std::max(a.x, b.x) + reach)));
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const glm::dvec2 to = glm::dvec2(x + 0.5, y + 0.5) - a;
        const double place = std::clamp(glm::dot(to, along), 0.0, length);
        if (dashed && std::fmod(place, 2.0 * dash) >= dash) continue;
        const double distance = glm::length(to - along * place);
        raise(line_[index(x, y)], (line_width + 1.0) / 2.0 - distance);
        raise(halo_[index(x, y)], (halo_width + 1.0) / 2.0 - distance);
      }
  }

  static void raise(float& cover, double to) {
    cover = std::max(cover, static_cast<float>(std::clamp(to, 0.0, 1.0)));
  }

  plan::PixelRect rect_;
  std::vector<float> line_, halo_;
};

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (i + k < bytes.size() ? std::uint32_t{bytes[i + k]} : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[group >> (18U - 6U * k) & 63U];
  }
  return text;
}

/// "x,y x,y …"
std::string points(const std::vector<glm::dvec2>& corners) {
  std::string text;
  for (const glm::dvec2& p : corners)
    fmt::format_to(std::back_inserter(text), "{}{:.7g},{:.7g}", text.empty() ? "" : " ", p.x, p.y);
  return text;
}

std::vector<glm::dvec2> looked_up_outline(const std::array<glm::dvec2, 3>& screen,
                                          const plan::PixelRect& rect) {
  const auto p = plan::in_pixels(screen, rect);
  return {p.begin(), p.end()};
}

} // namespace

void draw_borders(outputs::ByteImage& picture, const PiecedViewports& viewports) {
  for (const plan::ViewportPlan* viewport : viewports) {
    const plan::PieceSet& set = *viewport->pieces;
    Ink ink(viewport->rect);
    for (std::size_t i = 0; i < set.pieces.size(); ++i)
      ink.polygon(plan::outline(set, i, viewport->rect), false);
    for (const auto& screen : set.looked_up) ink.polygon(looked_up_outline(screen, viewport->rect), true);
    ink.blend(picture);
  }
}

model::Result<std::string> borders_as_svg(const outputs::ByteImage& picture,
                                          const PiecedViewports& viewports) {
  outputs::ByteView pixels = outputs::view(picture);
  pixels.alpha = false;
  const auto png = outputs::encode_png(pixels);
  if (!png) return tl::unexpected(png.error());
  std::string text = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                                 "viewBox=\"0 0 {0} {1}\">\n"
                                 "<image width=\"{0}\" height=\"{1}\" href=\"data:image/png;base64,{2}\"/>\n",
                                 picture.width, picture.height, base64(*png));
  auto to = std::back_inserter(text);
  for (std::size_t v = 0; v < viewports.size(); ++v) {
    const plan::PieceSet& set = *viewports[v]->pieces;
    const plan::PixelRect& rect = viewports[v]->rect;
    // An inner picture cuts off what hangs over the viewport.
    fmt::format_to(to, "<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">\n<defs><g id=\"pieces{}\">\n",
                   rect.x, rect.y, rect.width, rect.height, v);
    for (std::size_t i = 0; i < set.pieces.size(); ++i)
      fmt::format_to(to, "<polygon points=\"{}\"/>\n", points(plan::outline(set, i, rect)));
    for (const auto& screen : set.looked_up)
      fmt::format_to(to, "<path stroke-dasharray=\"{}\" d=\"M{}Z\"/>\n", dash,
                     points(looked_up_outline(screen, rect)));
    fmt::format_to(to,
                   "</g></defs>\n<g fill=\"none\" stroke-linejoin=\"round\">\n"
                   "<use href=\"#pieces{0}\" stroke=\"#fff\" stroke-width=\"{1}\" stroke-opacity=\"{2}\"/>\n"
                   "<use href=\"#pieces{0}\" stroke=\"#000\" stroke-width=\"{3}\"/>\n</g>\n</svg>\n",
                   v, halo_width, halo_strength, line_width);
  }
  return text + "</svg>\n";
}

} // namespace cupola::cli
