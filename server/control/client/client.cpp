#include "server/control/client/client.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <exception>
#include <utility>

namespace cupola::control {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using beast::error_code;

namespace {

/// One exchange; each step starts the next and the first error ends it.
class Exchange {
public:
  Exchange(const Url& url, std::chrono::milliseconds timeout)
      : url_(url)
      , timeout_(timeout)
      , resolver_(context_)
      , stream_(context_) {}

  model::Result<Reply> run(http::request<http::string_body> request) {
    request_ = std::move(request);
    answer_.body_limit(64ULL << 20);
    resolver_.async_resolve(
        url_.host, url_.port, [this](error_code error, const tcp::resolver::results_type& found) {
          if (failed(error)) return;
          stream_.expires_after(timeout_);
          stream_.async_connect(found, [this](error_code connect_error, const tcp::endpoint&) {
            if (!failed(connect_error)) send();
          });
        });
    context_.run();
    if (error_)
      return model::failure({model::Code::unreachable,
                             "",
                             "cupolad at " + url_.host + " port " + url_.port,
                             error_.message(),
                             "Is it running, and does it listen there? See --url.",
                             {}});
    return Reply{static_cast<int>(answer_.get().result_int()), std::move(answer_.get().body())};
  }

private:
  bool failed(error_code error) {
    error_ = error;
    return static_cast<bool>(error);
  }
  void send() {
    stream_.expires_after(timeout_);
    http::async_write(stream_, request_, [this](error_code error, std::size_t) {
      if (failed(error)) return;
      stream_.expires_after(timeout_);
      http::async_read(stream_, buffer_, answer_, [this](error_code read_error, std::size_t) {
        failed(read_error);
        error_code ignored;
        stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
      });
    });
  }

  const Url& url_;
  std::chrono::milliseconds timeout_;
  asio::io_context context_{1};
  tcp::resolver resolver_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request<http::string_body> request_;
  http::response_parser<http::string_body> answer_;
  error_code error_;
};

} // namespace

model::Result<Url> parse_url(const std::string& text) {
  const auto wrong = [&] {
    return model::failure(
        {model::Code::bad_request, "", "an address such as http://127.0.0.1:8750", '"' + text + '"', {}, {}});
  };
  std::string_view rest = text;
  if (rest.starts_with("http://")) rest.remove_prefix(7);
  if (rest.ends_with('/')) rest.remove_suffix(1);
  Url url;
  const bool bracketed = rest.starts_with('[');
  const std::size_t host_end = bracketed ? rest.find(']') : std::min(rest.find(':'), rest.size());
  if (host_end == std::string_view::npos) return wrong();
  url.host = rest.substr(bracketed ? 1 : 0, host_end - (bracketed ? 1 : 0));
  rest.remove_prefix(host_end + (bracketed ? 1 : 0));
  if (url.host.empty() || url.host.find_first_of("/?#@ ") != std::string::npos) return wrong();
  if (rest.empty()) return url;
  unsigned port = 0;
  const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), port);
  if (rest.front() != ':' || error != std::errc{} || end != rest.data() + rest.size() || port == 0 ||
      port > 65535)
    return wrong();
  url.port = std::to_string(port);
  return url;
}

model::Result<Reply> request(const Url& url, const std::string& method, const std::string& target,
                             const std::string& body, std::chrono::milliseconds timeout) {
  try {
    http::request<http::string_body> made{http::string_to_verb(method), target, 11};
    made.set(http::field::host,
             (url.host.find(':') == std::string::npos ? url.host : '[' + url.host + ']') + ':' + url.port);
    made.set(http::field::user_agent, "cupola");
    made.set(http::field::connection, "close");
    if (!body.empty()) {
      made.set(http::field::content_type, "application/json");
      made.body() = body;
    }
    made.prepare_payload();
    return Exchange(url, timeout).run(std::move(made));
  } catch (const std::exception& error) {
    return model::failure({model::Code::unreachable, "", "cupolad at " + url.host, error.what(), {}, {}});
  }
}

} // namespace cupola::control
