#include "server/control/http/listener.h"

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/version.hpp>
#include <list>
#include <nlohmann/json.hpp>
#include <optional>
#include <spdlog/spdlog.h>
#include <utility>

#include "server/control/problem_json.h"

namespace cupola::control {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using beast::error_code;

class Session;

namespace {

Response failed(int status, std::string expected, std::string found) {
  const auto code = status == 503 ? model::Code::overloaded : model::Code::bad_request;
  const model::Problem problem{code, "", std::move(expected), std::move(found), {}, {}};
  return {status,
          "application/json",
          model::Json{{"problems", problems_json({problem})}}.dump(-1, ' ', false,
                                                                   model::Json::error_handler_t::replace) +
              '\n',
          {}};
}

} // namespace

/// Everything below runs on the thread "control".
struct ListenerCore : std::enable_shared_from_this<ListenerCore> {
  ListenerCore(asio::io_context& given, Limits bounds, Handler handle)
      : context(given)
      , limits(bounds)
      , handler(std::move(handle))
      , acceptor(given)
      , pause(given) {}

  void accept();
  void admit(tcp::socket socket);
  void close();

  asio::io_context& context;
  const Limits limits;
  Handler handler; ///< empty when closed
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  int port = 0;
  std::list<std::weak_ptr<Session>> sessions; ///< in order of arrival at the state they are in
  std::size_t refusing = 0;                   ///< connections that are being told 503
};

/// One connection. Kept alive by the operation that it waits for.
class Session : public std::enable_shared_from_this<Session> {
public:
  Session(tcp::socket socket, std::shared_ptr<ListenerCore> core)
      : stream_(std::move(socket))
      , core_(std::move(core)) {
    error_code ignored;
    stream_.socket().set_option(tcp::no_delay(true), ignored);
    const auto peer = stream_.socket().remote_endpoint(ignored);
    peer_ = peer.address().to_string() + ':' + std::to_string(peer.port());
  }
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start() {
    counted_ = core_->sessions.insert(core_->sessions.end(), weak_from_this());
    wait_for_request();
  }
  void refuse() {
    ++core_->refusing;
    refused_ = true;
    close_after_ = true;
    Response response =
        failed(503, "at most " + std::to_string(core_->limits.connections) + " connections", "one more");
    response.header_lines.emplace_back("Retry-After", "1");
    write(std::move(response));
  }
  [[nodiscard]] bool idle() const { return idle_; }
  void close() {
    idle_ = false;
    error_code ignored;
    stream_.socket().close(ignored);
  }

private:
  using Self = std::shared_ptr<Session>;
  class Ticket;

  void wait_for_request();
  void read_header();
  void on_header(error_code error);
  void read_body();
  void on_request(error_code error);
  void write(Response response);
  void after_write(error_code error);
  void linger();
  void fail(error_code error);

  beast::tcp_stream stream_;
  std::shared_ptr<ListenerCore> core_;
  std::optional<std::list<std::weak_ptr<Session>>::iterator> counted_;
  std::string peer_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::string_body>> answer_;
  std::optional<http::response<http::empty_body>> answer_head_;
  std::array<char, 4096> waste_{};
  std::size_t wasted_ = 0;
  bool idle_ = false, close_after_ = false, unread_ = false, refused_ = false, head_ = false;
  unsigned version_ = 11;
};

/// The right to answer a request, on whatever thread; the connection itself stays with the thread "control".
class Session::Ticket {
public:
  explicit Ticket(Self session)
      : context_(session->core_->context)
      , session_(std::move(session)) {}
  ~Ticket() {
    asio::post(context_, [session = std::move(session_)] {}); // given up there
  }
  Ticket(const Ticket&) = delete;
  Ticket& operator=(const Ticket&) = delete;

