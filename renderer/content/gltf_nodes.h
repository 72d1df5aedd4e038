// Node tree, skins and animation of a glTF file. Private to the glTF reader.
#pragma once

#include <string>
#include <vector>

#include "renderer/content/gltf_document.h"
#include "renderer/content/rig.h"

namespace cupola::content::gltf {

/// Nodes with their parents, in an order with parents first; several parents and cycles are problems.
void read_nodes(const Document& document, Rig& rig, Report& report);

void read_skins(const Document& document, Rig& rig, Report& report);

/// The channels of the animation called `name` ("": the first, if any). Needs the nodes.
void read_animation(const Document& document, const std::string& name, Rig& rig, Report& report);

/// shown[n]: the node is part of the scene that the file opens with.
[[nodiscard]] std::vector<bool> shown_nodes(const Document& document, const Rig& rig, Report& report);

/// moves[n]: the node's place changes with time.
[[nodiscard]] std::vector<bool> moving_nodes(const Rig& rig);

} // namespace cupola::content::gltf
