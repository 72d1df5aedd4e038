#include "server/control/osc/packet.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <lo/lo.h>
#include <memory>
#include <type_traits>

namespace cupola::control {

namespace {

constexpr int deepest = 8;
constexpr std::size_t most_messages = 4096;
constexpr std::string_view bundle_mark{"#bundle\0", 8};

struct FreeMessage {
  void operator()(lo_message message) const { lo_message_free(message); }
};
using MessagePtr = std::unique_ptr<std::remove_pointer_t<lo_message>, FreeMessage>;

tl::unexpected<model::Problems> malformed(std::string expected, std::string found) {
  return model::failure({model::Code::bad_request, "", std::move(expected), std::move(found), {}, {}});
}

/// 0.1f is 0.100000001490116…; who sent it meant 0.1.
double shortest(float value) {
  if (!std::isfinite(value)) return value;
  std::array<char, 64> digits{};
  const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  double out = value;
  std::from_chars(digits.data(), written.ptr, out);
  return out;
}

/// The library lays its values at multiples of 4 bytes, whatever their type wants.
template <class T>
T read(const void* at) {
  T out;
  std::memcpy(&out, at, sizeof out);
  return out;
}

OscArgument to_argument(char type, const void* at) {
  OscArgument out{type, 0.0, 0, {}};
  switch (type) {
  case 'i':
    out.integer = read<std::int32_t>(at);
    out.number = static_cast<double>(out.integer);
    break;
  case 'h':
    out.integer = read<std::int64_t>(at);
    out.number = static_cast<double>(out.integer);
    break;
  case 'f':
    out.number = shortest(read<float>(at));
    break;
  case 'd':
    out.number = read<double>(at);
    break;
  case 's':
  case 'S':
    out.text = static_cast<const char*>(at);
    break;
  default:
    break;
  }
  return out;
}

/// Address and type tags are strings padded with NULs to four bytes; the library trusts their ends.
bool has_tags(std::string_view bytes) {
  const std::size_t end = bytes.find('\0');
  if (end == std::string_view::npos) return false;
  const std::size_t tags = (end / 4 + 1) * 4;
  return tags < bytes.size() && bytes[tags] == ',' && bytes.find('\0', tags) != std::string_view::npos;
}

model::Result<OscMessage> parse_message(std::string_view bytes) {
  if (bytes.empty() || bytes.size() % 4 != 0)
    return malformed("a message whose length is a multiple of 4", std::to_string(bytes.size()) + " bytes");
  if (bytes.front() != '/') return malformed("an address that begins with '/'", "another byte");
  if (!has_tags(bytes)) return malformed("an address and a type tag, each ended by NUL", "none");
  std::string copy(bytes); // the library wants to write into it
  int error = 0;
  const MessagePtr message(lo_message_deserialise(copy.data(), copy.size(), &error));
  if (!message)
    return malformed("an OSC message", "one whose parts do not fit (" + std::to_string(error) + ")");
  OscMessage out;
  out.address = copy.c_str();
  const char* types = lo_message_get_types(message.get());
  lo_arg** values = lo_message_get_argv(message.get());
  for (int i = 0; i < lo_message_get_argc(message.get()); ++i)
    out.arguments.push_back(to_argument(types[i], values[i]));
  return out;
}

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t out = 0;
  for (const char c : bytes.substr(0, 4)) out = out << 8 | static_cast<unsigned char>(c);
  return out;
}

model::Result<void> collect(std::string_view bytes, int depth, std::vector<OscMessage>& out) {
  if (!bytes.starts_with(bundle_mark)) {
    auto message = parse_message(bytes);
    if (!message) return tl::unexpected(std::move(message.error()));
    if (out.size() == most_messages) return malformed("at most 4096 messages in a packet", "more");
    out.push_back(std::move(*message));
    return {};
  }
  if (depth == deepest) return malformed("bundles nested at most 8 deep", "deeper ones");
  if (bytes.size() < 16) return malformed("a bundle with a time tag", "a shorter one");
  bytes.remove_prefix(16);
  while (!bytes.empty()) {
    if (bytes.size() < 4) return malformed("the size of a bundle's element", "the end of the packet");
    const std::uint32_t size = big_endian(bytes);
    bytes.remove_prefix(4);
    if (size > bytes.size() || size == 0)
      return malformed("an element within its bundle", "one of " + std::to_string(size) + " bytes");
    auto inner = collect(bytes.substr(0, size), depth + 1, out);
    if (!inner) return inner;
    bytes.remove_prefix(size);
  }
  return {};
}

} // namespace

model::Result<std::vector<OscMessage>> parse_packet(std::string_view packet) {
  std::vector<OscMessage> out;
  if (auto done = collect(packet, 0, out); !done) return tl::unexpected(std::move(done.error()));
  return out;
}

std::string to_packet(const OscMessage& message) {
  const MessagePtr made(lo_message_new());
  for (const OscArgument& argument : message.arguments) {
    switch (argument.type) {
    case 'i':
      lo_message_add_int32(made.get(), static_cast<std::int32_t>(argument.integer));
      break;
    case 'f':
      lo_message_add_float(made.get(), static_cast<float>(argument.number));
      break;
    case 'd':
      lo_message_add_double(made.get(), argument.number);
      break;
    case 's':
      lo_message_add_string(made.get(), argument.text.c_str());
      break;
    case 'T':
      lo_message_add_true(made.get());
      break;
    case 'F':
      lo_message_add_false(made.get());
      break;
    default:
      lo_message_add_nil(made.get());
    }
  }
  std::string out(lo_message_length(made.get(), message.address.c_str()), '\0');
  lo_message_serialise(made.get(), message.address.c_str(), out.data(), nullptr);
  return out;
}

} // namespace cupola::control
