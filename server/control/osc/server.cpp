// liblo reads and writes the messages; the socket is ours, because liblo would listen on every address of the
// machine and answer from another port.
#include "server/control/osc/server.h"

#include <array>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <spdlog/spdlog.h>
#include <utility>

#include "server/control/osc/packet.h"
#include "server/control/osc/values.h"
#include "server/state/log_budget.h"

namespace cupola::control {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

/// Thread "control".
struct OscCore : std::enable_shared_from_this<OscCore> {
  OscCore(asio::io_context& given, state::LiveState& state)
      : context(given)
      , live(&state)
      , socket(given) {}

  void receive();
  void take(std::string_view packet, const udp::endpoint& sender);
  void refuse(const model::Problems& problems, const std::string& address, const udp::endpoint& sender);
  void send(const OscMessage& message, const udp::endpoint& receiver);

  asio::io_context& context;
  state::LiveState* live; ///< nullptr when closed
  udp::socket socket;
  udp::endpoint sender;
  std::array<char, 65'536> buffer{};
  state::LogBudget logged{20};
  state::LogBudget answered{200}; ///< a flood of nonsense is not answered by a flood of problems
};

namespace {

std::string origin_of(const udp::endpoint& sender) {
  return "osc " + sender.address().to_string() + ':' + std::to_string(sender.port());
}

} // namespace

void OscCore::receive() {
  socket.async_receive_from(asio::buffer(buffer), sender,
                            [self = shared_from_this()](error_code error, std::size_t size) {
                              if (!self->live || error == asio::error::operation_aborted) return;
                              // Other errors are about answers that nobody wanted: they pass.
                              if (!error) self->take({self->buffer.data(), size}, self->sender);
                              self->receive();
                            });
}

void OscCore::send(const OscMessage& message, const udp::endpoint& receiver) {
  const std::string bytes = to_packet(message);
  error_code ignored; // nobody there, or no room: the next one may arrive
  socket.send_to(asio::buffer(bytes), receiver, 0, ignored);
}

void OscCore::refuse(const model::Problems& problems, const std::string& address, const udp::endpoint& to) {
  if (!answered.admit(state::LogBudget::Clock::now())) return;
  for (std::size_t i = 0; i < problems.size() && i < 8; ++i) {
    const std::string& pointer = problems[i].pointer.empty() ? address : problems[i].pointer;
    send({"/cupola/problem",
          {{'s', 0.0, 0, pointer},
           {'s', 0.0, 0, std::string(model::code_id(problems[i].code))},
           {'s', 0.0, 0, model::to_text(problems[i])}}},
         to);
  }
}

void OscCore::take(std::string_view packet, const udp::endpoint& from) {
  const auto now = live->current();
  const auto messages = parse_packet(packet);
  model::Problems problems;
  std::string first;
  model::Change change{origin_of(from), std::nullopt, {}};
  std::vector<OscMessage> replies;
  if (!messages) problems = messages.error();
  for (const OscMessage& message : messages ? *messages : std::vector<OscMessage>{}) {
    if (first.empty()) first = message.address;
    const auto gather = [&](auto result, auto& into) {
      if (result)
        into.push_back(std::move(*result));
      else
        problems.insert(problems.end(), result.error().begin(), result.error().end());
    };
    if (message.arguments.empty())
      gather(to_reply(*now, message.address), replies);
    else
      gather(to_edit(*now, message), change.edits);
  }
  if (!problems.empty()) {
    if (const auto missed = logged.admit(state::LogBudget::Clock::now())) {
      if (*missed > 0) spdlog::warn("osc: {} more refused packets were not logged", *missed);
      spdlog::warn("{}: refused: {}", change.origin, model::to_text(problems.front()));
    }
    return refuse(problems, first, from);
  }
  for (const OscMessage& reply : replies) send(reply, from);
  if (change.edits.empty()) return;
  live->submit(std::move(change),
               [weak = weak_from_this(), &loop = context, first, from](const state::Answer& answer) {
                 if (answer) return;
                 asio::post(loop, [weak, problems = answer.error(), first, from] {
                   const auto self = weak.lock();
                   if (self && self->live) self->refuse(problems, first, from);
                 });
               });
}

model::Result<std::unique_ptr<OscServer>> OscServer::open(Loop& loop, state::LiveState& live,
                                                          const model::OscListener& where) {
  auto core = std::make_shared<OscCore>(loop.context(), live);
  error_code error;
  const auto ip = asio::ip::make_address(where.address == "localhost" ? "127.0.0.1" : where.address, error);
  if (!error) {
    const udp::endpoint endpoint(ip, static_cast<std::uint16_t>(where.port));
    core->socket.open(endpoint.protocol(), error);
    if (!error) core->socket.bind(endpoint, error);
    if (!error) core->socket.non_blocking(true, error);
  }
  if (error)
    return model::failure({model::Code::listener_failed,
                           "/control/osc",
                           "to listen on " + where.address + " port " + std::to_string(where.port),
                           error.message(),
                           "Is another program listening? Choose another port in the show.",
                           {}});
  error_code ignored; // a wish: bursts of a lighting desk
  core->socket.set_option(udp::socket::receive_buffer_size(1 << 20), ignored);
  const int port = core->socket.local_endpoint(ignored).port();
  asio::post(loop.context(), [core] { core->receive(); });
  spdlog::info("osc: listening on {} port {}", where.address, port);
  return std::unique_ptr<OscServer>(new OscServer(loop, std::move(core)));
}

OscServer::OscServer(Loop& loop, std::shared_ptr<OscCore> core)
    : loop_(loop)
    , core_(std::move(core)) {}

OscServer::~OscServer() {
  loop_.run_and_wait([this] {
    core_->live = nullptr;
    error_code ignored;
    core_->socket.close(ignored);
  });
}

int OscServer::port() const {
  error_code ignored;
  return core_->socket.local_endpoint(ignored).port();
}

} // namespace cupola::control
