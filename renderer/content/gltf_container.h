// Bytes of a glTF file: the GLB container, and what URIs lead to. Private to the glTF reader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/content/gltf_report.h"

namespace cupola::content::gltf {

struct Container {
  std::string json;
  bool binary = false; ///< a chunk of binary data stands beside the JSON
  std::vector<std::uint8_t> bytes;
};

inline constexpr std::uint64_t largest_file =
    0x7fffffff; ///< bytes; positions in a file are 31 bit everywhere

/// Reads .gltf text or a .glb container (told by its first bytes); false after a problem.
[[nodiscard]] bool read_container(const std::filesystem::path& file, Container& out, Report& report);

/// The bytes that a URI of the file names: data in base64, or a file below `folder`. Absolute paths, other
/// schemes and ways out of the folder are problems at `pointer`; so is what cannot be read. false after a
/// problem.
[[nodiscard]] bool read_uri(std::string_view uri, const std::filesystem::path& folder,
                            const std::string& pointer, std::vector<std::uint8_t>& out, Report& report);

} // namespace cupola::content::gltf
