// Where log lines go and how they look.
#pragma once

#include <string>

#include "configs/model/problem.h"
#include "renderer/outputs/context.h"

namespace cupola::daemon {

/// Lines to standard error: "2026-01-31T12:00:00.000 warning render: …", with a priority for the journal
/// instead of the time when it listens; or one JSON object a line with time, level, thread and message.
/// `level`: trace, debug, info, warning, error or off.
void set_up_log(bool json, const std::string& level);

/// One line for each.
void log_problems(const model::Problems& problems);

/// Sink for drivers and outputs.
[[nodiscard]] outputs::Messages messages_to_log();

} // namespace cupola::daemon
