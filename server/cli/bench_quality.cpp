// The paper's claim: sharper pictures. Both methods against rays, at matched density, at equal time, and
// against the best cubemap of any size.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "renderer/reference/compare.h"
#include "server/cli/bench.h"
#include "server/cli/bench_show.h"
#include "server/cli/bench_timing.h"
#include "server/cli/offline.h"
#include "server/cli/quality_case.h"

namespace cupola::cli {

namespace {

using model::Method;

/// Pixels of the wall are square at the horizon, as in table 1: tan(half the height) = π · height / width.
constexpr int wall_width = 1280, wall_height = 960, dome_size = 1280;
constexpr int band_width = 600; ///< of the wall beside plain perspectives, as high in proportion
const model::Shape wall = model::Cylinder{{360.0}, {134.0}};
const model::Shape dome = model::Fisheye{{180.0}};
constexpr double time_slack = 1.05; ///< a cubemap may take that much longer
constexpr double cubemap_scales[] = {1.0, 1.5, 2.0, 3.0, 4.0};
/// A tenth of the picture at each pose, tiles all over it.
constexpr Tiles tiles{80, 10, {}};
constexpr int rough_poses = 2; ///< to find the best setting; it is then measured over all poses

/// What a careful operator sets, alike for both methods: the samples and the texture filter of the driver.
QualitySetting careful(Method method, double cubemap_scale = 0.0, bool mipmaps = false) {
  return {method, cubemap_scale, 1, 4, 16, mipmaps};
}

/// All that either method can do with its time; cubemaps by rising size within what else is alike.
std::vector<QualitySetting> ways_to_spend_time(Method method) {
  std::vector<QualitySetting> all;
  const auto add = [&](int supersampling, int samples, int anisotropy, bool mipmaps) {
    QualitySetting setting{method, 0.0, supersampling, samples, anisotropy, mipmaps};
    if (method == Method::piecewise) {
      all.push_back(setting);
      return;
    }
    for (const double scale : cubemap_scales) {
      if (mipmaps && scale < 2.0) continue;
      setting.cubemap_scale = scale;
      all.push_back(setting);
    }
  };
  for (const int supersampling : {1, 2, 3}) add(supersampling, 1, 1, false);
  for (const int supersampling : {1, 2}) add(supersampling, 1, 16, false);
  for (const int anisotropy : {1, 16}) add(1, 4, anisotropy, false);
  if (method == Method::piecewise)
    add(4, 1, 1, false);
  else
    add(1, 4, 16, true);
  return all;
}

struct Spent {
  QualitySetting setting;
  QualityFigures figures;
};

/// What nothing else beats in both time and PSNR, by rising time.
std::vector<Spent> front(std::vector<Spent> all) {
  std::sort(all.begin(), all.end(),
            [](const Spent& a, const Spent& b) { return a.figures.milliseconds < b.figures.milliseconds; });
  std::vector<Spent> best;
  for (const Spent& spent : all)
    if (best.empty() || spent.figures.psnr_db > best.back().figures.psnr_db) best.push_back(spent);
  return best;
}

/// The middle third of a picture, side by side with others: a close-up, each pixel `zoom` pixels wide.
outputs::ByteImage close_up(const std::vector<const outputs::ByteImage*>& pictures, int x0, int y0, int width,
                            int height) {
  constexpr int zoom = 4, gap = 8;
  outputs::ByteImage out;
  const int count = static_cast<int>(pictures.size());
  out.width = count * width * zoom + (count - 1) * gap;
  out.height = height * zoom;
  out.rgba.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 4, 255);
  for (int i = 0; i < count; ++i)
    for (int y = 0; y < height * zoom; ++y)
      for (int x = 0; x < width * zoom; ++x) {
        const outputs::ByteImage& from = *pictures[static_cast<std::size_t>(i)];
        const auto source = static_cast<std::size_t>((y0 + y / zoom) * from.width + x0 + x / zoom) * 4;
        const auto target = static_cast<std::size_t>(y * out.width + i * (width * zoom + gap) + x) * 4;
        std::copy_n(from.rgba.begin() + static_cast<std::ptrdiff_t>(source), 3,
                    out.rgba.begin() + static_cast<std::ptrdiff_t>(target));
      }
  return out;
}

class QualityBench {
public:
  QualityBench(frame::Renderer& renderer, const QualityOptions& options, BenchReport& report)
      : renderer_(renderer)
      , options_(options)
      , report_(report)
      , poses_(options.quick ? 2 : 10)
      , samples_(options.quick ? 4 : reference::default_samples) {}

