// OSC packets as values. Pure, any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "configs/model/problem.h"

namespace cupola::control {

/// One argument of a message. `type` is OSC's tag; what the others hold follows from it.
struct OscArgument {
  char type = 'N';
  double number = 0.0;      ///< i h f d; a 32-bit float as its shortest decimal, so that 0.1 stays 0.1
  std::int64_t integer = 0; ///< i h
  std::string text{};       ///< s S
};

struct OscMessage {
  std::string address;
  std::vector<OscArgument> arguments;
};

/// All messages of a packet, those of nested bundles in their order. Time tags are read over: everything
/// takes effect at once. Fails with one problem (CTL-101) for whatever is not OSC 1.0: no type tag, lengths
/// that do not fit, bundles nested deeper than 8, more than 4096 messages.
[[nodiscard]] model::Result<std::vector<OscMessage>> parse_packet(std::string_view packet);

/// The bytes of a message.
[[nodiscard]] std::string to_packet(const OscMessage& message);

} // namespace cupola::control
