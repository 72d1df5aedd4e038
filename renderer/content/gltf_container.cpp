#include "renderer/content/gltf_container.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

namespace cupola::content::gltf {
namespace {

namespace fs = std::filesystem;
using model::Code;

/// Regular files only: a pipe would hang, a folder has no bytes.
template <class Bytes>
bool read_file(const fs::path& file, const std::string& pointer, Bytes& out, Report& report) {
  std::error_code failed;
  const auto status = fs::status(file, failed);
  if (failed || !fs::is_regular_file(status)) {
    report.error(Code::scene_unreadable, pointer, "a readable file",
                 fs::exists(status) ? "'" + file.string() + "', which is no regular file"
                                    : "no file '" + file.string() + "'");
    return false;
  }
  const std::uintmax_t size = fs::file_size(file, failed);
  if (!failed && size > largest_file) {
    report.error(Code::scene_limit, pointer, "at most 2 GiB", std::to_string(size) + " bytes");
    return false;
  }
  std::ifstream stream(file, std::ios::binary);
  if (!failed && stream) {
    out.resize(size);
    stream.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  }
  if (failed || !stream) {
    report.error(Code::scene_unreadable, pointer, "a readable file",
                 "'" + file.string() + "', which cannot be read");
    return false;
  }
  return true;
}

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[at + i])) << (8 * i);
  return value;
}

constexpr std::uint32_t chunk_json = 0x4e4f534a;
constexpr std::uint32_t chunk_bin = 0x004e4942;

bool split_glb(const std::string& file, Container& out, Report& report) {
  const auto broken = [&](const std::string& expected, const std::string& found) {
    report.error(Code::scene_unreadable, "", expected, found);
    return false;
  };
  if (file.size() < 12) return broken("a GLB header of 12 bytes", std::to_string(file.size()) + " bytes");
  if (word(file, 4) != 2) return broken("GLB version 2", "version " + std::to_string(word(file, 4)));
  const std::size_t length = word(file, 8);
  if (length > file.size())
    return broken("a GLB file of " + std::to_string(length) + " bytes, as its header says",
                  std::to_string(file.size()) + " bytes: it is cut off");
  std::size_t at = 12;
  for (int chunk = 0; at < length; ++chunk) {
    if (length - at < 8) return broken("a GLB chunk at byte " + std::to_string(at), "the end of the file");
    const std::size_t size = word(file, at);
    const std::uint32_t kind = word(file, at + 4);
    at += 8;
    if (size > length - at)
      return broken("a GLB chunk of " + std::to_string(size) + " bytes at byte " + std::to_string(at),
                    std::to_string(length - at) + " bytes to the end");
    if ((chunk == 0) != (kind == chunk_json))
      return broken("one JSON chunk, which is the first of the GLB file", "another kind of chunk there");
    if (chunk == 0) out.json.assign(file, at, size);
    if (chunk == 1 && kind == chunk_bin) {
      out.binary = true;
      out.bytes.assign(file.begin() + static_cast<std::ptrdiff_t>(at),
                       file.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    at += size;
  }
  return !out.json.empty() || broken("a JSON chunk in the GLB file", "none");
}

std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text) {
  static const std::array<int, 256> values = [] {
    std::array<int, 256> made{};
    made.fill(-1);
    const std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < letters.size(); ++i)
      made[static_cast<std::uint8_t>(letters[i])] = static_cast<int>(i);
    return made;
  }();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t held = 0;
  int bits = 0;
  for (const char letter : text) {
    const int value = values[static_cast<std::uint8_t>(letter)];
    if (value < 0) return std::nullopt;
    held = (held << 6 | static_cast<std::uint32_t>(value)) & 0xffffffU;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out.push_back(static_cast<std::uint8_t>(held >> bits & 255U));
  }
  return out;
}

std::string decode_percent(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
      out += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string shortened(std::string_view text) {
  return "'" + std::string(text.substr(0, 60)) + (text.size() > 60 ? "…'" : "'");
}

} // namespace

bool read_container(const fs::path& file, Container& out, Report& report) {
  std::string bytes;
  if (!read_file(file, "", bytes, report)) return false;
  if (bytes.starts_with("glTF")) return split_glb(bytes, out, report);
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);
  out.json = std::move(bytes);
  return true;
}

bool read_uri(std::string_view uri, const fs::path& folder, const std::string& pointer,
              std::vector<std::uint8_t>& out, Report& report) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    const bool base64 = comma != std::string_view::npos && uri.substr(0, comma).ends_with(";base64");
    auto decoded = base64 ? decode_base64(uri.substr(comma + 1)) : std::nullopt;
    if (!decoded) {
      report.error(Code::scene_unreadable, pointer, "data in base64", shortened(uri));
      return false;
    }
    out = std::move(*decoded);
    return true;
  }
  const std::string name = decode_percent(uri);
  const fs::path relative(name);
  const bool leaves =
      std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
  const std::size_t colon = name.find(':');
  const bool scheme = colon != std::string::npos && colon > 0 && name.find('/') > colon;
  if (name.empty() || relative.is_absolute() || leaves || scheme || name.find('\\') != std::string::npos ||
      name.find('\0') != std::string::npos) {
    report.error(Code::scene_unreadable, pointer, "a relative path inside the folder of the glTF file",
                 shortened(name));
    return false;
  }
  return read_file(folder / relative, pointer, out, report);
}

} // namespace cupola::content::gltf
