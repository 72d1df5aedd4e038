// Images, textures, materials and lights of a glTF file. Private to the glTF reader.
#pragma once

#include <vector>

#include "renderer/content/gltf_document.h"
#include "renderer/content/scene.h"

namespace cupola::content::gltf {

/// Decodes what the materials use and appends it to the scene. sets[m]: the set of texture coordinates that
/// material m reads (a vertex carries one). The last material is glTF's default, for primitives without one.
void read_materials(const Document& document, Scene& scene, std::vector<int>& sets, Report& report);

/// PNG or JPEG bytes as 8 bit RGBA; false after a problem at `pointer`.
[[nodiscard]] bool decode_image(const std::vector<std::uint8_t>& bytes, const std::string& pointer,
                                Image& out, Report& report);

/// The lights that nodes refer to, at the origin and shining along -z, in the file's order.
[[nodiscard]] std::vector<Light> read_lights(const Document& document, Report& report);

} // namespace cupola::content::gltf
