// HTTP/1.1 over TCP: reads requests within bounds, hands them on, writes the answers. Knows no address.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "configs/model/problem.h"
#include "server/control/http/message.h"
#include "server/control/loop.h"

namespace cupola::control {

struct Limits {
  std::size_t connections = 128; ///< one more closes the longest idle one, or is refused with 503
  std::size_t header_bytes = 16 * 1024;
  std::size_t body_bytes = 1024 * 1024;
  std::chrono::milliseconds idle{30'000};   ///< between requests of a kept-alive connection
  std::chrono::milliseconds header{10'000}; ///< for a whole header, however slowly it drips
  std::chrono::milliseconds body{20'000};   ///< for a whole body
  std::chrono::milliseconds write{30'000};  ///< for a whole answer
};

struct ListenerCore; ///< shared with the connections

class Listener {
public:
  /// Fails with CTL-104 when the address is not one of this machine or the port is taken. `handler` is called
  /// on the thread "control".
  [[nodiscard]] static model::Result<std::unique_ptr<Listener>>
  open(Loop& loop, const std::string& address, int port, const Limits& limits, Handler handler);
  ~Listener(); ///< closes all connections; the handler is not called any more. Not from the thread "control".
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] int port() const; ///< the one that the system chose, where 0 was asked for

private:
  Listener(Loop& loop, std::shared_ptr<ListenerCore> core);
  Loop& loop_;
  std::shared_ptr<ListenerCore> core_;
};

} // namespace cupola::control
