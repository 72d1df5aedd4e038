// cupola compare: how far two pictures are apart.
#include <CLI/App.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "renderer/outputs/image_file.h"
#include "renderer/reference/compare.h"
#include "server/cli/commands.h"
#include "server/cli/report.h"

namespace cupola::cli {

namespace {

struct Options {
  std::string got, wanted, difference;
  std::optional<double> min_psnr;
  std::optional<int> max_difference;
  int magnify = 8;
  bool mask = false;
  bool json = false;
};

/// What stands for an infinite PSNR: a number, so that every reader of numbers survives it.
constexpr double identical_psnr = 999.0;

reference::Pixels pixels(const outputs::ByteImage& image) { return {image.rgba, image.width, image.height}; }

std::string size_text(const outputs::ByteImage& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

ExitCode unusable(const model::Problems& problems, bool json) {
  if (json)
    std::printf("%s\n", nlohmann::ordered_json{{"problems", nlohmann::ordered_json::parse(as_json(problems))}}
                            .dump(2)
                            .c_str());
  else
    for (const model::Problem& problem : problems)
      std::fprintf(stderr, "%s\n", model::to_text(problem).c_str());
  return exit_unusable;
}

ExitCode sizes_differ(const outputs::ByteImage& got, const outputs::ByteImage& wanted, bool json) {
  if (json)
    std::printf("%s\n",
                nlohmann::ordered_json{{"within", false}, {"sizes", {size_text(got), size_text(wanted)}}}
                    .dump(2)
                    .c_str());
  else
    std::fprintf(stderr, "The sizes differ: %s and %s.\n", size_text(got).c_str(), size_text(wanted).c_str());
  return exit_no;
}

struct Verdict {
  double psnr = 0.0; ///< dB, identical_psnr where nothing differs
  bool identical = false, psnr_within = true, difference_within = true;
  [[nodiscard]] bool within() const { return psnr_within && difference_within; }
};

Verdict judge(const reference::Comparison& figures, const Options& options) {
  Verdict verdict;
  verdict.identical = std::isinf(figures.psnr_db);
  verdict.psnr = verdict.identical ? identical_psnr : figures.psnr_db;
  verdict.psnr_within = !options.min_psnr || figures.psnr_db >= *options.min_psnr;
  verdict.difference_within = !options.max_difference || figures.max_difference <= *options.max_difference;
  return verdict;
}

void print_text(const reference::Comparison& figures, const Verdict& verdict, const Options& options) {
  std::printf("PSNR: %.2f dB%s\n", verdict.psnr, verdict.identical ? " (identical)" : "");
  if (figures.ssim)
    std::printf("SSIM: %.4f\n", *figures.ssim);
  else
    std::printf("SSIM: not defined, the picture is smaller than its window of 11 x 11 pixels\n");
  std::printf("Largest difference: %d of 255", figures.max_difference);
  if (figures.max_difference > 0) std::printf(", at %d,%d", figures.worst_x, figures.worst_y);
  std::printf("\n");
  if (!verdict.psnr_within) std::printf("beyond --min-psnr %g\n", *options.min_psnr);
  if (!verdict.difference_within) std::printf("beyond --max-diff %d\n", *options.max_difference);
}

void print_json(const reference::Comparison& figures, const Verdict& verdict) {
  nlohmann::ordered_json answer{{"psnr_db", verdict.psnr}, {"identical", verdict.identical}};
  answer["ssim"] = figures.ssim ? nlohmann::ordered_json(*figures.ssim) : nlohmann::ordered_json();
  answer["max_difference"] = figures.max_difference;
  answer["worst"] = {figures.worst_x, figures.worst_y};
  answer["pixels"] = figures.compared;
  answer["differing_pixels"] = figures.beyond;
  answer["within"] = verdict.within();
  std::printf("%s\n", answer.dump(2).c_str());
}

ExitCode run(const Options& options) {
  const auto got = outputs::read_image(options.got);
  if (!got) return unusable(got.error(), options.json);
  const auto wanted = outputs::read_image(options.wanted);
  if (!wanted) return unusable(wanted.error(), options.json);
  if (got->width != wanted->width || got->height != wanted->height)
    return sizes_differ(*got, *wanted, options.json);

  if (!options.difference.empty()) {
    const outputs::ByteImage difference{
        got->width, got->height,
        reference::difference_picture(pixels(*got), pixels(*wanted), options.magnify)};
    if (const auto written = outputs::write_image(options.difference, outputs::view(difference)); !written)
      return unusable(written.error(), options.json);
  }
  const auto figures = reference::compare(pixels(*got), pixels(*wanted), {.mask = options.mask});
  const Verdict verdict = judge(figures, options);
  if (options.json)
    print_json(figures, verdict);
  else
    print_text(figures, verdict, options);
  return verdict.within() ? exit_done : exit_no;
}

} // namespace

void add_compare(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("compare", "Says how far two pictures are apart: PSNR, SSIM, largest difference.");
  command->footer("Exit 0 within the limits, 1 beyond them or where sizes differ, 2 unreadable. Equal "
                  "pictures have a PSNR of 999.");
  command->add_option("a", options->got, "A picture")->required()->type_name("FILE");
  command->add_option("b", options->wanted, "The picture that it should be")->required()->type_name("FILE");
  command->add_option("--min-psnr", options->min_psnr, "Exit 1 where the PSNR is lower, dB");
  command->add_option("--max-diff", options->max_difference,
                      "Exit 1 where a channel differs by more, 0 to 255");
  command->add_option("--diff", options->difference, "Writes the difference as a picture")->type_name("FILE");
  command->add_option("--magnify", options->magnify, "Factor for the picture of the difference")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  command->add_flag("--mask", options->mask,
                    "Leaves out the pixels where B is transparent, as outside a fisheye");
  command->add_flag("--json", options->json, "Prints JSON alone");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace cupola::cli