  bool run() {
    const model::City city{};
    const QualityWorld streets = make_world(city), room = make_world(model::Room{});
    if (!streets.scene || !room.scene) return false;
    const model::Style textured{};
    model::Style wireframe, hatching;
    wireframe.kind = model::StyleKind::wireframe;
    hatching.kind = model::StyleKind::hatching;
    if (!subject("city", "cylinder", city, textured, streets) ||
        !subject("text", "cylinder", model::Room{}, textured, room) ||
        !subject("wireframe", "cylinder", city, wireframe, streets) ||
        !subject("hatching", "cylinder", city, hatching, streets) ||
        !subject("city", "fisheye", city, textured, streets))
      return false;
    if (options_.subject.empty())
      report_.ratios = {{"cylinder_matched_db", lead("city", "cylinder", "matched")},
                        {"cylinder_equal_time_db", lead("city", "cylinder", "equal time")},
                        {"fisheye_equal_time_db", lead("city", "fisheye", "equal time")},
                        {"lineart_best_db", std::min(lead("wireframe", "cylinder", "best"),
                                                     lead("hatching", "cylinder", "best"))},
                        {"minus_plain_db", rounded(leads_.at("minus_plain_db"), 0.001)}};
    for (const auto& [name, value] : leads_) report_.ratios[name] = rounded(value, 0.001);
    return true;
  }

private:
  static std::string key(const std::string& subject, const std::string& view, const std::string& rule) {
    std::string name = view + ' ' + subject + ' ' + rule;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name + "_db";
  }
  double lead(const std::string& subject, const std::string& view, const std::string& rule) const {
    return rounded(leads_.at(key(subject, view, rule)), 0.001);
  }
  void say(const std::string& words) const {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - started_;
    std::fprintf(stderr, "%4.0f s  %s\n", passed.count(), words.c_str());
  }
  /// To find the best: few poses.
  bool rough(QualityCase& here, const QualitySetting& setting, int timed, QualityFigures& figures) {
    return here.measure(renderer_, setting, std::min(poses_, rough_poses), timed, figures);
  }
  bool measure(QualityCase& here, const QualitySetting& setting, QualityFigures& figures) {
    return here.measure(renderer_, setting, here.poses(), 0, figures);
  }

  bool subject(const std::string& name, const std::string& view, const model::Content& content,
               const model::Style& style, const QualityWorld& world) {
    if (!options_.subject.empty() && options_.subject != view + "-" + name) return true;
    const bool flat = view == "cylinder";
    say(view + ", " + name + ": rays, " + std::to_string(poses_) + " poses");
    QualityCase here(quality_show(content, style, flat ? wall : dome, flat ? wall_width : dome_size,
                                  flat ? wall_height : dome_size, poses_),
                     poses_, samples_, world, tiles);
    if (here.poses() == 0 || !matched_and_best(name, view, here)) return false;
    if (name != "city") return true;
    if (flat && !plain(content, world)) return false;
    return equal_time(name, view, here);
  }

  void row(const std::string& subject, const std::string& view, const std::string& rule,
           const QualityCase& here, const QualitySetting& setting, const QualityFigures& figures) {
    const bool piecewise = setting.method == Method::piecewise;
    const auto or_null = [](double value, double step) {
      return value > 0.0 ? nlohmann::ordered_json(rounded(value, step)) : nullptr;
    };
    report_.rows.push_back({{"view", view},
                            {"subject", subject},
                            {"rule", rule},
                            {"method", piecewise ? "pieces" : "cubemap"},
                            {"cubemap", piecewise ? nullptr
                                                  : nlohmann::ordered_json(std::lround(setting.cubemap_scale *
                                                                                       here.matched_size()))},
                            {"mipmaps", setting.mipmaps},
                            {"drawn", setting.supersampling},
                            {"samples", setting.samples},
                            {"anisotropy", setting.anisotropy},
                            {"ms", or_null(figures.milliseconds, 0.01)},
                            {"psnr", rounded(figures.psnr_db, 0.01)},
                            {"ssim", or_null(figures.ssim, 0.0001)},
                            {"sharpness", or_null(figures.sharpness, 0.001)}});
  }

