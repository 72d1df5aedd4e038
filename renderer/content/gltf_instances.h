// Meshes that a node draws many times [EXT_mesh_gpu_instancing]. Private to the glTF reader.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/content/gltf_document.h"
#include "renderer/content/rig.h"

namespace cupola::content::gltf {

/// By node of the document: the nodes of the rig at which its mesh stands instead, empty where it stands at
/// the node alone. They are added to the rig, after all others, as children of the node. Needs the nodes.
[[nodiscard]] std::vector<std::vector<std::size_t>> read_instances(const Document& document, Rig& rig,
                                                                   Report& report);

} // namespace cupola::content::gltf
