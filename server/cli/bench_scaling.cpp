// How the time of a frame grows with triangles, pieces, pixels and outputs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/bench.h"
#include "server/cli/bench_show.h"
#include "server/cli/offline.h"
#include "server/cli/plot.h"

namespace cupola::cli {

namespace {

using model::Method;

constexpr int poses = 3;

struct View {
  const char* name;
  model::Shape shape;
  int width, height; ///< of an output where its size is not what grows
};

const std::array views{View{"fisheye", model::Fisheye{{180.0}}, 1024, 1024},
                       View{"cylinder", model::Cylinder{{360.0}, {115.0}}, 1448, 724}};

/// What grows, and how a show is made so.
struct Series {
  const char* name;
  std::vector<double> values;
  std::function<void(model::Show&, double)> apply;
};

void set_outputs(model::Show& show, double count) {
  const model::Output one = show.outputs["main"];
  const model::Projection straight = show.projections["view"];
  for (int i = 1; i < static_cast<int>(count); ++i) {
    const std::string number = std::to_string(i);
    model::Projection turned = straight;
    turned.orientation.yaw.degrees = 360.0 * i / count;
    show.projections["view" + number] = turned;
    model::Output output = one;
    output.viewports["all"].projection = "view" + number;
    show.outputs["output" + number] = output;
  }
}

std::vector<Series> all_series() {
  return {{"triangles",
           {8'750, 35'000, 140'000, 560'000, 2'240'000},
           [](model::Show& show, double value) {
             show.scene.content = model::City{1, static_cast<int>(value)};
           }},
          {"pieces",
           {4.0, 1.0, 0.25, 0.0625, 0.015625},
           [](model::Show& show, double value) { show.pieces.max_error = value; }},
          {"pixels",
           {0.25, 0.5, 1.0, 2.0, 4.0},
           [](model::Show& show, double value) {
             model::Output& output = show.outputs["main"];
             output.width = static_cast<int>(output.width * value);
             output.height = static_cast<int>(output.height * value);
           }},
          {"outputs", {1, 2, 4, 8}, set_outputs}};
}

double pixels_of(const model::Show& show) {
  double pixels = 0.0;
  for (const auto& [name, output] : show.outputs) pixels += double{1} * output.width * output.height;
  return pixels;
}

double pieces_of(const plan::Plan& plan) {
  double pieces = 0.0;
  for (const auto& output : plan.outputs)
    for (const auto& viewport : output.viewports)
      if (viewport.pieces) pieces += static_cast<double>(viewport.pieces->pieces.size());
  return pieces;
}

/// k of the line log y = a + k log x nearest to the points.
double fitted_exponent(const std::vector<glm::dvec2>& points) {
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& p : points) mean += glm::log(p) / static_cast<double>(points.size());
  double products = 0.0, squares = 0.0;
  for (const glm::dvec2& p : points) {
    const glm::dvec2 d = glm::log(p) - mean;
    products += d.x * d.y;
    squares += d.x * d.x;
  }
  return squares > 0.0 ? products / squares : 0.0;
}

/// Between the last two points, where a constant part of the time counts least.
double last_exponent(const std::vector<glm::dvec2>& points) {
  return fitted_exponent({points.end() - 2, points.end()});
}

class ScalingBench {
public:
  ScalingBench(frame::Renderer& renderer, const ScalingOptions& options, BenchReport& report)
      : renderer_(renderer)
      , options_(options)
      , report_(report) {}

  /// False when something could not be drawn; the problems have been printed.
  bool run() {
    for (const Series& series : all_series()) {
      panels_.push_back({series.name, {}});
      for (const View& view : views)
        for (const Method method : {Method::piecewise, Method::cubemap}) {
          const bool constant = method == Method::cubemap && std::string(series.name) == "pieces";
          if (!constant && !grow(series, view, method)) return false;
        }
    }
    return options_.plot.empty() || write_plot();
  }

private:
  bool grow(const Series& series, const View& view, Method method) {
    const bool piecewise = method == Method::piecewise;
    std::vector<double> values = series.values;
    if (options_.quick) values.resize(2);
    Curve curve{std::string(view.name) + (piecewise ? ", pieces" : ", cubemap"),
                piecewise ? "#1f6fd6" : "#d9731a",
                view.name == std::string("cylinder"),
                {}};
    std::shared_ptr<const content::Scene> scene;
    for (const double value : values) {
      model::Show show = city_show(view.shape, view.width, view.height, poses);
      viewport_of(show).method = method;
      series.apply(show, value);
      if (std::string(series.name) == "triangles") scene = nullptr;
      std::fprintf(stderr, "%s: %s %g\n", curve.name.c_str(), series.name, value);
      const auto timed = time_show(renderer_, show, scene, {double{poses}, poses, options_.quick ? 1 : 5, 0});
      if (!timed) return false;
      const double triangles = static_cast<double>(scene->geometry.indices.size() / 3);
      const double pieces = pieces_of(*timed->stage->plan), pixels = pixels_of(show);
      const auto outputs = static_cast<double>(show.outputs.size());
      const std::map<std::string, double> counts{
          {"triangles", triangles}, {"pieces", pieces}, {"pixels", pixels}, {"outputs", outputs}};
      curve.points.emplace_back(counts.at(series.name), timed->timing.milliseconds);
      report_.rows.push_back({{"grows", series.name},
                              {"view", view.name},
                              {"method", piecewise ? "pieces" : "cubemap"},
                              {"triangles", std::llround(triangles)},
                              {"pieces", piecewise ? nlohmann::ordered_json(std::llround(pieces)) : nullptr},
                              {"pixels", std::llround(pixels)},
                              {"outputs", std::llround(outputs)},
                              {"sent", std::llround(timed->timing.triangles)},
                              {"ms", rounded(timed->timing.milliseconds, 0.01)}});
    }
    const std::string key = std::string(series.name) + '_' + view.name + (piecewise ? "_pieces" : "_cubemap");
    const double fitted = fitted_exponent(curve.points), last = last_exponent(curve.points);
    report_.ratios[key] = rounded(fitted, 0.001);
    report_.ratios[key + "_last"] = rounded(last, 0.001);
    panels_.back().curves.push_back(std::move(curve));
    return true;
  }

  [[nodiscard]] bool write_plot() const {
    const auto written = write_text(options_.plot, log_log_chart(panels_, "milliseconds a frame"));
    if (!written) print_problems(written.error());
    return written.has_value();
  }

  frame::Renderer& renderer_;
  const ScalingOptions& options_;
  BenchReport& report_;
  std::vector<Panel> panels_;
};

} // namespace

int bench_scaling(const ScalingOptions& options) {
  return run_bench(options.json, {}, [&](frame::Renderer& renderer, BenchReport& report) {
    report.notes = {"Exponents k of time = c · count^k: fitted to all rows of a series, and between its last "
                    "two (_last). 1 is linear.",
                    "City of 35,000 triangles, fisheye 180° of 1024² and cylinder 360° of 1448 × 724, "
                    "max_error 0.25, one output, unless they are what grows; cubemaps of matched density."};
    return ScalingBench(renderer, options, report).run();
  });
}

} // namespace cupola::cli
