#include "server/cli/report.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace cupola::cli {

using Json = nlohmann::ordered_json;
using model::Problem;
using model::Severity;

namespace {

std::string dumped(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

const char* severity_name(const Problem& problem) {
  return problem.severity == Severity::warning ? "warning" : "error";
}

/// A path as SARIF wants it: a URI reference.
std::string as_uri(const std::string& path) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  constexpr std::string_view kept = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  std::string out = path.starts_with('/') ? "file://" : "";
  for (const char c : path) {
    if (kept.find(c) != std::string_view::npos) {
      out += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      out += '%';
      out += digits[byte >> 4];
      out += digits[byte & 15];
    }
  }
  return out;
}

/// Lines of the files that problems stand in, read when first asked for.
class Lines {
public:
  /// A column counted in characters (SARIF's unicodeCodePoints), as ours count bytes.
  std::size_t column(const model::Position& at) {
    const std::vector<std::string>& lines = of(at.file);
    if (at.line > lines.size()) return at.column;
    const std::string_view before = std::string_view(lines[at.line - 1]).substr(0, at.column - 1);
    return 1 + static_cast<std::size_t>(std::count_if(before.begin(), before.end(),
                                                      [](unsigned char c) { return (c & 0xC0u) != 0x80u; }));
  }

private:
  const std::vector<std::string>& of(const std::string& file) {
    const auto [entry, is_new] = files_.try_emplace(file);
    if (is_new) {
      std::ifstream stream(file, std::ios::binary);
      for (std::string line; std::getline(stream, line);) entry->second.push_back(line);
      if (!entry->second.empty() && entry->second.front().starts_with("\xEF\xBB\xBF"))
        entry->second.front().erase(0, 3); // a byte order mark is no part of the line
    }
    return entry->second;
  }
  std::map<std::string, std::vector<std::string>> files_;
};

/// The text without its place and code, which SARIF has fields for.
std::string sentence(Problem problem) {
  problem.at = {};
  std::string text = model::to_text(problem);
  return text.substr(text.find(": ") + 2, text.rfind(" [") - text.find(": ") - 2);
}

Json rules_of(const model::Problems& problems, std::map<std::string, std::size_t>& index) {
  Json rules = Json::array();
  for (const Problem& problem : problems) {
    const model::CodeText& text = model::code_texts()[static_cast<std::size_t>(problem.code)];
    if (!index.emplace(text.id, rules.size()).second) continue;
    rules.push_back({{"id", text.id},
                     {"shortDescription", {{"text", text.title}}},
                     {"fullDescription", {{"text", text.explanation}}}});
  }
  return rules;
}

} // namespace

std::string as_json(const model::Problems& problems) {
  Json list = Json::array();
  for (const Problem& problem : problems) {
    Json item{{"code", model::code_id(problem.code)},
              {"severity", severity_name(problem)},
              {"file", problem.at.file}};
    if (problem.at.line > 0) {
      item["line"] = problem.at.line;
      item["column"] = problem.at.column;
    }
    item["pointer"] = problem.pointer;
    item["expected"] = problem.expected;
    item["found"] = problem.found;
    item["advice"] = problem.advice;
    item["text"] = model::to_text(problem);
    list.push_back(std::move(item));
  }
  return dumped(list);
}

std::string as_sarif(const model::Problems& problems) {
  std::map<std::string, std::size_t> index;
  Json rules = rules_of(problems, index);
  Json results = Json::array();
  Lines lines;
  for (const Problem& problem : problems) {
    const std::string id(model::code_id(problem.code));
    Json location{{"physicalLocation", {{"artifactLocation", {{"uri", as_uri(problem.at.file)}}}}}};
    if (problem.at.line > 0)
      location["physicalLocation"]["region"] = {{"startLine", problem.at.line},
                                                {"startColumn", lines.column(problem.at)}};
    if (!problem.pointer.empty())
      location["logicalLocations"] = Json::array({{{"fullyQualifiedName", problem.pointer}}});
    results.push_back({{"ruleId", id},
                       {"ruleIndex", index.at(id)},
                       {"level", severity_name(problem)},
                       {"message", {{"text", sentence(problem)}}},
                       {"locations", Json::array({std::move(location)})}});
  }
  const Json driver{{"name", "cupola validate"}, {"version", CUPOLA_VERSION}, {"rules", std::move(rules)}};
  return dumped({{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                 {"version", "2.1.0"},
                 {"runs", Json::array({{{"tool", {{"driver", driver}}},
                                        {"columnKind", "unicodeCodePoints"},
                                        {"results", std::move(results)}}})}});
}

} // namespace cupola::cli
