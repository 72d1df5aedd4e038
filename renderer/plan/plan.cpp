#include "renderer/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

namespace cupola::plan {

namespace {

using model::Code;
using model::Severity;

constexpr int max_edge = 16384; ///< pixels that any picture may have along an edge
constexpr int coarsest_mip =
    16; ///< minification up to which mipmapped cubemaps are right beyond a crop's edge
constexpr std::size_t max_strips = 4096; ///< of a viewport
constexpr double noted_share = 0.01;     ///< of a viewport's pixels, above which looking up is reported

/// Pixel borders of a fraction. Ties go up even when the sum of two fractions misses by a rounding, so that
/// viewports that meet in the file meet in pixels.
int pixel_border(double fraction, int pixels) {
  return std::clamp(static_cast<int>(std::floor(fraction * pixels + 0.5 + 1e-6)), 0, pixels);
}

PixelRect pixel_rect(const model::Viewport& viewport, const model::Output& output) {
  const int left = pixel_border(viewport.x, output.width), top = pixel_border(viewport.y, output.height);
  return {left, top, pixel_border(viewport.x + viewport.width, output.width) - left,
          pixel_border(viewport.y + viewport.height, output.height) - top};
}

PixelRect enlarged(const PixelRect& rect, int factor) {
  return {rect.x * factor, rect.y * factor, rect.width * factor, rect.height * factor};
}

bool too_many(const PieceSet& set) {
  return set.unfinished || (set.strips && set.pieces.size() > max_strips);
}

/// Share of a viewport's pixels that looked-up triangles cover, about.
double looked_up_share(const PieceSet& set) {
  double doubled = 0.0;
  for (const auto& [a, b, c] : set.looked_up)
    doubled += std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  return std::min(1.0, 0.5 * doubled / 4.0); // the viewport is 2 × 2
}

class Planner {
public:
  explicit Planner(const model::Show& show)
      : show_(show) {}

  model::Result<Planned> run() {
    check_projections();
    for (const auto& [name, output] : show_.outputs) add_output(name, output);
    if (model::has_errors(problems_)) return tl::unexpected(std::move(problems_));
    add_cubemap();
    return Planned{std::move(plan_), std::move(problems_)};
  }

private:
  void report(Code code, std::string pointer, std::string expected, std::string found, std::string advice,
              Severity severity = Severity::error) {
    problems_.push_back(
        {code, std::move(pointer), std::move(expected), std::move(found), std::move(advice), {}, severity});
  }

  void check_projections() {
    for (const auto& [name, projection] : show_.projections) {
      if (!check_field(name, projection)) continue;
      if (projection::inside(projection::make_map(projection, 1.0))) continue;
      const glm::dvec3& o = projection.off_axis;
      const bool cylinder = std::holds_alternative<model::Cylinder>(projection.shape);
      report(Code::degenerate_projection, "/projections/" + name + "/off_axis",
             cylinder ? "a vector whose x and z are together shorter than 1, so that the eye stays inside "
                        "the cylinder"
                      : "a vector shorter than 1, so that the eye stays inside the shape",
             fmt::format("length {:.4g}", cylinder ? std::hypot(o.x, o.z) : std::hypot(o.x, o.y, o.z)),
             "Shorten the vector.");
    }
  }

  /// Fields of view whose greatest value depends on another parameter.
  bool check_field(const std::string& name, const model::Projection& projection) {
    const auto* wide = std::get_if<model::Panini>(&projection.shape);
    if (!wide) return true;
    const double most = projection::panini_limit(wide->distance) * 360.0 / std::numbers::pi - 1.0;
    if (wide->horizontal_fov.degrees <= most) return true;
    report(Code::degenerate_projection, "/projections/" + name + "/horizontal_fov",
           fmt::format("at most {:.4g} degrees with a distance of {:.4g}", most, wide->distance),
           fmt::format("{:.4g}", wide->horizontal_fov.degrees),
           "Narrow the field of view, or bring the distance nearer to 1.");
    return false;
  }

