// The HTTP door: routes.h says what it answers, listener.h how it guards itself.
#pragma once

#include <memory>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "server/control/http/listener.h"
#include "server/control/http/routes.h"
#include "server/control/loop.h"
#include "server/state/live_state.h"

namespace cupola::control {

class HttpServer {
public:
  /// `loop` and `live` must outlive the server. Answers that are still under way when it ends are dropped.
  [[nodiscard]] static model::Result<std::unique_ptr<HttpServer>> open(Loop& loop, state::LiveState& live,
                                                                       const model::HttpListener& where,
                                                                       Services services,
                                                                       const Limits& limits = {});

  [[nodiscard]] int port() const { return listener_->port(); }

private:
  HttpServer() = default;
  std::unique_ptr<Routes> routes_;
  std::unique_ptr<Listener> listener_; ///< ends first
};

} // namespace cupola::control
