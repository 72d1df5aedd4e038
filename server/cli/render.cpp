// cupola render: pictures of a show, off-line.
#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "configs/loader/loader.h"
#include "server/cli/commands.h"
#include "server/cli/offline.h"

namespace cupola::cli {

namespace {

constexpr int reference_samples = 64; // a pixel, unless told otherwise

struct Options {
  std::string show, output, method, frames, size, cubemap_size, target;
  int samples = 0, supersampling = 0, anisotropy = 0; ///< 0: as the show says
  bool quiet = false, json = false;
};

struct FrameRange {
  long first = 0, last = 0;
  bool given = false;
};

/// Puts the options into the show, so that planning sees them as if they stood in the file.
model::Problems apply(const Options& options, model::Show& show) {
  model::Problems problems;
  if (!options.size.empty()) problems = resize(show, options.size);
  if (!options.output.empty())
    if (auto unknown = keep_output(show, options.output); !unknown.empty()) {
      problems.insert(problems.end(), unknown.begin(), unknown.end());
      return problems;
    }
  for (auto& [name, output] : show.outputs) {
    if (options.method.empty()) continue;
    for (auto& [viewport_name, viewport] : output.viewports)
      viewport.method = options.method == "piecewise" ? model::Method::piecewise
                        : options.method == "cubemap" ? model::Method::cubemap
                                                      : model::Method::reference;
  }
  if (options.cubemap_size == "auto") {
    show.quality.cubemap_size.reset();
  } else if (!options.cubemap_size.empty()) {
    try {
      const int size = std::stoi(options.cubemap_size);
      if (size < 16 || size > 16384) throw std::out_of_range("size");
      show.quality.cubemap_size = size;
    } catch (const std::exception&) {
      problems.push_back(bad_option("--cubemap-size", "from 16 to 16384, or auto", options.cubemap_size));
    }
  }
  if (options.samples > 0 || options.supersampling > 0 || options.anisotropy > 0)
    show.quality.automatic = false;
  if (options.samples > 0) show.quality.samples = options.samples;
  if (options.supersampling > 0) show.quality.supersampling = options.supersampling;
  if (options.anisotropy > 0) show.quality.anisotropy = options.anisotropy;
  return problems;
}

model::Result<FrameRange> parse_frames(const std::string& text) {
  FrameRange range;
  if (text.empty()) return range;
  range.given = true;
  if (!parse_pair(text, "..", range.first, range.last) || range.first < 0 || range.last < range.first)
    return model::failure(bad_option("--frames", "as FIRST..LAST, counted from 0", text));
  return range;
}

/// One picture goes to the file named; several go into a folder, numbered and named by output.
std::filesystem::path file_of(const Options& options, const FrameRange& range, bool names_picture,
                              const std::string& output, long frame) {
  std::filesystem::path target(options.target);
  if (names_picture) return target;
  char number[32];
  std::snprintf(number, sizeof number, "_%06ld", frame);
  return target / (output + (range.given ? number : "") + ".png");
}

/// Draws and writes every picture. With --json a list of them follows on standard output.
ExitCode render_frames(const Options& options, const FrameRange& range, bool names_picture, double frame_rate,
                       frame::Renderer& renderer) {
  auto pictures = nlohmann::ordered_json::array();
  for (long frame = range.first; frame <= range.last; ++frame) {
    renderer.draw(static_cast<double>(frame) / frame_rate);
    if (model::Problems failed = renderer.take_problems(); !failed.empty()) {
      print_problems(failed);
      return exit_no;
    }
    for (const frame::Picture& picture : renderer.pictures()) {
      const outputs::ByteImage image = read_picture(picture);
      outputs::ByteView pixels = outputs::view(image);
      pixels.alpha = false;
      const auto file = file_of(options, range, names_picture, picture.output, frame);
      if (auto written = outputs::write_image(file, pixels); !written) {
        print_problems(written.error());
        return exit_no;
      }
      if (!options.quiet) std::fprintf(stderr, "%s\n", file.c_str());
      pictures.push_back({{"file", file.string()},
                          {"output", picture.output},
                          {"frame", frame},
                          {"width", picture.width},
                          {"height", picture.height}});
    }
    if (range.given && !options.quiet)
      std::fprintf(stderr, "frame %ld of %ld..%ld\n", frame, range.first, range.last);
  }
  if (options.json) {
    const nlohmann::ordered_json out{{"device", renderer.device().name}, {"pictures", std::move(pictures)}};
    std::printf("%s\n", out.dump(2).c_str());
  }
  return exit_done;
}

ExitCode run(const Options& options) {
  auto loaded = loader::load_show(options.show);
  if (!loaded) {
    print_problems(loaded.error());
    return exit_of_unloaded(loaded.error());
  }
  model::Problems problems = apply(options, loaded->show);
  auto range = parse_frames(options.frames);
  if (!range) problems.insert(problems.end(), range.error().begin(), range.error().end());
  if (!problems.empty()) {
    print_problems(problems);
    return exit_unusable;
  }
  const bool several = loaded->show.outputs.size() > 1;
  const std::filesystem::path target(options.target);
  const bool single = !several && range->first == range->last;
  // A format that is not known is said when the one picture is written; a folder may have a dot in its name.
  const bool names_picture = outputs::format_of(target.extension().string()).has_value() ||
                             (single && target.has_extension() && !std::filesystem::is_directory(target));
  if (names_picture && !single) {
    print_problems(
        {bad_option("-o", "as a folder for several pictures (or --output NAME for one)", options.target)});
    return exit_unusable;
  }

  auto stage = make_stage(loaded->show, std::filesystem::path(options.show).parent_path());
  if (!stage) {
    loader::locate(stage.error(), loaded->positions);
    print_problems(stage.error());
    return exit_no;
  }
  const auto progress = [&options](double share) {
    if (!options.quiet)
      std::fprintf(stderr, "\rreference %3.0f %%%s", share * 100.0, share >= 1.0 ? "\n" : "");
  };
  std::error_code error;
  if (!names_picture)
    std::filesystem::create_directories(target, error); // writing says what is wrong with it
  frame::RendererOptions drawing;
  drawing.reference_samples = options.samples > 0 ? options.samples : reference_samples;
  drawing.progress = progress;
  auto offline = make_offline_renderer(drawing);
  if (!offline) {
    print_problems(offline.error());
    return exit_unusable;
  }
  offline->renderer->set_stage(*stage);
  return render_frames(options, *range, names_picture, loaded->show.frame_rate, *offline->renderer);
}

} // namespace

void add_render(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Renders pictures of a show without a daemon.");
  command->add_option("show", options->show, "Show file")->required()->type_name("FILE");
  command->add_option("-o,--to", options->target, "Picture (png, jpg, exr, tif), or folder for several")
      ->required()
      ->type_name("FILE|DIR");
  command->add_option("--output", options->output, "Only this output of the show")->type_name("NAME");
  command->add_option("--method", options->method, "For all viewports, instead of the show's own")
      ->check(CLI::IsMember({"piecewise", "cubemap", "reference"}));
  command->add_option("--frames", options->frames, "First and last frame, counted from 0")->type_name("A..B");
  command->add_option("--size", options->size, "Pixels of the picture")->type_name("WxH");
  command->add_option("--cubemap-size", options->cubemap_size, "Edge of a cubemap face in pixels, or auto")
      ->type_name("N");
  command->add_option("--samples", options->samples, "Samples a pixel (the reference's are 64 unless told)")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  command
      ->add_option("--supersampling", options->supersampling,
                   "Drawn so many times as wide and high, then averaged")
      ->check(CLI::Range(1, 8))
      ->type_name("K");
  command->add_option("--anisotropy", options->anisotropy, "Of texture filtering")
      ->check(CLI::Range(1, 16))
      ->type_name("N");
  command->add_flag("--json", options->json,
                    "One JSON object about the pictures on standard output, nothing else");
  command->add_flag("--quiet", options->quiet, "Prints nothing but problems");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace cupola::cli
