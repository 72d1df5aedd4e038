// Programs from embedded .glsl files: includes, defines, and compiler messages that name the file and line.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "renderer/gl/handle.h"

namespace cupola::gl {

struct Stage {
  GLenum type;      ///< GL_VERTEX_SHADER, …
  std::string file; ///< repository-relative name of an embedded file
};

struct ProgramSource {
  std::string label;
  std::vector<Stage> stages;
  std::vector<std::string> defines; ///< "NAME" or "NAME value"; the same for all stages
};

/// Compiles and links. `#include "renderer/…"` lines are resolved among the embedded files, each file at most
/// once per stage. Fails with Code::shader_failed and the compiler's words, places mapped to files and lines.
[[nodiscard]] model::Result<Program> build_program(const ProgramSource& source);

/// A stage's text after includes and defines: what the compiler sees. For tests and for build_program.
struct Expanded {
  std::string text;
  std::vector<std::string> files; ///< file names by the source-string numbers in #line directives
};
[[nodiscard]] model::Result<Expanded> expand(const std::string& file, std::span<const std::string> defines);

/// "2:14(7): error" or "2(14) : error" in a driver's message becomes "renderer/…/x.glsl:14(7): error".
[[nodiscard]] std::string map_message(const std::string& message, std::span<const std::string> files);

} // namespace cupola::gl
