// Between OSC's arguments and the show's values. Pure, any thread.
#pragma once

#include <string>

#include "configs/model/change.h"
#include "configs/model/problem.h"
#include "server/control/osc/packet.h"
#include "server/state/live_state.h"

namespace cupola::control {

/// The edit that a message asks for: its address is the parameter's path.
/// - number: any of i h f d. Integer: the same, without a fraction. Both must be finite.
/// - boolean: T, F, or a number 0 or 1. Text and choice: s or S, in UTF-8.
/// - vector3: three numbers. What may be "auto": an integer, or the text auto.
/// - N (nil): an optional parameter becomes absent, any other returns to its default.
/// An address that this show does not know (yet: an earlier message of the bundle may bring it) is handed on
/// by the shape of its arguments. Ranges and choices are checked where the change is.
[[nodiscard]] model::Result<model::Edit> to_edit(const state::Snapshot& now, const OscMessage& message);

/// The answer to a message without arguments: the same address with the value; i, f, s, T or F, three f, or
/// N.
[[nodiscard]] model::Result<OscMessage> to_reply(const state::Snapshot& now, const std::string& address);

} // namespace cupola::control
