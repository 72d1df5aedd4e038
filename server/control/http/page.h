// The live page, compiled in from server/panel/index.html.
#pragma once

#include <string>

#include "server/control/http/message.h"

namespace cupola::control {

/// The page with a fresh nonce, under a policy that lets it load nothing but this server's own answers.
[[nodiscard]] Response live_page();

} // namespace cupola::control
