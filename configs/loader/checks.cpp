#include "configs/loader/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <set>
#include <utility>
#include <vector>

#include "configs/loader/document.h"
#include "configs/loader/words.h"

namespace cupola::loader {

using model::Code;
using model::escaped;
using model::Problem;
using model::Severity;
using model::Show;

namespace {

/// A problem, and the values besides its own pointer that it was concluded from.
struct Finding {
  Problem problem;
  std::vector<std::string> from;
};
using Findings = std::vector<Finding>;

std::string short_number(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
  return buffer.data();
}

/// Calls visit(pointer, viewport, output) for every viewport.
template <class Visit>
void each_viewport(const Show& show, const Visit& visit) {
  for (const auto& [output_name, output] : show.outputs)
    for (const auto& [name, viewport] : output.viewports)
      visit("/outputs/" + escaped(output_name) + "/viewports/" + escaped(name), viewport, output);
}

void references(const Show& show, Findings& out) {
  std::vector<std::string> names;
  for (const auto& [name, projection] : show.projections) names.push_back(name);
  each_viewport(show, [&](const std::string& at, const model::Viewport& viewport, const model::Output&) {
    if (show.projections.contains(viewport.projection)) return;
    const std::string near = model::nearest(viewport.projection, names);
    std::string advice =
        names.empty() ? "The show defines no projection." : "There is: " + listed(names) + ".";
    if (!near.empty()) advice = "Did you mean " + in_quotes(near) + "?";
    if (names.size() > 12 && near.empty()) advice = "Define it in \"projections\".";
    out.push_back({{Code::unknown_reference, at + "/projection", "the name of a projection",
                    in_quotes(viewport.projection), advice},
                   {"/projections"}});
  });
}

void unused_projections(const Show& show, Findings& out) {
  std::set<std::string> used;
  each_viewport(show, [&](const std::string&, const model::Viewport& viewport, const model::Output&) {
    used.insert(viewport.projection);
  });
  for (const auto& [name, projection] : show.projections)
    if (!used.contains(name))
      out.push_back({{Code::unused,
                      "/projections/" + escaped(name),
                      "a viewport that shows the projection",
                      "none",
                      "",
                      {},
                      Severity::warning},
                     {"/outputs"}});
}

void rectangles(const Show& show, Findings& out) {
  constexpr double slack = 1e-9; // thirds and the like do not sum to 1 exactly
  const auto leaves = [&](const std::string& at, const char* sum, double value) {
    if (value > 1 + slack)
      out.push_back(
          {{Code::outside_output, at, std::string(sum) + " of at most 1", short_number(value)}, {}});
  };
  const auto vanishes = [&](const std::string& at, const char* side, double pixels) {
    if (pixels < 1)
      out.push_back({{Code::out_of_range, at + '/' + side, "at least one pixel of the output",
                      short_number(pixels) + " pixels"},
                     {at.substr(0, at.rfind("/viewports/")) + '/' + side}});
  };
  each_viewport(show,
                [&](const std::string& at, const model::Viewport& viewport, const model::Output& output) {
                  leaves(at, "x + width", viewport.x + viewport.width);
                  leaves(at, "y + height", viewport.y + viewport.height);
                  vanishes(at, "width", viewport.width * output.width);
                  vanishes(at, "height", viewport.height * output.height);
                });
}

struct Rectangle {
  double left, top, width, height;
};
bool overlap(const Rectangle& a, const Rectangle& b) {
  constexpr double slack = 1e-9;
  return std::min(a.left + a.width, b.left + b.width) - std::max(a.left, b.left) > slack &&
         std::min(a.top + a.height, b.top + b.height) - std::max(a.top, b.top) > slack;
}

/// Overlapping viewports of one order are drawn in the order of their names, which nobody will have meant.
void drawing_orders(const Show& show, Findings& out) {
  const auto rectangle = [](const model::Viewport& one) {
    return Rectangle{one.x, one.y, one.width, one.height};
  };
  for (const auto& [output_name, output] : show.outputs) {
    const std::string all = "/outputs/" + escaped(output_name) + "/viewports/";
    for (auto later = output.viewports.begin(); later != output.viewports.end(); ++later)
      for (auto earlier = output.viewports.begin(); earlier != later; ++earlier) {
        const bool tie = earlier->second.order == later->second.order;
        if (!tie || !overlap(rectangle(earlier->second), rectangle(later->second))) continue;
        out.push_back({{Code::order_tie,
                        all + escaped(later->first),
                        "an order of its own, as it overlaps " + in_quotes(earlier->first),
                        "the same order",
                        "Give the one in front the greater \"order\".",
                        {},
                        Severity::warning},
                       {all + escaped(earlier->first)}});
        break; // one is enough to say so
      }
  }
}

/// Windows that hide each other on one monitor.
void windows(const Show& show, Findings& out) {
  struct Placed {
    std::string name, monitor;
    bool fullscreen;
    Rectangle at;
  };
  std::vector<Placed> placed;
  for (const auto& [name, output] : show.outputs) {
    const auto* window = std::get_if<model::WindowOutput>(&output.sink);
    if (!window) continue;
    const std::string monitor =
        window->monitor.empty() ? "0" : window->monitor; // the first is the primary one
    const Placed here{name,
                      monitor,
                      window->fullscreen,
                      {double(window->x), double(window->y), double(output.width), double(output.height)}};
    const auto hidden = [&](const Placed& other) {
      return other.monitor == monitor && (other.fullscreen || here.fullscreen || overlap(other.at, here.at));
    };
    const auto other = std::find_if(placed.begin(), placed.end(), hidden);
    if (other != placed.end())
      out.push_back({{Code::windows_overlap,
                      "/outputs/" + escaped(name),
                      "a place beside window " + in_quotes(other->name),
                      "one that overlaps it",
                      "Change \"x\" and \"y\", or the monitor.",
                      {},
                      Severity::warning},
                     {"/outputs/" + escaped(other->name)}});
    placed.push_back(here);
  }
}

/// One look: of the camera or of a key frame. `up_at`: where the 'up' that it uses stands.
void look(const std::string& at, const std::optional<glm::dvec3>& look_to,
          const model::Orientation& orientation, const glm::dvec3& up, Findings& out) {
  if (!look_to) return;
  if (orientation != model::Orientation{})
    out.push_back({{Code::conflict, at + "/look_to", "either look_to or an orientation", "both",
                    "Remove one of them; an orientation of zeros counts as none."},
                   {at + "/orientation"}});
  const double length = glm::length(*look_to);
  if (length == 0) {
    out.push_back({{Code::zero_vector, at + "/look_to", "a direction", "the zero vector"}, {}});
    return;
  }
  const double up_length = glm::length(up);
  if (up_length > 0 && glm::length(glm::cross(*look_to / length, up / up_length)) < 1e-6)
    out.push_back({{Code::zero_vector, at + "/look_to", "a direction that is not parallel to the camera's up",
                    "a parallel one", "Turn \"up\", or look elsewhere."},
                   {"/camera/up"}});
}

void camera(const Show& show, Findings& out) {
  const model::Camera& camera = show.camera;
  if (glm::length(camera.up) == 0)
    out.push_back({{Code::zero_vector, "/camera/up", "a direction", "the zero vector"}, {}});
  look("/camera", camera.look_to, camera.orientation, camera.up, out);
  for (std::size_t i = 0; i < camera.path.size(); ++i) {
    const std::string at = "/camera/path/" + std::to_string(i);
    const model::Keyframe& frame = camera.path[i];
    look(at, frame.look_to, frame.orientation, camera.up, out);
    if (i == 0 || frame.time > camera.path[i - 1].time) continue;
    out.push_back({{Code::not_increasing, at + "/time",
                    "a time after that of the key frame before (" + plain(camera.path[i - 1].time) + " s)",
                    plain(frame.time) + " s"},
                   {"/camera/path/" + std::to_string(i - 1) + "/time"}});
  }
}

void off_axis(const Show& show, Findings& out) {
  for (const auto& [name, projection] : show.projections)
    if (const double length = glm::length(projection.off_axis); length >= 1)
      out.push_back(
          {{Code::out_of_range, "/projections/" + escaped(name) + "/off_axis", "a vector shorter than 1",
            "one of length " + short_number(length), "The eye must stay inside the shape."},
           {}});
}

/// The offsets of a camera texture fit its grid, or there are none.
void grids(const Show& show, Findings& out) {
  for (const auto& [name, projection] : show.projections) {
    const auto* texture = std::get_if<model::CameraTexture>(&projection.shape);
    if (!texture || texture->offsets.empty()) continue;
    const std::string at = "/projections/" + escaped(name);
    const auto check = [&](const std::string& place, std::size_t found, int cells, const char* what,
                           const char* key) {
      if (found == static_cast<std::size_t>(cells) + 1) return true;
      out.push_back({{Code::grid_size, place,
                      std::to_string(cells + 1) + ' ' + what + ", one more than \"" + key + "\"",
                      std::to_string(found)},
                     {at + '/' + key}});
      return false;
    };
    if (!check(at + "/offsets", texture->offsets.size(), texture->rows, "rows", "rows")) continue;
    for (std::size_t row = 0; row < texture->offsets.size(); ++row)
      if (!check(at + "/offsets/" + std::to_string(row), texture->offsets[row].size(), texture->columns,
                 "pairs", "columns"))
        break;
  }
}

void listeners(const Show& show, Findings& out) {
  const auto& [http, osc] = show.control;
  const auto meaning = [](const std::string& address) -> std::string {
    if (address == "localhost") return "127.0.0.1";
    return address == "::" ? "0.0.0.0" : address;
  };
  const std::string a = meaning(http.address), b = meaning(osc.address);
  const bool overlap = a == b || a == "0.0.0.0" || b == "0.0.0.0";
  if (http.enabled && osc.enabled && http.port != 0 && http.port == osc.port && overlap)
    out.push_back({{Code::same_address, "/control/osc/port", "a port that no other listener has",
                    std::to_string(osc.port) + ", which is also that of /control/http"},
                   {"/control/http"}});
}

/// Width over height of a picture with square pixels in its middle; 0 when the projection takes any.
double own_aspect(const model::Shape& shape) {
  if (const auto* flat = std::get_if<model::Perspective>(&shape); flat && flat->vertical_fov)
    return std::tan(flat->horizontal_fov.radians() / 2) / std::tan(flat->vertical_fov->radians() / 2);
  if (const auto* bent = std::get_if<model::CameraTexture>(&shape); bent && bent->vertical_fov)
    return std::tan(bent->horizontal_fov.radians() / 2) / std::tan(bent->vertical_fov->radians() / 2);
  if (const auto* map = std::get_if<model::Equirectangular>(&shape))
    return map->horizontal_fov.degrees / map->vertical_fov.degrees;
  if (const auto* map = std::get_if<model::Mercator>(&shape))
    return map->horizontal_fov.radians() / 2 / std::asinh(std::tan(map->vertical_fov.radians() / 2));
  if (std::holds_alternative<model::CubeCross>(shape)) return 4.0 / 3;
  return 0;
}

void aspects(const Show& show, Findings& out) {
  each_viewport(
      show, [&](const std::string& at, const model::Viewport& viewport, const model::Output& output) {
        const auto named = show.projections.find(viewport.projection);
        if (named == show.projections.end()) return;
        const double wanted = own_aspect(named->second.shape);
        const double given = viewport.width * output.width / (viewport.height * output.height);
        if (wanted <= 0 || std::abs(given / wanted - 1) <= 0.02) return;
        const std::string projection = "/projections/" + escaped(viewport.projection);
        const std::string output_at = at.substr(0, at.rfind("/viewports/"));
        out.push_back({{Code::picture_aspect,
                        at,
                        "a rectangle " + short_number(wanted) + " times as wide as high, as projection " +
                            in_quotes(viewport.projection) + " asks for",
                        "one " + short_number(given) + " times as wide as high",
                        "Change the rectangle or a field of view, or the picture is stretched.",
                        {},
                        Severity::warning},
                       {projection, output_at + "/width", output_at + "/height"}});
      });
}

} // namespace

void cross_check(const Show& show, Report& report) {
  constexpr std::array checks{references, rectangles, drawing_orders,     windows, camera, off_axis,
                              grids,      listeners,  unused_projections, aspects};
  Findings findings;
  for (const auto& check : checks) check(show, findings);
  // Decided before anything is added: two findings about one value are both told.
  std::erase_if(findings, [&](const Finding& finding) {
    if (report.refused(finding.problem.pointer)) return true;
    for (const std::string& from : finding.from)
      if (report.refused(from)) return true;
    return false;
  });
  for (Finding& finding : findings) report.add(std::move(finding.problem));
}

} // namespace cupola::loader
