// cupola pieces: what pieces a show's viewports are drawn with, in figures and as a picture.
#include <CLI/App.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "configs/loader/loader.h"
#include "renderer/plan/measure.h"
#include "renderer/plan/plan.h"
#include "server/cli/commands.h"
#include "server/cli/offline.h"
#include "server/cli/piece_picture.h"

namespace cupola::cli {

namespace {

constexpr double most_samples = 4e6; // pixels of a viewport up to which all are measured

struct Options {
  std::string show, output, viewport, size, target;
  double max_error = 0.0; ///< 0: as the show says
  bool json = false;
};

/// Puts the options into the show; viewports that are asked for become piecewise.
model::Problems apply(const Options& options, model::Show& show) {
  model::Problems problems;
  if (!options.output.empty()) problems = keep_output(show, options.output);
  if (!problems.empty()) return problems;
  if (!options.size.empty()) problems = resize(show, options.size);
  if (options.max_error > 0.0) show.pieces.max_error = options.max_error;
  bool found = false;
  std::vector<std::string> names;
  for (auto& [output_name, output] : show.outputs)
    for (auto& [name, viewport] : output.viewports) {
      names.push_back(name);
      if (!options.viewport.empty() && name != options.viewport) continue;
      viewport.method = model::Method::piecewise;
      found = true;
    }
  if (!found && !options.viewport.empty())
    problems.push_back(
        unknown_name("/outputs", "a viewport of the outputs asked for", options.viewport, names));
  return problems;
}

bool asked_for(const Options& options, const plan::ViewportPlan& viewport) {
  return options.viewport.empty() || viewport.name == options.viewport;
}

struct Figures {
  std::string output, viewport;
  const char* kind = "none";
  std::size_t pieces = 0;
  plan::Extents size;
  plan::Measured measured;
  int step = 1; ///< of the pixels measured
  double looked_up = 0.0;
  double milliseconds = 0.0; ///< in which one core makes the pieces
};

const char* kind_of(const plan::PieceSet& set) {
  if (!set.triangles.empty()) return "triangles";
  return set.pieces.size() == 1 && set.pieces[0].plane_count == 0 ? "perspective" : "strips";
}

/// The pieces are made once more: the first time also pays for memory that is new to the process.
double time_to_make(const plan::ViewportPlan& viewport, double max_error) {
  const auto start = std::chrono::steady_clock::now();
  static_cast<void>(plan::make_pieces(viewport.map, viewport.rect, max_error));
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Figures figures_of(const plan::OutputPlan& output, const plan::ViewportPlan& viewport, double max_error) {
  Figures figures;
  figures.output = output.name;
  figures.viewport = viewport.name;
  if (!viewport.pieces) {
    figures.looked_up = 1.0; // nothing was left for pieces
    return figures;
  }
  const double pixels = double(viewport.rect.width) * viewport.rect.height;
  figures.step = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / most_samples))));
  figures.kind = kind_of(*viewport.pieces);
  figures.pieces = viewport.pieces->pieces.size();
  figures.milliseconds = time_to_make(viewport, max_error);
  figures.size = plan::extents(*viewport.pieces, viewport.rect);
  figures.measured = plan::measure(*viewport.pieces, viewport.map, viewport.rect, figures.step);
  if (figures.measured.shown > 0)
    figures.looked_up = double(figures.measured.looked_up) / double(figures.measured.shown);
  return figures;
}

nlohmann::ordered_json as_json(const Figures& f) {
  const auto extent = [](const plan::Extent& e) {
    return nlohmann::ordered_json{{"smallest", e.smallest}, {"mean", e.mean}, {"largest", e.largest}};
  };
  return {{"output", f.output},
          {"viewport", f.viewport},
          {"kind", f.kind},
          {"pieces", f.pieces},
          {"width", extent(f.size.width)},
          {"height", extent(f.size.height)},
          {"largest_error", f.measured.largest},
          {"rms_error", f.measured.rms},
          {"pixels_measured", f.measured.drawn},
          {"step", f.step},
          {"looked_up", f.looked_up},
          {"milliseconds", f.milliseconds}};
}

std::string as_text(const Figures& f) {
  std::string text = fmt::format("{}/{}: ", f.output, f.viewport);
  if (f.pieces == 0) return text + "no pieces, all looked up in a cubemap";
  const auto& [width, height] = f.size;
  fmt::format_to(std::back_inserter(text), "{}, {} in number\n", f.kind, f.pieces);
  fmt::format_to(std::back_inserter(text),
                 "  size   {:.4g} × {:.4g} to {:.4g} × {:.4g} pixels, mean {:.4g} × {:.4g}\n", width.smallest,
                 height.smallest, width.largest, height.largest, width.mean, height.mean);
  fmt::format_to(std::back_inserter(text), "  error  {:.3g} pixels at most, {:.3g} RMS, at {} pixels ({})\n",
                 f.measured.largest, f.measured.rms, f.measured.drawn,
                 f.step == 1 ? "all drawn" : fmt::format("one in {} × {}", f.step, f.step));
  fmt::format_to(std::back_inserter(text),
                 "  looked up in a cubemap: {:.3g} % of what is shown\n  made in {:.3g} ms on one core",
                 100.0 * f.looked_up, f.milliseconds);
  return text;
}