  /// Folds are allowed; they are told once for each projection.
  void check_folds(const std::string& name, const projection::Map& map) {
    const auto fold = first_fold(map);
    if (!fold || !folded_.insert(name).second) return;
    report(Code::grid_folds, "/projections/" + name, "a grid whose triangles keep their sides",
           fmt::format("{} {}, the first in the cell of column {} and row {}", fold->triangles,
                       fold->narrow ? "folded or flat" : "folded over", fold->column, fold->row),
           "Weaken the deformation, or enlarge its radius, unless it is meant.", Severity::warning);
  }

  void add_output(const std::string& name, const model::Output& output) {
    OutputPlan made{name, output.width, output.height, {}};
    std::vector<std::pair<int, std::string>> sequence;
    for (const auto& [viewport_name, viewport] : output.viewports)
      sequence.emplace_back(viewport.order, viewport_name);
    std::sort(sequence.begin(), sequence.end()); // equal orders: by name
    for (const auto& [order, viewport_name] : sequence) {
      const std::string pointer = fmt::format("/outputs/{}/viewports/{}", name, viewport_name);
      if (auto viewport = make_viewport(pointer, output, viewport_name))
        made.viewports.push_back(std::move(*viewport));
    }
    plan_.outputs.push_back(std::move(made));
  }

  std::optional<ViewportPlan> make_viewport(const std::string& pointer, const model::Output& output,
                                            const std::string& name) {
    const model::Viewport& viewport = output.viewports.at(name);
    const auto named = show_.projections.find(viewport.projection);
    if (named == show_.projections.end()) {
      report(Code::unknown_reference, pointer + "/projection", "the name of a projection",
             viewport.projection, "Define it under /projections.");
      return std::nullopt;
    }
    ViewportPlan made;
    made.name = name;
    made.rect = pixel_rect(viewport, output);
    made.method = viewport.method;
    if (!check_size(pointer, made.rect)) return std::nullopt;
    made.map = projection::make_map(named->second, double(made.rect.width) / made.rect.height);
    if (!projection::inside(made.map)) return std::nullopt; // reported with the projection
    check_folds(viewport.projection, made.map);
    if (made.method == model::Method::piecewise || made.method == model::Method::automatic)
      add_pieces(pointer, made);
    return made;
  }

  /// Known beforehand: what /quality/automatic chooses, the renderer sees to.
  [[nodiscard]] int supersampling() const {
    return show_.quality.automatic ? 1 : show_.quality.supersampling;
  }

  bool check_size(const std::string& pointer, const PixelRect& rect) {
    const int factor = supersampling();
    bool good = true;
    for (const auto& [key, pixels] : {std::pair{"width", rect.width}, {"height", rect.height}}) {
      if (pixels < 1) {
        report(Code::empty_viewport, fmt::format("{}/{}", pointer, key), "at least one pixel", "none",
               "Enlarge the viewport or its output.");
        good = false;
      } else if (pixels > max_edge / factor) {
        report(Code::over_budget, fmt::format("{}/{}", pointer, key),
               fmt::format("at most {} pixels with /quality/supersampling", max_edge),
               fmt::format("{} times {}", pixels, factor), "Lower /quality/supersampling.");
        good = false;
      }
    }
    return good;
  }

  void add_pieces(const std::string& pointer, ViewportPlan& viewport) {
    const double wanted = show_.pieces.max_error;
    viewport.pieces = make_pieces(viewport.map, viewport.rect, wanted);
    if (viewport.method == model::Method::automatic) {
      // The cubemap is there for what pieces cannot do.
      if (viewport.pieces && (too_many(*viewport.pieces) || viewport.pieces->pieces.empty()))
        viewport.pieces.reset();
      return;
    }
    if (!viewport.pieces) {
      report(Code::degenerate_projection, pointer + "/method", "at least one pixel that shows anything",
             "none", "Enlarge the viewport, or raise the projection's zoom.");
      return;
    }
    const PieceSet& set = *viewport.pieces;
    if (too_many(set)) {
      report(Code::over_budget, pointer + "/method",
             fmt::format("at most {} pieces", set.strips ? max_strips : max_cells),
             set.unfinished ? "more" : fmt::format("{}", set.pieces.size()), "Raise /pieces/max_error.");
      return;
    }
    if (set.max_error > wanted)
      report(Code::over_budget, pointer + "/method", fmt::format("an error of at most {} pixels", wanted),
             fmt::format("{:.3g} with {}", set.max_error,
                         set.strips ? "strips of one pixel" : "the smallest pieces"),
             "Widen the viewport, or raise /pieces/max_error.", Severity::warning);
    if (const double share = looked_up_share(set); share > noted_share)
      report(Code::looked_up, pointer + "/method",
             "a projection that perspectives follow everywhere, for all of it to be drawn piecewise",
             fmt::format("{:.3g} % of the pixels looked up in a cubemap", 100.0 * share),
             "Show less of the surroundings of a pole or rim, or use the method 'cubemap'.",
             Severity::warning);
    if (set.pieces.empty()) {
      viewport.method = model::Method::cubemap;
      viewport.pieces.reset();
    }
  }