  bool matched_and_best(const std::string& name, const std::string& view, QualityCase& here) {
    say(view + ", " + name + ": matched density, and the best cubemap of any size");
    QualityFigures pieces, matched, best;
    std::vector<outputs::ByteImage> pictures;
    const QualitySetting as_pieces = careful(Method::piecewise), as_cubemap = careful(Method::cubemap, 1.0);
    if (!measure(here, as_pieces, pieces)) return false;
    row(name, view, "matched", here, as_pieces, pieces);
    pictures.push_back(here.drawn(0));
    if (!measure(here, as_cubemap, matched)) return false;
    row(name, view, "matched", here, as_cubemap, matched);
    pictures.push_back(here.drawn(0));
    QualitySetting best_setting = as_cubemap;
    for (const bool mipmaps : {false, true})
      for (const double scale : cubemap_scales) {
        if (mipmaps && scale < 2.0) continue;
        const QualitySetting setting = careful(Method::cubemap, scale, mipmaps);
        QualityFigures figures;
        if (!rough(here, setting, 0, figures)) return false;
        if (figures.psnr_db <= best.psnr_db) continue;
        best = figures;
        best_setting = setting;
      }
    if (!measure(here, best_setting, best)) return false;
    row(name, view, "best", here, best_setting, best);
    leads_[key(name, view, "matched")] = pieces.psnr_db - matched.psnr_db;
    leads_[key(name, view, "best")] = pieces.psnr_db - best.psnr_db;
    pictures.push_back(here.reference(0));
    return write_close_up(std::string(view).append("-").append(name), pictures);
  }

  bool write_close_up(const std::string& name, const std::vector<outputs::ByteImage>& pictures) const {
    if (options_.pictures.empty()) return true;
    std::vector<const outputs::ByteImage*> shown;
    for (const outputs::ByteImage& picture : pictures) shown.push_back(&picture);
    const int width = tiles.edge, row = pictures.front().height / (width + 1) / 2 * (width + 1);
    const outputs::ByteImage image = close_up(shown, 0, row, width, width);
    const auto file = std::filesystem::path(options_.pictures) / ("quality-" + name + ".png");
    auto view = outputs::view(image);
    view.alpha = false;
    const auto written = outputs::write_image(file, view);
    if (!written) print_problems(written.error());
    return written.has_value();
  }

  /// For each setting of the pieces that nothing beats: the best cubemap that takes no longer.
  bool equal_time(const std::string& name, const std::string& view, QualityCase& here) {
    std::vector<Spent> pieces, cubemaps;
    double longest = 0.0;
    QualitySetting slow{Method::cubemap, 1e9};
    for (const Method method : {Method::piecewise, Method::cubemap}) {
      const auto settings = ways_to_spend_time(method);
      std::string line = view;
      line.append(", ").append(name).append(": ").append(std::to_string(settings.size()));
      say(line.append(" ways to spend time"));
      for (const QualitySetting& setting : settings) {
        Spent spent{setting, {}};
        // What takes longer than all pieces is nobody's rival, and larger cubemaps neither: one pose tells.
        if (method == Method::cubemap) {
          const bool alike = setting.cubemap_scale > slow.cubemap_scale &&
                             setting.supersampling == slow.supersampling && setting.samples == slow.samples &&
                             setting.anisotropy == slow.anisotropy;
          if (alike) continue;
          if (!here.measure(renderer_, setting, 1, 1, spent.figures)) return false;
          if (spent.figures.milliseconds > 1.2 * longest) {
            slow = setting;
            continue;
          }
        }
        if (!rough(here, setting, 2, spent.figures)) return false;
        if (method == Method::piecewise) longest = std::max(longest, spent.figures.milliseconds);
        (method == Method::piecewise ? pieces : cubemaps).push_back(spent);
      }
    }
    double sum = 0.0, least = 1e9;
    int count = 0;
    for (const Spent& spent : front(pieces)) {
      const Spent* best = nullptr;
      for (const Spent& other : cubemaps)
        if (other.figures.milliseconds <= spent.figures.milliseconds * time_slack &&
            (!best || other.figures.psnr_db > best->figures.psnr_db))
          best = &other;
      if (!best) continue; // no cubemap is as quick
      QualityFigures ours, theirs;
      if (!measure(here, spent.setting, ours) || !measure(here, best->setting, theirs)) return false;
      ours.milliseconds = spent.figures.milliseconds;
      theirs.milliseconds = best->figures.milliseconds;
      row(name, view, "equal time", here, spent.setting, ours);
      row(name, view, "equal time", here, best->setting, theirs);
      sum += ours.psnr_db - theirs.psnr_db;
      least = std::min(least, ours.psnr_db - theirs.psnr_db);
      ++count;
    }
    leads_[key(name, view, "equal time")] = count == 0 ? 0.0 : sum / count;
    leads_[key(name, view, "equal time least")] = count == 0 ? 0.0 : least;
    return true;
  }