void print(const std::vector<Figures>& all, bool json) {
  auto list = nlohmann::ordered_json::array();
  for (const Figures& figures : all) {
    if (json)
      list.push_back(as_json(figures));
    else
      std::printf("%s\n", as_text(figures).c_str());
  }
  if (json) std::printf("%s\n", nlohmann::ordered_json{{"viewports", std::move(list)}}.dump(2).c_str());
}

/// The first picture of the one output, with the borders over it.
model::Result<void> write_picture(const Options& options, const std::shared_ptr<const frame::Stage>& stage) {
  auto offline = make_offline_renderer();
  if (!offline) return tl::unexpected(offline.error());
  offline->renderer->set_stage(stage);
  offline->renderer->draw(0.0);
  if (model::Problems failed = offline->renderer->take_problems(); !failed.empty())
    return tl::unexpected(std::move(failed));
  outputs::ByteImage picture = read_picture(offline->renderer->pictures().front());
  PiecedViewports viewports;
  for (const plan::ViewportPlan& viewport : stage->plan->outputs.front().viewports)
    if (asked_for(options, viewport) && viewport.pieces) viewports.push_back(&viewport);
  const std::filesystem::path file(options.target);
  if (file.extension() == ".svg") {
    const auto text = borders_as_svg(picture, viewports);
    if (!text) return tl::unexpected(text.error());
    return write_text(file, *text);
  }
  draw_borders(picture, viewports);
  outputs::ByteView pixels = outputs::view(picture);
  pixels.alpha = false;
  return outputs::write_image(file, pixels);
}

ExitCode run(const Options& options) {
  auto loaded = loader::load_show(options.show);
  if (!loaded) {
    print_problems(loaded.error());
    return exit_of_unloaded(loaded.error());
  }
  model::Problems problems = apply(options, loaded->show);
  if (problems.empty() && !options.target.empty() && loaded->show.outputs.size() > 1)
    problems.push_back(bad_option("-o", "with --output NAME, as the show has several", options.target));
  if (!problems.empty()) {
    print_problems(problems);
    return exit_unusable;
  }
  const auto refuse = [&loaded](model::Problems& found) {
    loader::locate(found, loaded->positions);
    print_problems(found);
    return exit_no;
  };
  std::shared_ptr<const frame::Stage> stage;
  std::shared_ptr<const plan::Plan> plan;
  if (options.target.empty()) {
    auto planned = plan::make_plan(loaded->show);
    if (!planned) return refuse(planned.error());
    print_problems(planned->warnings);
    plan = std::make_shared<plan::Plan>(std::move(planned->plan));
  } else {
    auto made = make_stage(loaded->show, std::filesystem::path(options.show).parent_path());
    if (!made) return refuse(made.error());
    stage = *made;
    plan = stage->plan;
  }
  std::vector<Figures> figures;
  for (const plan::OutputPlan& output : plan->outputs)
    for (const plan::ViewportPlan& viewport : output.viewports)
      if (asked_for(options, viewport))
        figures.push_back(figures_of(output, viewport, loaded->show.pieces.max_error));
  print(figures, options.json);
  if (!stage) return exit_done;
  if (auto written = write_picture(options, stage); !written) {
    print_problems(written.error());
    return exit_no;
  }
  return exit_done;
}

} // namespace

void add_pieces(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("pieces", "Says which pieces viewports are drawn with (as if all had the method "
                                   "'piecewise'), and draws their borders.");
  command->add_option("show", options->show, "Show file")->required()->type_name("FILE");
  command
      ->add_option("-o,--to", options->target,
                   "Picture with the borders over it (png, jpg, exr, tif), or svg: borders as polygons over "
                   "the embedded picture")
      ->type_name("FILE");
  command->add_option("--output", options->output, "Only this output of the show")->type_name("NAME");
  command->add_option("--viewport", options->viewport, "Only viewports of this name")->type_name("NAME");
  command->add_option("--size", options->size, "Pixels of the picture")->type_name("WxH");
  command
      ->add_option("--max-error", options->max_error,
                   "Pixels that pieces may be off, instead of the show's own")
      ->check(CLI::Range(0.01, 64.0))
      ->type_name("PX");
  command->add_flag("--json", options->json, "One JSON object on standard output, nothing else");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace cupola::cli
