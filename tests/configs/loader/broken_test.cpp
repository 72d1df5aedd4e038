// Every file in tests/configs/broken yields exactly the problems written beside it (NAME.expected, as
// `cupola validate` prints them); every file in tests/configs/good and configs/shows is accepted, with
// exactly the warnings written beside it, if any.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "configs/loader/loader.h"

using namespace cupola;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<fs::path> shows_in(const char* folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(CUPOLA_SOURCE_DIR) / folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  return files;
}

std::string lines(const model::Problems& problems) {
  std::string text;
  for (const model::Problem& problem : problems) text += model::to_text(problem) + '\n';
  return text;
}

std::string expected_beside(fs::path file) { return content(file.replace_extension(".expected")); }

} // namespace

TEST_CASE("broken shows yield the problems written beside them, and every CFG code occurs") {
  std::set<std::string_view> seen;
  const auto files = shows_in("tests/configs/broken");
  CHECK(files.size() >= 70);
  for (const fs::path& file : files) {
    CAPTURE(file.filename().string());
    const auto loaded = loader::parse_show(content(file), file.filename().string());
    REQUIRE_FALSE(loaded);
    CHECK(lines(loaded.error()) == expected_beside(file));
    CHECK(model::has_errors(loaded.error()));
    for (const model::Problem& problem : loaded.error()) {
      seen.insert(model::code_id(problem.code));
      CHECK((problem.at.line > 0 || problem.code == model::Code::too_many));
    }
  }
  // Files as such are tested in abuse_test.cpp, warnings below; a restart is asked for by the live show
  // alone.
  for (const auto code :
       {model::Code::file_unreadable, model::Code::file_too_large, model::Code::picture_aspect,
        model::Code::windows_overlap, model::Code::order_tie, model::Code::needs_restart})
    seen.insert(model::code_id(code));
  for (const model::CodeText& text : model::code_texts())
    if (text.id.starts_with("CFG")) {
      CAPTURE(text.id);
      CHECK(seen.contains(text.id));
    }
}

TEST_CASE("good shows are accepted, with the warnings written beside them") {
  std::set<model::Code> warned;
  for (const char* folder : {"tests/configs/good", "configs/shows"})
    for (const fs::path& file : shows_in(folder)) {
      CAPTURE(file.filename().string());
      const auto loaded = loader::parse_show(content(file), file.filename().string());
      if (!loaded) FAIL_CHECK(lines(loaded.error()));
      REQUIRE(loaded);
      CHECK(lines(loaded->warnings) == expected_beside(file));
      for (const model::Problem& problem : loaded->warnings) warned.insert(problem.code);
    }
  CHECK(warned == std::set{model::Code::picture_aspect, model::Code::unused, model::Code::windows_overlap,
                           model::Code::order_tie});
}
