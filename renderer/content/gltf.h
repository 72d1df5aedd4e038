// glTF 2.0 files as scenes.
#pragma once

#include <filesystem>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/content/scene.h"

namespace cupola::content {

/// Reads a .gltf or .glb file with everything it refers to. Problems carry the file in `at.file` and the
/// place inside it as a JSON pointer ("/accessors/3/byteOffset"). What the file asks for and Cupola cannot
/// show is an error where the picture would be wrong, a warning where it is only poorer.
[[nodiscard]] model::Result<LoadedScene> load_gltf(const model::Gltf& wish,
                                                   const std::filesystem::path& folder);

} // namespace cupola::content
