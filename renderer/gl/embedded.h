#pragma once

#include <span>
#include <string_view>

namespace cupola::gl {

// A text file compiled into the program by cupola_embed() (cmake/Embed.cmake).
// name: path from the repository root with forward slashes ("renderer/projection/cylinder.glsl").
// text: the whole file, byte for byte, UTF-8. Both live as long as the program.
struct EmbeddedFile {
  std::string_view name, text;
};

// Every embedded file, sorted by name. Defined by the generated source of the one target that cupola_embed()
// was called for. Any thread.
std::span<const EmbeddedFile> embedded_files();

} // namespace cupola::gl
