// cupola get PATH · cupola set PATH VALUE: one parameter of a running daemon.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cctype>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "server/cli/commands.h"
#include "server/cli/report.h"
#include "server/control/client/client.h"

namespace cupola::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Asked {
  std::string path, value, url = "http://127.0.0.1:8750";
  double timeout = 10.0; ///< seconds
  bool json = false, wait = false;
};

/// What may stand in the path of an address as it is; the rest is percent-encoded.
std::string encoded(const std::string& path) {
  static constexpr std::string_view digits = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string_view("/-._~").find(c) != std::string_view::npos) {
      out += c;
    } else {
      out += '%';
      out += digits[byte >> 4U];
      out += digits[byte & 15U];
    }
  }
  return out;
}

ExitCode unusable(const model::Problems& problems, bool json) {
  if (json) std::cout << Json{{"problems", Json::parse(as_json(problems))}}.dump(2) << '\n';
  for (const model::Problem& problem : problems) std::cerr << "cupola: " << model::to_text(problem) << '\n';
  return exit_unusable;
}

/// The daemon's problems, as it words them.
ExitCode refused(const control::Reply& reply, bool json) {
  const Json body = Json::parse(reply.body, nullptr, false);
  if (json && !body.is_discarded()) std::cout << body.dump(2) << '\n';
  if (!body.is_object() || !body.contains("problems")) {
    std::cerr << "cupola: the answer is not cupolad's (status " << reply.status << ")\n";
    return exit_unusable;
  }
  for (const Json& problem : body["problems"])
    std::cerr << "cupola: " << problem.value("text", problem.dump()) << '\n';
  return exit_no;
}

/// Asks, and hands a good answer's JSON to `print`.
template <class Print>
ExitCode ask(const Asked& asked, const std::string& method, const std::string& target,
             const std::string& body, const Print& print) {
  const auto url = control::parse_url(asked.url);
  if (!url) return unusable(url.error(), asked.json);
  const auto patience = std::chrono::milliseconds(static_cast<std::int64_t>(asked.timeout * 1000.0) + 5000);
  const auto reply = control::request(*url, method, target, body, patience);
  if (!reply) return unusable(reply.error(), asked.json);
  if (reply->status != 200 && reply->status != 202) return refused(*reply, asked.json);
  const Json value = Json::parse(reply->body, nullptr, false);
  if (value.is_discarded()) return refused(*reply, asked.json);
  return print(value, reply->status);
}

std::string show_address(const std::string& path) {
  if (path.empty() || path == "/") return "/api/v1/show";
  return "/api/v1/show" + encoded(path.front() == '/' ? path : '/' + path);
}

ExitCode get(const Asked& asked) {
  return ask(asked, "GET", show_address(asked.path), "", [&](const Json& value, int) {
    if (value.is_string() && !asked.json)
      std::cout << value.get<std::string>() << '\n';
    else
      std::cout << value.dump(value.is_object() ? 2 : -1) << '\n';
    return exit_done;
  });
}

ExitCode set(const Asked& asked) {
  Json value = Json::parse(asked.value, nullptr, false);
  if (value.is_discarded()) value = asked.value; // a plain word needs no quotes
  std::string target = show_address(asked.path);
  if (asked.wait) target += "?wait=shown&timeout=" + std::to_string(asked.timeout);
  const std::string body = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return ask(asked, "PUT", target, body, [&](const Json& answer, int status) {
    if (asked.json) {
      std::cout << answer.dump(2) << '\n';
    } else {
      std::cout << "revision " << answer.value("revision", Json()).dump();
      if (answer.value("changes", Json::array()).empty())
        std::cout << " (as it was)";
      else
        std::cout << " (" << answer.value("cost", "") << ')';
      if (asked.wait && status == 200)
        std::cout << ", shown by frame " << answer.value("frame", Json()).dump();
      std::cout << '\n';
    }
    if (status != 202) return exit_done;
    const Json problems = answer.value("problems", Json::array());
    for (const Json& problem : problems)
      std::cerr << "cupola: " << problem.value("text", problem.dump()) << '\n';
    std::cerr << "cupola: accepted, but "
              << (problems.empty() ? "no frame has shown it in time"
                                   : "it cannot be shown; what was shown before goes on")
              << '\n';
    return exit_no;
  });
}

void add_common(CLI::App& command, Asked& asked) {
  command.add_option("path", asked.path, "Address of a parameter, such as /projections/wall/horizontal_fov")
      ->required();
  command.add_option("--url", asked.url, "Where cupolad listens")->capture_default_str();
  command.add_flag("--json", asked.json, "Standard output is JSON alone");
}

} // namespace

void add_get(CLI::App& app, ExitCode& exit_code) {
  auto asked = std::make_shared<Asked>();
  CLI::App* command = app.add_subcommand("get", "Print a value of the running show");
  add_common(*command, *asked);
  command->callback([asked, &exit_code] { exit_code = get(*asked); });
}

void add_set(CLI::App& app, ExitCode& exit_code) {
  auto asked = std::make_shared<Asked>();
  CLI::App* command = app.add_subcommand("set", "Change a value of the running show");
  add_common(*command, *asked);
  command->add_option("value", asked->value, "JSON, or a plain word; null brings the default back")
      ->required();
  command->add_flag("--wait", asked->wait, "Return when a frame has shown the change");
  command->add_option("--timeout", asked->timeout, "Seconds to wait for that frame")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command->callback([asked, &exit_code] { exit_code = set(*asked); });
}

} // namespace cupola::cli
