// The address of a request, taken apart.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace cupola::control {

struct Target {
  std::string path;                         ///< decoded, begins with '/'
  std::map<std::string, std::string> query; ///< decoded; the last of equal names counts
};

/// nullopt for what is not a path: a broken percent escape, a NUL, no leading '/'. Takes the absolute form
/// ("http://host/path") too.
[[nodiscard]] std::optional<Target> parse_target(std::string_view target);

/// Whether `host` (a Host header, with or without port) can only mean this machine, so that a page under a
/// foreign name that resolves here is told apart: an IP address, localhost, or this machine's own name.
[[nodiscard]] bool is_own_host(std::string_view host);

} // namespace cupola::control
