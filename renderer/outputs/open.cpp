#include "renderer/outputs/open.h"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "renderer/outputs/desktop.h"
#include "renderer/outputs/files.h"
#include "renderer/outputs/headless.h"
#include "renderer/outputs/window.h"

namespace cupola::outputs {

namespace {

/// Room between windows for their frames and title bars, pixels.
constexpr int window_gap = 40;

using Places = std::map<std::string, Rect>;

template <class Kind>
bool any_is(const WantedOutputs& wanted) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [](const auto& entry) { return std::holds_alternative<Kind>(entry.second.sink); });
}

/// Where the windows of `auto` outputs go: side by side on the primary monitor.
Places tile_automatic(const WantedOutputs& wanted, const Desktop& desktop) {
  const std::vector<Monitor> monitors = desktop.monitors();
  if (monitors.empty()) return {};
  std::vector<std::string> names;
  std::vector<Size> sizes;
  for (const auto& [name, output] : wanted) {
    if (!std::holds_alternative<model::AutoOutput>(output.sink)) continue;
    names.push_back(name);
    sizes.push_back({output.width, output.height});
  }
  const Monitor& monitor = monitors.front();
  const Size area{monitor.work.width, monitor.work.height - window_gap};
  const std::vector<Rect> tiles = tile(sizes, area, window_gap);
  Places places;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Rect place = tiles[i];
    place.x += monitor.work.x - monitor.place.x;
    place.y += monitor.work.y - monitor.place.y + window_gap;
    places[names[i]] = place;
  }
  return places;
}

model::Problem no_display() {
  return {model::Code::output_unavailable, "", "a display for the window", "none",
          "Start the daemon in a graphical session with an output of kind 'window' or 'auto', or use the "
          "kind 'headless'."};
}

struct Opener {
  const std::string& name;
  const model::Output& wanted;
  const Places& places;
  MainThread& main;
  Context& context;

  [[nodiscard]] model::Result<std::unique_ptr<Output>> operator()(const model::HeadlessOutput&) const {
    return std::make_unique<HeadlessOutput>(wanted.width, wanted.height);
  }

  [[nodiscard]] model::Result<std::unique_ptr<Output>> operator()(const model::AutoOutput&) const {
    const auto place = places.find(name);
    if (place == places.end()) return (*this)(model::HeadlessOutput{});
    WindowRequest request;
    request.title = name;
    request.place = place->second;
    return open_window(main, context, {request, {wanted.width, wanted.height}, true});
  }

  [[nodiscard]] model::Result<std::unique_ptr<Output>> operator()(const model::WindowOutput& window) const {
    if (!context.desktop()) return model::failure(no_display());
    WindowRequest request;
    request.title = name;
    request.monitor = window.monitor;
    request.fullscreen = window.fullscreen;
    request.decorated = window.decorated;
    request.place = {window.x, window.y, wanted.width, wanted.height};
    return open_window(main, context, {request, {wanted.width, wanted.height}, window.vsync});
  }

  [[nodiscard]] model::Result<std::unique_ptr<Output>> operator()(const model::FilesOutput& files) const {
    return open_files({name, wanted.width, wanted.height, files.directory, files.format, files.limit});
  }
};

/// Problems of an output point to it.
void address(model::Problems& problems, const std::string& name) {
  for (model::Problem& problem : problems)
    if (problem.pointer.empty()) problem.pointer = "/outputs/" + name;
}

} // namespace

bool opens_alike(const model::Output& a, const model::Output& b) {
  return a.sink == b.sink && a.width == b.width && a.height == b.height;
}

bool wants_windows(const WantedOutputs& wanted) {
  return any_is<model::AutoOutput>(wanted) || any_is<model::WindowOutput>(wanted);
}

bool needs_windows(const WantedOutputs& wanted) { return any_is<model::WindowOutput>(wanted); }

model::Problems test_outputs(const WantedOutputs& wanted, Context& context) {
  model::Problems problems;
  for (const auto& [name, output] : wanted) {
    model::Problems found;
    if (const auto* window = std::get_if<model::WindowOutput>(&output.sink)) {
      if (!context.desktop()) {
        found.push_back(no_display());
      } else if (const auto monitor = context.desktop()->find_monitor(window->monitor); !monitor) {
        found = monitor.error();
        for (auto& problem : found) problem.pointer = "/outputs/" + name + "/monitor";
      }
    } else if (const auto* files = std::get_if<model::FilesOutput>(&output.sink)) {
      found = test_files({name, output.width, output.height, files->directory, files->format, files->limit});
    }
    address(found, name);
    problems.insert(problems.end(), found.begin(), found.end());
  }
  return problems;
}

model::Result<RunningOutputs> open_outputs(const WantedOutputs& wanted, const RunningOutputs& running,
                                           MainThread& main, Context& context) {
  model::Problems problems = test_outputs(wanted, context);
  if (!problems.empty()) return tl::unexpected(problems);

  const Places places = context.desktop() ? tile_automatic(wanted, *context.desktop()) : Places{};
  RunningOutputs opened;
  for (const auto& [name, output] : wanted) {
    const auto same = running.find(name);
    if (same != running.end() && opens_alike(same->second.wanted, output)) {
      opened[name] = same->second;
      continue;
    }
    auto made = std::visit(Opener{name, output, places, main, context}, output.sink);
    if (made) {
      opened[name] = {output, std::move(*made)};
    } else {
      address(made.error(), name);
      problems.insert(problems.end(), made.error().begin(), made.error().end());
    }
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return opened;
}

} // namespace cupola::outputs
