// A small HTTP client for the command line. Blocking, any thread.
#pragma once

#include <chrono>
#include <string>

#include "configs/model/problem.h"

namespace cupola::control {

/// Where a daemon listens, from "http://HOST[:PORT]", "HOST:PORT", "[::1]:PORT" or "HOST"; the port is 8750
/// unless given. Other schemes, paths and queries are refused (CTL-101).
struct Url {
  std::string host;
  std::string port = "8750";
};
[[nodiscard]] model::Result<Url> parse_url(const std::string& text);

struct Reply {
  int status = 0;
  std::string body;
};

/// One request; `body` is sent as JSON where it is not empty. CTL-105 when there is no answer within
/// `timeout` for each step: connecting, sending, waiting for the answer.
[[nodiscard]] model::Result<Reply> request(const Url& url, const std::string& method,
                                           const std::string& target, const std::string& body,
                                           std::chrono::milliseconds timeout);

} // namespace cupola::control