  /// Six perspectives round the horizon, against the band of the wall with the same directions.
  bool plain(const model::Content& content, const QualityWorld& world) {
    say("plain perspectives over the same directions: rays");
    constexpr int views = 12, band_height = band_width * wall_height / wall_width;
    const double focal = band_width / (2.0 * std::numbers::pi); // pixels a radian, as the wall's horizon
    const int size = static_cast<int>(std::ceil(2.0 * focal * std::tan(std::numbers::pi / views)));
    const double fov = 2.0 * std::atan(size / 2.0 / focal) * 180.0 / std::numbers::pi;
    QualityCase bent(quality_show(content, {}, wall, band_width, band_height, poses_), poses_, samples_,
                     world, {0, 1, {0, (band_height - size) / 2, band_width, size}});
    model::Show show = quality_show(content, {}, model::Perspective{{fov}, std::nullopt}, size, size, poses_);
    const std::vector<model::Keyframe> places = show.camera.path;
    show.camera.path.clear();
    for (int i = 0; i < poses_ * views; ++i) {
      model::Keyframe key = places[static_cast<std::size_t>(i / views)];
      key.time = i;
      key.orientation.yaw.degrees += (i % views) * 360.0 / views;
      show.camera.path.push_back(key);
    }
    QualityCase flat(show, poses_ * views, samples_, world, {});
    QualityFigures ours, plain;
    if (!measure(flat, careful(Method::piecewise), plain) || !measure(bent, careful(Method::piecewise), ours))
      return false;
    const auto error = [](double psnr) { return std::pow(10.0, -psnr / 10.0); };
    double difference = 0.0;
    for (int pose = 0; pose < poses_; ++pose) {
      double sum = 0.0;
      for (int i = 0; i < views; ++i)
        sum += error(psnr(flat.drawn(pose * views + i), flat.reference(pose * views + i)));
      const double band = psnr(bent.drawn(pose), bent.reference(pose));
      difference += (-10.0 * std::log10(sum / views) - band) / poses_;
    }
    leads_["minus_plain_db"] = difference;
    row("city", "band of the cylinder", "plain", bent, careful(Method::piecewise), ours);
    row("city", "perspective", "plain", flat, careful(Method::piecewise), plain);
    return true;
  }

  static double psnr(const outputs::ByteImage& got, const outputs::ByteImage& wanted) {
    const auto pixels = [](const outputs::ByteImage& image) {
      return reference::Pixels{image.rgba, image.width, image.height};
    };
    return reference::compare(pixels(got), pixels(wanted), {.mask = true, .ssim = false}).psnr_db;
  }

  frame::Renderer& renderer_;
  const QualityOptions& options_;
  BenchReport& report_;
  int poses_, samples_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::map<std::string, double> leads_; ///< dB by which pieces are ahead
};

std::vector<std::string> notes() {
  std::vector<std::string> lines{
      "Cylinder 360°, " + std::to_string(wall_width) + " × " + std::to_string(wall_height) +
      "; fisheye 180°, " + std::to_string(dome_size) +
      "². Means over the poses, against rays (64 a pixel), on tiles all over the picture: a tenth of it at "
      "each pose."};
  for (const char* line :
       {"matched: 4 samples, anisotropy 16 for both, cubemap texels as large as pixels.",
        "best: the same settings, the best cubemap of 1 to 4 times that size, with and without mipmaps.",
        "equal time: for each setting of the pieces that no other beats in both time and PSNR, the best",
        "cubemap that takes at most 1.05 of its time; the mean lead over these, and the least.",
        "minus_plain_db: what plain perspectives over the same directions reach, less what pieces do.",
        "sharpness: gradient along the reference's steepest edges, over the reference's own."})
    lines.emplace_back(line);
  return lines;
}

} // namespace

int bench_quality(const QualityOptions& options) {
  return run_bench(options.json, {}, [&](frame::Renderer& renderer, BenchReport& report) {
    report.notes = notes();
    return QualityBench(renderer, options, report).run();
  });
}

} // namespace cupola::cli
