// The frame loop's state in words: for systemd, and as JSON for the network.
#pragma once

#include <string>

#include "configs/model/change.h"
#include "configs/model/problem.h"
#include "renderer/frame/loop.h"

namespace cupola::daemon {

/// "revision 3, 59.9 frames a second, 0 late, 4 outputs"
[[nodiscard]] std::string status_line(const frame::LoopStatus& status);

/// Members of GET /api/v1/status that the daemon knows. Rates a second, times in milliseconds.
[[nodiscard]] model::Json status_json(const frame::LoopStatus& status, const model::Problems& problems);

} // namespace cupola::daemon
