#include "server/control/http/server.h"

#include <spdlog/spdlog.h>
#include <utility>

namespace cupola::control {

model::Result<std::unique_ptr<HttpServer>> HttpServer::open(Loop& loop, state::LiveState& live,
                                                            const model::HttpListener& where,
                                                            Services services, const Limits& limits) {
  std::unique_ptr<HttpServer> server(new HttpServer);
  server->routes_ = std::make_unique<Routes>(live, std::move(services));
  auto listener =
      Listener::open(loop, where.address, where.port, limits,
                     [routes = server->routes_.get()](const Request& request, const Respond& respond) {
                       routes->handle(request, respond);
                     });
  if (!listener) return tl::unexpected(std::move(listener.error()));
  server->listener_ = std::move(*listener);
  spdlog::info("http: listening on {} port {}", where.address, server->port());
  return server;
}

} // namespace cupola::control