  void answer(Response response) const {
    asio::post(context_, [session = session_, response = std::move(response)]() mutable {
      if (session->core_->handler) session->write(std::move(response));
    });
  }

private:
  asio::io_context& context_;
  Self session_;
};

Session::~Session() {
  if (counted_) core_->sessions.erase(*counted_);
  if (refused_) --core_->refusing;
}

void Session::wait_for_request() {
  if (buffer_.size() > 0) return read_header(); // the next of several requests sent at once
  idle_ = true;
  // Those longest idle stand first: they are closed when others need the room.
  core_->sessions.splice(core_->sessions.end(), core_->sessions, *counted_);
  stream_.expires_after(core_->limits.idle);
  stream_.async_read_some(buffer_.prepare(4096),
                          [self = shared_from_this()](error_code error, std::size_t n) {
                            if (error) return;
                            self->buffer_.commit(n);
                            self->read_header();
                          });
}

void Session::read_header() {
  idle_ = false;
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(core_->limits.header_bytes));
  parser_->body_limit(core_->limits.body_bytes);
  stream_.expires_after(core_->limits.header);
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](error_code error, std::size_t) { self->on_header(error); });
}

void Session::on_header(error_code error) {
  if (error) return fail(error);
  const auto& header = parser_->get();
  version_ = header.version();
  head_ = header.method() == http::verb::head;
  if (version_ >= 11 && header.count(http::field::host) != 1) {
    unread_ = close_after_ = true;
    return write(failed(400, "one Host header line", std::to_string(header.count(http::field::host))));
  }
  if (!beast::iequals(header[http::field::expect], "100-continue") || version_ < 11) return read_body();
  static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
  stream_.expires_after(core_->limits.body);
  asio::async_write(stream_, asio::buffer(go_on),
                    [self = shared_from_this()](error_code failed_write, std::size_t) {
                      if (!failed_write) self->read_body();
                    });
}

void Session::read_body() {
  stream_.expires_after(core_->limits.body);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](error_code error, std::size_t) { self->on_request(error); });
}

void Session::on_request(error_code error) {
  if (error) return fail(error);
  stream_.expires_never();
  auto message = parser_->release();
  close_after_ = !message.keep_alive();
  Request request;
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  request.peer = peer_;
  for (const auto& field : message) {
    std::string name(field.name_string());
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    request.header_lines.emplace_back(std::move(name), std::string(field.value()));
  }
  request.body = std::move(message.body());
  if (!core_->handler) return;
  core_->handler(std::move(request), [ticket = std::make_shared<Ticket>(shared_from_this())](
                                         Response response) { ticket->answer(std::move(response)); });
}

/// A request that cannot be read is answered where an answer can still be sent; the connection ends.
void Session::fail(error_code error) {
  unread_ = close_after_ = true;
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return write(failed(431, "a header of at most " + std::to_string(core_->limits.header_bytes) + " bytes",
                        "a longer one"));
  if (error == http::error::body_limit)
    return write(failed(413, "a body of at most " + std::to_string(core_->limits.body_bytes) + " bytes",
                        "a larger one"));
  const bool silent = error == http::error::end_of_stream || error == http::error::partial_message ||
                      error.category() != http::make_error_code(http::error::bad_method).category();
  if (silent) return; // closed, timed out, or reset: nobody listens
  write(failed(400, "an HTTP/1.1 request", error.message()));
}

void Session::write(Response response) {
  const auto fill = [&](auto& answer) {
    answer.version(version_);
    answer.result(static_cast<unsigned>(response.status));
    answer.set(http::field::server, "cupola");
    answer.set(http::field::cache_control, "no-store");
    answer.set("X-Content-Type-Options", "nosniff");
    if (!response.content_type.empty()) answer.set(http::field::content_type, response.content_type);
    for (const auto& [name, value] : response.header_lines) answer.set(name, value);
    answer.keep_alive(!close_after_);
    if (response.status != 204 && response.status != 304) answer.content_length(response.body.size());
  };
  const auto done = [self = shared_from_this()](error_code error, std::size_t) { self->after_write(error); };
  stream_.expires_after(core_->limits.write);
  if (head_ || response.status == 204 || response.status == 304) {
    answer_head_.emplace();
    fill(*answer_head_);
    http::async_write(stream_, *answer_head_, done);
  } else {
    answer_.emplace();
    fill(*answer_);
    answer_->body() = std::move(response.body);
    http::async_write(stream_, *answer_, done);
  }
}

