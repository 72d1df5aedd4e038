// What each HTTP address means. No sockets here.
//
//   GET    /                           the live page
//   GET    /api/v1/status              {version, revision, uptime, …}, with what Services::status adds
//   GET    /api/v1/show                the whole document; ETag is the revision; If-None-Match
//   GET    /api/v1/show/PATH           one value
//   PATCH  /api/v1/show                RFC 7396; If-Match; ?wait=shown[&timeout=SECONDS]
//   PUT    /api/v1/show/PATH           one value, replaced; If-Match; ?wait=shown
//   DELETE /api/v1/show/PATH           an entry goes, a value returns to its default
//   GET    /api/v1/parameters          every leaf: path, value, kind, unit, range, choices, cost, text
//   GET    /api/v1/schema              the JSON Schema of a show
//   GET    /api/v1/outputs             the outputs and where their pictures are
//   GET    /api/v1/outputs/NAME.png    a live picture, also .jpg; ?width=PIXELS scales it down
//
// Changes answer {revision, cost, changes, warnings}, with wait=shown also {frame}: 200, or 202 and frame
// null when no frame showed it in time. Every error is {problems: […]}: 400 malformed, 403 a foreign page,
// 404, 405, 412 the show has moved on, 415, 422 refused by the show's rules, 503 overloaded.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "configs/model/change.h"
#include "server/control/http/message.h"
#include "server/control/http/pictures.h"
#include "server/state/live_state.h"

namespace cupola::control {

/// What the routes get from the daemon.
struct Services {
  std::string version; ///< of the program
  /// Members to add to the status: device, fps, late_frames, outputs {NAME: {frames, …}}, problems […].
  /// Thread "control": must be quick, must not throw. Absent: nothing is added.
  std::function<model::Json()> status;
  SnapshotSource snapshot;                    ///< absent: pictures answer 503
  model::Json schema = model::Json::object(); ///< loader::show_schema()
  std::chrono::milliseconds picture_patience{5000};
};

class Routes {
public:
  /// `live` must outlive this and all answers under way.
  Routes(state::LiveState& live, Services services);
  ~Routes();
  Routes(const Routes&) = delete;
  Routes& operator=(const Routes&) = delete;

  /// Thread "control". Answers exactly once, at once or later from another thread; never throws.
  void handle(const Request& request, const Respond& respond);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cupola::control
