// Small glTF files made up by tests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/content/scene.h"

namespace cupola::content {

using Json = nlohmann::json;

class GltfFile {
public:
  GltfFile();

  Json json; ///< without buffers, which writing adds

  /// Accessors of tightly packed numbers; the index. type: "VEC3", …
  int floats(const std::vector<float>& values, const char* type);
  int bytes(const std::vector<std::uint8_t>& values, const char* type, bool normalized = false);
  int shorts(const std::vector<std::uint16_t>& values, const char* type, bool normalized = false);
  int words(const std::vector<std::uint32_t>& values, const char* type);
  /// A view of raw bytes; the index.
  int view(const void* data, std::size_t size);

  /// Appends to a list of the document; the index.
  int add(const char* list, Json item);
  /// A mesh of one primitive, shown by one node of the scene; the node's index.
  int show(Json primitive, Json node = Json::object());

  /// Writes text with the buffer as a data URI, or a binary container, into the tests' folder.
  [[nodiscard]] std::filesystem::path write(const std::string& name) const;
  [[nodiscard]] std::vector<std::uint8_t> glb() const;

private:
  int accessor(const void* data, std::size_t size, int component, std::size_t bytes, std::size_t count,
               const char* type, bool normalized);
  std::vector<std::uint8_t> buffer_;
};

/// The folder that tests write to.
[[nodiscard]] std::filesystem::path gltf_folder();
std::filesystem::path write_bytes(const std::string& name, const std::vector<std::uint8_t>& bytes);
[[nodiscard]] std::string base64(const std::vector<std::uint8_t>& bytes);
/// An RGB picture of one row as PNG.
[[nodiscard]] std::vector<std::uint8_t> png(const std::vector<std::uint8_t>& rgb);

[[nodiscard]] model::Result<LoadedScene> load(const std::filesystem::path& file,
                                              const std::string& animation = {}, double scale = 1.0);
[[nodiscard]] model::Result<LoadedScene> load(const GltfFile& file, const std::string& animation = {},
                                              double scale = 1.0);

} // namespace cupola::content