  template <class F>
  void each_cubemap_viewport(F f) const {
    for (const OutputPlan& output : plan_.outputs)
      for (const ViewportPlan& viewport : output.viewports)
        if (may_use_cubemap(viewport)) f(viewport);
  }

  /// One cubemap for all: the finest size, and all that any of them sees.
  void add_cubemap() {
    int size = 0;
    each_cubemap_viewport([&](const ViewportPlan& viewport) {
      size = std::max(size, matched_cubemap_size(viewport.map, enlarged(viewport.rect, supersampling())));
    });
    if (size == 0) return;
    if (show_.quality.cubemap_size) {
      size = *show_.quality.cubemap_size;
    } else if (size > max_cubemap_size) {
      report(Code::over_budget, "/quality/cubemap_size",
             fmt::format("at most {} pixels for 'auto'", max_cubemap_size), fmt::format("{}", size),
             "The cubemap is coarser than the densest projection. Give a size to have it otherwise.",
             Severity::warning);
    }
    if (!show_.quality.cubemap_size) size = std::clamp(size, min_cubemap_size, max_cubemap_size);
    CubemapPlan all{size, {}};
    each_cubemap_viewport([&](const ViewportPlan& viewport) {
      const CubemapPlan one = cropped(viewport, size);
      for (std::size_t i = 0; i < all.faces.size(); ++i) all.faces[i] = united(all.faces[i], one.faces[i]);
    });
    plan_.cubemap = all;
  }

  /// Mipmaps read far beyond what a pixel sees: the crops are then those of texels as large as the coarsest
  /// level that is still to be right.
  [[nodiscard]] CubemapPlan cropped(const ViewportPlan& viewport, int size) const {
    const auto of_size = [&](int n) {
      return viewport.method == model::Method::piecewise && viewport.pieces
                 ? make_cubemap(viewport.map, viewport.rect, n, viewport.pieces->looked_up)
                 : make_cubemap(viewport.map, viewport.rect, n);
    };
    if (!show_.quality.cubemap_mipmaps) return of_size(size);
    const int coarse = std::max(1, size / coarsest_mip);
    CubemapPlan plan = of_size(coarse);
    plan.size = size;
    for (CubeFace& face : plan.faces) {
      const PixelRect& c = face.crop;
      const int x = c.x * size / coarse, y = c.y * size / coarse;
      const int right = ((c.x + c.width) * size + coarse - 1) / coarse;
      const int bottom = ((c.y + c.height) * size + coarse - 1) / coarse;
      face.crop = {x, y, right - x, bottom - y};
    }
    return plan;
  }

  static CubeFace united(const CubeFace& a, const CubeFace& b) {
    if (!a.seen || !b.seen) return a.seen ? a : b;
    const int x = std::min(a.crop.x, b.crop.x), y = std::min(a.crop.y, b.crop.y);
    return {true,
            {x, y, std::max(a.crop.x + a.crop.width, b.crop.x + b.crop.width) - x,
             std::max(a.crop.y + a.crop.height, b.crop.y + b.crop.height) - y}};
  }

  const model::Show& show_;
  Plan plan_;
  model::Problems problems_;
  std::set<std::string> folded_; ///< projections whose folds have been told
};

} // namespace

std::optional<PieceSet> make_pieces(const projection::Map& map, const PixelRect& rect, double max_error) {
  if (std::holds_alternative<projection::CameraTextureMap>(map.shape))
    return make_camera_texture_pieces(map, rect);
  if (auto strips = make_strips(map, rect, max_error)) return strips;
  return make_cells(map, rect, max_error);
}

model::Result<Planned> make_plan(const model::Show& show) { return Planner(show).run(); }

} // namespace cupola::plan