void Session::after_write(error_code error) {
  answer_.reset();
  answer_head_.reset();
  parser_.reset();
  if (error) return;
  if (!close_after_) return wait_for_request();
  error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.expires_after(std::chrono::seconds(2));
  linger();
}

/// Reads what the client still sends, within bounds: closing at once would reset the connection, and the
/// answer might never be read.
void Session::linger() {
  stream_.async_read_some(asio::buffer(waste_), [self = shared_from_this()](error_code error, std::size_t n) {
    self->wasted_ += n;
    if (!error && self->wasted_ < 8 * self->core_->limits.body_bytes) self->linger();
  });
}

void ListenerCore::accept() {
  acceptor.async_accept([self = shared_from_this()](error_code error, tcp::socket socket) {
    if (!self->handler) return;
    if (!error) {
      self->admit(std::move(socket));
      return self->accept();
    }
    if (error == asio::error::operation_aborted) return;
    // Out of descriptors, most likely: try again when some may be free.
    self->pause.expires_after(std::chrono::milliseconds(100));
    self->pause.async_wait([self](error_code stopped) {
      if (!stopped && self->handler) self->accept();
    });
  });
}

void ListenerCore::admit(tcp::socket socket) {
  if (sessions.size() < limits.connections) {
    std::make_shared<Session>(std::move(socket), shared_from_this())->start();
    return;
  }
  for (const std::weak_ptr<Session>& one : sessions)
    if (const auto session = one.lock(); session && session->idle()) {
      session->close();
      std::make_shared<Session>(std::move(socket), shared_from_this())->start();
      return;
    }
  if (refusing < limits.connections)
    std::make_shared<Session>(std::move(socket), shared_from_this())->refuse();
}

void ListenerCore::close() {
  handler = nullptr;
  error_code ignored;
  acceptor.close(ignored);
  pause.cancel();
  std::vector<std::shared_ptr<Session>> all;
  for (const std::weak_ptr<Session>& one : sessions)
    if (auto session = one.lock()) all.push_back(std::move(session));
  for (const auto& session : all) session->close();
}

model::Result<std::unique_ptr<Listener>> Listener::open(Loop& loop, const std::string& address, int port,
                                                        const Limits& limits, Handler handler) {
  auto core = std::make_shared<ListenerCore>(loop.context(), limits, std::move(handler));
  error_code error;
  const auto ip = asio::ip::make_address(address == "localhost" ? "127.0.0.1" : address, error);
  if (!error) {
    const tcp::endpoint endpoint(ip, static_cast<std::uint16_t>(port));
    core->acceptor.open(endpoint.protocol(), error);
    if (!error) core->acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) core->acceptor.bind(endpoint, error);
    if (!error) core->acceptor.listen(tcp::acceptor::max_listen_connections, error);
  }
  if (error)
    return model::failure({model::Code::listener_failed,
                           "/control/http",
                           "to listen on " + address + " port " + std::to_string(port),
                           error.message(),
                           "Is another cupolad running? Choose another port in the show.",
                           {}});
  core->port = core->acceptor.local_endpoint(error).port();
  asio::post(loop.context(), [core] { core->accept(); });
  return std::unique_ptr<Listener>(new Listener(loop, std::move(core)));
}

Listener::Listener(Loop& loop, std::shared_ptr<ListenerCore> core)
    : loop_(loop)
    , core_(std::move(core)) {}

Listener::~Listener() {
  loop_.run_and_wait([this] { core_->close(); });
}

int Listener::port() const { return core_->port; }

} // namespace cupola::control
