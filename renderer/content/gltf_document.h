// A glTF file in memory: tinygltf's structures, checked so that every index and every accessor can be
// followed without looking again. Private to the glTF reader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <tiny_gltf.h>
#include <vector>

#include "renderer/content/gltf_container.h"
#include "renderer/content/gltf_report.h"

namespace cupola::content::gltf {

struct ImageSource {
  std::string uri; ///< or "": then `view`
  int view = -1;
};

struct Document {
  tinygltf::Model model; ///< without buffers and images, which stand here:
  std::vector<std::vector<std::uint8_t>> buffers;
  std::vector<ImageSource> images;
  std::filesystem::path folder;
};

inline constexpr std::size_t most_elements =
    50'000'000; ///< of an accessor, and vertices or triangles of a scene

/// Parses and checks everything but what meshes contain; false after problems.
[[nodiscard]] bool read_document(Container& container, const std::filesystem::path& folder, Document& out,
                                 Report& report);

/// Checks JSON against the parts of glTF's schema that are used: types, required keys, indices in range, and
/// removes what tinygltf need not see. `json` is replaced by the cleaned text.
[[nodiscard]] bool check_json(std::string& json, Document& out, std::vector<std::string>& buffer_uris,
                              std::vector<std::uint64_t>& buffer_lengths, Report& report);

/// The accessor's numbers as floats (normalised integers as 0..1 or -1..1), `components` a piece.
struct Numbers {
  int components = 0;
  std::size_t count = 0;
  std::vector<float> values;
  [[nodiscard]] glm::vec3 vec3(std::size_t i) const {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }
};
/// Reads an accessor that read_document() has checked; nothing after a problem (a number that is not finite).
[[nodiscard]] std::optional<Numbers> read_numbers(const Document& document, int accessor, Report& report);
/// The same as whole numbers, without normalising; a problem when the accessor holds floats.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> read_integers(const Document& document, int accessor,
                                                                      Report& report);
/// Bounds, alignment and types of one accessor and its views.
void check_accessor(const Document& document, std::size_t index, Report& report);

} // namespace cupola::content::gltf
