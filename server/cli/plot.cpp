#include "server/cli/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <iterator>

namespace cupola::cli {

namespace {

constexpr double panel_width = 440.0, panel_height = 300.0, legend_height = 36.0;
constexpr double left = 64.0, right = 20.0, top = 14.0, bottom = 46.0; ///< round the plot of a panel
constexpr const char* grid_colour = "#e3e3e3";
constexpr const char* text_colour = "#333";

/// Of logarithms to base 10, from a whole or half decade to another.
struct Range {
  double low = 1e9, high = -1e9;

  void include(double value) {
    low = std::min(low, std::log10(value));
    high = std::max(high, std::log10(value));
  }
  void round_outwards() {
    low = std::floor(2.0 * low - 0.1) / 2.0;
    high = std::ceil(2.0 * high + 0.1) / 2.0;
  }
};

std::string number(double value) {
  if (value >= 0.999e6) return fmt::format("{:.3g} M", value / 1e6);
  if (value >= 0.999e3) return fmt::format("{:.3g} k", value / 1e3);
  return fmt::format("{:.3g}", value);
}

/// Powers of ten; twice and five times these too where there are few.
std::vector<double> ticks(const Range& range) {
  std::vector<double> all;
  for (double decade = std::floor(range.low); decade <= range.high; decade += 1.0)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double log = decade + std::log10(step);
      if (step > 1.0 && range.high - range.low > 2.0) continue;
      if (log >= range.low - 1e-9 && log <= range.high + 1e-9) all.push_back(log);
    }
  return all;
}

class PanelDrawing {
public:
  PanelDrawing(const Panel& panel, const std::string& up, glm::dvec2 corner, std::string& svg)
      : panel_(panel)
      , up_(up)
      , corner_(corner)
      , svg_(svg) {
    for (const Curve& curve : panel.curves)
      for (const glm::dvec2& point : curve.points) {
        x_.include(point.x);
        y_.include(point.y);
      }
    x_.round_outwards();
    y_.round_outwards();
  }

  void draw() {
    grid();
    linear();
    for (const Curve& curve : panel_.curves) line(curve);
  }

private:
  template <typename... Values>
  void put(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(svg_), format, std::forward<Values>(values)...);
    svg_ += '\n';
  }
  [[nodiscard]] double across(double log) const {
    return corner_.x + left + (log - x_.low) / (x_.high - x_.low) * (panel_width - left - right);
  }
  [[nodiscard]] double upwards(double log) const {
    return corner_.y + panel_height - bottom -
           (log - y_.low) / (y_.high - y_.low) * (panel_height - top - bottom);
  }

  void grid() {
    for (const double log : ticks(x_)) {
      put(R"(<path d="M{0:.1f} {1:.1f}V{2:.1f}" stroke="{3}"/>)", across(log), upwards(y_.low),
          upwards(y_.high), grid_colour);
      put(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", across(log),
          upwards(y_.low) + 17.0, number(std::pow(10.0, log)));
    }
    for (const double log : ticks(y_)) {
      put(R"(<path d="M{0:.1f} {1:.1f}H{2:.1f}" stroke="{3}"/>)", across(x_.low), upwards(log),
          across(x_.high), grid_colour);
      put(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)", across(x_.low) - 7.0,
          upwards(log) + 4.0, number(std::pow(10.0, log)));
    }
    put(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="none" stroke="#999"/>)",
        across(x_.low), upwards(y_.high), across(x_.high) - across(x_.low),
        upwards(y_.low) - upwards(y_.high));
    const double middle = (across(x_.low) + across(x_.high)) / 2.0;
    put(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle" font-weight="bold">{}</text>)", middle,
        upwards(y_.low) + 37.0, panel_.across);
    const double x = corner_.x + 15.0, y = (upwards(y_.low) + upwards(y_.high)) / 2.0;
    put(R"svg(<text x="{0:.1f}" y="{1:.1f}" text-anchor="middle" transform="rotate(-90 {0:.1f} {1:.1f})">{2}</text>)svg",
        x, y, up_);
  }

  /// As steep as x, through the middle.
  void linear() {
    const double x = (x_.low + x_.high) / 2.0, y = (y_.low + y_.high) / 2.0;
    const double reach = std::min(x_.high - x_.low, y_.high - y_.low) / 2.0;
    put(R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f}" stroke="#bbb" stroke-dasharray="2 4"/>)", across(x - reach),
        upwards(y - reach), across(x + reach), upwards(y + reach));
  }

  void line(const Curve& curve) {
    std::string path;
    for (const glm::dvec2& point : curve.points) {
      const double x = across(std::log10(point.x)), y = upwards(std::log10(point.y));
      fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x, y);
      put(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", x, y, curve.colour);
    }
    put(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2"{}/>)", path, curve.colour,
        curve.dashed ? R"( stroke-dasharray="7 4")" : "");
  }

  const Panel& panel_;
  const std::string& up_;
  glm::dvec2 corner_;
  std::string& svg_;
  Range x_, y_;
};

} // namespace

std::string log_log_chart(const std::vector<Panel>& panels, const std::string& up) {
  const double width = 2.0 * panel_width;
  const double height = legend_height + std::ceil(static_cast<double>(panels.size()) / 2.0) * panel_height;
  std::string svg =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
                  "height=\"{1:g}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"{2}\">\n"
                  "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
                  width, height, text_colour);
  double x = left;
  for (const Curve& curve : panels.front().curves) {
    fmt::format_to(std::back_inserter(svg),
                   "<path d=\"M{:.1f} 20h28\" stroke=\"{}\" stroke-width=\"2\"{}/>\n"
                   "<text x=\"{:.1f}\" y=\"24\">{}</text>\n",
                   x, curve.colour, curve.dashed ? R"( stroke-dasharray="7 4")" : "", x + 34.0, curve.name);
    x += (width - left) / static_cast<double>(panels.front().curves.size() + 1);
  }
  fmt::format_to(std::back_inserter(svg),
                 "<path d=\"M{:.1f} 20h28\" stroke=\"#bbb\" stroke-dasharray=\"2 4\"/>\n"
                 "<text x=\"{:.1f}\" y=\"24\">as x</text>\n",
                 x, x + 34.0);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const glm::dvec2 corner(panel_width * static_cast<double>(i % 2),
                            legend_height + panel_height * static_cast<double>(i / 2));
    PanelDrawing(panels[i], up, corner, svg).draw();
  }
  return svg + "</svg>\n";
}

} // namespace cupola::cli
