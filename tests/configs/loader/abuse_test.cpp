// Files that are no shows: a located problem each, soon, and in bounded memory.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "configs/loader/loader.h"

using namespace cupola;
using model::Code;
namespace fs = std::filesystem;

namespace {

class Folder {
public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "cupola-abuse-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()));
    path_ = pattern;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }
  [[nodiscard]] const fs::path& path() const { return path_; }

private:
  fs::path path_;
};

std::string content(const char* file) {
  std::ifstream stream(fs::path(CUPOLA_SOURCE_DIR) / file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The first problem; it must be in the file named, with a place.
model::Problem first_problem(std::string_view text) {
  const auto loaded = loader::parse_show(text, "abuse.json");
  REQUIRE_FALSE(loaded);
  REQUIRE_FALSE(loaded.error().empty());
  const model::Problem& first = loaded.error().front();
  CHECK(first.at.file == "abuse.json");
  CHECK(first.at.line > 0);
  CHECK(first.at.column > 0);
  return first;
}

std::string repeated(std::string_view part, std::size_t times) {
  std::string text;
  text.reserve(part.size() * times);
  for (std::size_t i = 0; i < times; ++i) text += part;
  return text;
}

long peak_kilobytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

Code unread(const fs::path& file) {
  const auto loaded = loader::load_show(file);
  REQUIRE_FALSE(loaded);
  REQUIRE(loaded.error().size() == 1);
  CHECK(loaded.error()[0].at.file == file.string());
  return loaded.error()[0].code;
}

} // namespace

TEST_CASE("what is not a file is not read") {
  const Folder folder;
  CHECK(unread(folder.path()) == Code::file_unreadable);
  CHECK(unread(folder / "missing.json") == Code::file_unreadable);
  REQUIRE(::mkfifo((folder / "fifo.json").c_str(), 0600) == 0);
  CHECK(unread(folder / "fifo.json") == Code::file_unreadable);
  CHECK(unread("/dev/zero") == Code::file_unreadable);
  CHECK(unread("/dev/null") == Code::file_unreadable);
  CHECK(unread("") == Code::file_unreadable);
  fs::create_symlink("loop.json", folder / "loop.json");
  CHECK(unread(folder / "loop.json") == Code::file_unreadable);
  std::ofstream(folder / "file.json") << "{}";
  CHECK(unread(folder / "file.json/below") == Code::file_unreadable);
  if (::geteuid() != 0) { // everything is readable to root
    fs::permissions(folder / "file.json", fs::perms::none);
    CHECK(unread(folder / "file.json") == Code::file_unreadable);
  }
}

TEST_CASE("a hundred megabytes are refused unread") {
  const Folder folder;
  std::ofstream(folder / "large.json") << "{";
  fs::resize_file(folder / "large.json", 100u << 20);
  const long before = peak_kilobytes();
  CHECK(unread(folder / "large.json") == Code::file_too_large);
  CHECK(peak_kilobytes() - before < 20'000);
  CHECK(loader::parse_show(std::string(17u << 20, ' '), "large.json").error()[0].code ==
        Code::file_too_large);
}

TEST_CASE("a hundred thousand levels are refused at the first too many") {
  CHECK(first_problem(std::string(100'000, '[')).code == Code::json_too_deep);
  CHECK(first_problem(std::string(100'000, '[')).at.column == 65);
  CHECK(first_problem(repeated("{\"a\":", 100'000)).code == Code::json_too_deep);
  CHECK(first_problem(repeated("[\n", 100'000)).at.line == 65);
  CHECK(first_problem("{\"version\":1,\"x\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}")
            .code == Code::json_too_deep);
}

TEST_CASE("texts made to use up memory stay within bounds") {
  const std::size_t size = 15u << 20;
  CHECK(first_problem("[" + repeated("1,", size / 2)).code == Code::too_many);
  CHECK(first_problem("{" + repeated("\"a\":1,", size / 6)).code == Code::too_many);
  CHECK(first_problem(std::string(size, '\n')).code == Code::json_syntax);
  CHECK(first_problem("\"" + std::string(size, 'x')).code == Code::json_syntax);
  CHECK(first_problem("//" + std::string(size, 'x')).code == Code::json_syntax);
  CHECK(first_problem("{\"" + std::string(size, 'k') + "\":1}").code == Code::missing_key);
  CHECK(first_problem(std::string(size, '9')).code == Code::json_syntax);
  CHECK(first_problem("{\"version\":1,\"name\":\"" + std::string(size, 'n') + "\"}").code ==
        Code::empty_show);

  std::string keys = "{";
  for (int i = 0; i < 400'000; ++i) keys += "\"key" + std::to_string(i) + "\":1,";
  keys += "\"z\":1}";
  const auto many = loader::parse_show(keys, "abuse.json");
  REQUIRE_FALSE(many);
  CHECK(many.error().size() == 201);
  CHECK(many.error().back().found.ends_with(" more"));

  std::string nested;
  for (int i = 0; i < 60; ++i) nested += "{\"" + std::string(120, 'k') + "\":";
  nested += "[" + repeated("1,", 400'000) + "1]" + std::string(60, '}');
  CHECK(first_problem(nested).code == Code::missing_key);
  // All of the above in one process; ten times less than careless copies of keys would take.
  CHECK(peak_kilobytes() < 1'000'000);
}

TEST_CASE("bytes that are not UTF-8 are named where they stand") {
  const std::string good = content("configs/shows/cylinder-city.json");
  const std::vector<std::string> bad{"\xFF", "\xC0\xAF", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80",
                                     "\x80", "\xC3"};
  for (const std::string& bytes : bad)
    for (std::size_t at = 0; at <= good.size(); at += 37) {
      const std::string text = good.substr(0, at) + bytes + good.substr(at);
      const model::Problem problem = first_problem(text);
      CHECK(problem.code == Code::json_encoding);
      const std::string before = text.substr(0, at);
      CHECK(problem.at.line == static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1);
    }
}

TEST_CASE("a show cut off at any byte") {
  const std::string good = content("tests/configs/good/every_key.json");
  const std::size_t last = good.rfind('}');
  REQUIRE(last > 2000);
  for (std::size_t length = 0; length <= last; ++length) {
    const Code code = first_problem(good.substr(0, length)).code;
    CHECK((code == Code::json_syntax || code == Code::json_encoding));
  }
  CHECK(loader::parse_show(good.substr(0, last + 1), "whole.json"));
}

TEST_CASE("random damage never does more than yield problems with a place") {
  const std::string good = content("tests/configs/good/every_key.json");
  std::mt19937 random(20'240'501);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  int refused = 0, accepted = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string text = good;
    for (std::size_t flips = 1 + below(4); flips > 0; --flips) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text[at] = static_cast<char>(below(256));
        break;
      case 2:
        text.erase(at, 1 + below(20));
        break;
      default:
        text.insert(at, text.substr(below(text.size()), below(30)));
      }
    }
    const auto loaded = loader::parse_show(text, "damaged.json");
    if (loaded) {
      ++accepted;
      continue;
    }
    ++refused;
    REQUIRE(model::has_errors(loaded.error()));
    for (const model::Problem& problem : loaded.error()) CHECK(problem.at.line > 0);
  }
  CHECK(refused > 4000);
  CHECK(accepted > 50); // damage to comments, texts and digits is no damage to the format
}
