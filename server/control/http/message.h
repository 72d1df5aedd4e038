// An HTTP request and its answer as plain values: what the routes see, without the library that reads them.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cupola::control {

struct Request {
  std::string method;                                            ///< as sent, "GET"
  std::string target;                                            ///< path and query, percent-encoded as sent
  std::string body;                                              ///< whole
  std::string peer;                                              ///< "127.0.0.1:4711"
  std::vector<std::pair<std::string, std::string>> header_lines; ///< names in lower case

  /// The value of a header line, "" where it is absent.
  [[nodiscard]] const std::string& header(std::string_view lower_case_name) const {
    static const std::string none;
    for (const auto& [name, value] : header_lines)
      if (name == lower_case_name) return value;
    return none;
  }
};

struct Response {
  int status = 200;
  std::string content_type; ///< "" for no content
  std::string body;
  std::vector<std::pair<std::string, std::string>> header_lines;
};

/// Called once, from any thread; the session hands it to its own.
using Respond = std::function<void(Response)>;
using Handler = std::function<void(Request, Respond)>;

} // namespace cupola::control
