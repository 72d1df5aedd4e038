// Charts for documents, as SVG.
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace cupola::cli {

struct Curve {
  std::string name;
  std::string colour; ///< as CSS has it
  bool dashed = false;
  std::vector<glm::dvec2> points; ///< positive, by rising x
};

struct Panel {
  std::string across; ///< what x counts
  std::vector<Curve> curves;
};

/// Panels side by side, two in a row, both axes logarithmic; `up`: what y counts. A grey line in each rises
/// as fast as x does. The legend names the curves of the first panel.
[[nodiscard]] std::string log_log_chart(const std::vector<Panel>& panels, const std::string& up);

} // namespace cupola::cli
