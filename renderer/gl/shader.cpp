#include "renderer/gl/shader.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

#include "renderer/gl/embedded.h"

namespace cupola::gl {

namespace {

/// The text of a shader file: from the folder in CUPOLA_SHADERS while developing, else as embedded.
std::optional<std::string> source_text(const std::string& name) {
  if (const char* folder = std::getenv("CUPOLA_SHADERS")) {
    std::ifstream in(std::filesystem::path(folder) / name, std::ios::binary);
    if (in) return std::string(std::istreambuf_iterator<char>(in), {});
  }
  for (const EmbeddedFile& file : embedded_files())
    if (file.name == name) return std::string(file.text);
  return std::nullopt;
}

class Expander {
public:
  model::Problems problems;
  Expanded out;

  void include(const std::string& name) {
    if (!seen_.insert(name).second) return;
    const std::optional<std::string> text = source_text(name);
    if (!text) {
      problems.push_back({model::Code::shader_failed, "", "a shader file named " + name, "none", "", {}, {}});
      return;
    }
    const std::size_t number = out.files.size();
    out.files.push_back(name);
    out.text += "#line 1 " + std::to_string(number) + '\n';
    std::istringstream lines(*text);
    std::string line;
    for (std::size_t at = 1; std::getline(lines, line); ++at) {
      if (line.rfind("#include \"", 0) == 0) {
        include(line.substr(10, line.find('"', 10) - 10));
        out.text += "#line " + std::to_string(at + 1) + ' ' + std::to_string(number) + '\n';
      } else {
        out.text += line + '\n';
      }
    }
  }

private:
  std::set<std::string> seen_;
};

model::Problem failed(const std::string& label, const std::string& words) {
  return {model::Code::shader_failed, "", "the program '" + label + "' to compile", words, "", {}, {}};
}

template <class Get, class Log>
std::string info_log(GLuint id, Get get, Log log) {
  GLint length = 0;
  get(id, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  log(id, length, nullptr, text.data());
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

} // namespace

model::Result<Expanded> expand(const std::string& file, std::span<const std::string> defines) {
  Expander expander;
  expander.out.text = "#version 450 core\n";
  for (const std::string& define : defines) expander.out.text += "#define " + define + '\n';
  expander.include(file);
  if (!expander.problems.empty()) return tl::unexpected(expander.problems);
  return std::move(expander.out);
}

std::string map_message(const std::string& message, std::span<const std::string> files) {
  static const std::regex place(R"((^|\n|\s)(\d+)[:(](\d+)\)?)");
  std::string out;
  auto from = message.cbegin();
  for (std::sregex_iterator it(message.begin(), message.end(), place), end; it != end; ++it) {
    const std::size_t number = std::stoul((*it)[2]);
    out.append(from, (*it)[0].first);
    out += (*it)[1];
    out += number < files.size() ? files[number] : (*it)[2].str();
    out += ':' + (*it)[3].str();
    from = (*it)[0].second;
  }
  out.append(from, message.cend());
  return out;
}

model::Result<Program> build_program(const ProgramSource& source) {
  Program program = Program::make();
  program.label(source.label);
  std::vector<GLuint> shaders;
  model::Problems problems;
  for (const Stage& stage : source.stages) {
    const model::Result<Expanded> text = expand(stage.file, source.defines);
    if (!text) {
      problems.insert(problems.end(), text.error().begin(), text.error().end());
      continue;
    }
    const GLuint shader = glCreateShader(stage.type);
    shaders.push_back(shader);
    const char* chars = text->text.c_str();
    glShaderSource(shader, 1, &chars, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled)
      problems.push_back(failed(
          source.label, map_message(info_log(shader, glGetShaderiv, glGetShaderInfoLog), text->files)));
    glAttachShader(program.id(), shader);
  }
  if (problems.empty()) {
    glLinkProgram(program.id());
    GLint linked = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (!linked)
      problems.push_back(failed(source.label, info_log(program.id(), glGetProgramiv, glGetProgramInfoLog)));
  }
  for (const GLuint shader : shaders) {
    glDetachShader(program.id(), shader);
    glDeleteShader(shader);
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return program;
}

} // namespace cupola::gl
