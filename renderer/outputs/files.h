// An output that writes every frame as a numbered picture: DIRECTORY/NAME-000000.png, -000001, …
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "renderer/outputs/output.h"

namespace cupola::outputs {

struct FilesOptions {
  std::string name; ///< of the output; begins the file names
  int width = 0, height = 0;
  std::filesystem::path directory;
  std::string format = "png"; ///< png, jpg, exr or tif
  int limit = 0;              ///< stops after so many pictures; 0: never
};

/// Any thread. What would keep open_files() from succeeding, without making anything.
[[nodiscard]] model::Problems test_files(const FilesOptions& options);

/// Any thread. Makes the directory when it is missing; a problem when it cannot be written to. The pictures
/// are written by a thread of their own. A disk that does not keep up, or is full, costs pictures, not
/// frames: they are dropped and counted, and the numbers of those written have no gap.
[[nodiscard]] model::Result<std::unique_ptr<Output>> open_files(const FilesOptions& options);

} // namespace cupola::outputs
