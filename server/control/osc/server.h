// The OSC door: any live parameter by its path, over UDP.
//
//   /projections/wall/horizontal_fov f 120    sets; values.h says which arguments a parameter takes
//   /projections/wall/horizontal_fov          without arguments: is answered with the value
//   a bundle                                  is one change, accepted or refused as a whole
//
// What is refused alters nothing, is logged, and is answered with /cupola/problem: address, code, text (sss).
#pragma once

#include <memory>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "server/control/loop.h"
#include "server/state/live_state.h"

namespace cupola::control {

struct OscCore;

class OscServer {
public:
  /// `loop` and `live` must outlive the server. Fails with CTL-104 when the socket cannot be bound.
  [[nodiscard]] static model::Result<std::unique_ptr<OscServer>> open(Loop& loop, state::LiveState& live,
                                                                      const model::OscListener& where);
  ~OscServer(); ///< not from the thread "control"
  OscServer(const OscServer&) = delete;
  OscServer& operator=(const OscServer&) = delete;

  [[nodiscard]] int port() const; ///< the one that the system chose, where 0 was asked for

private:
  OscServer(Loop& loop, std::shared_ptr<OscCore> core);
  Loop& loop_;
  std::shared_ptr<OscCore> core_; ///< shared with what its socket waits for
};

} // namespace cupola::control
