#include "server/control/problem_json.h"

#include <nlohmann/json.hpp>

namespace cupola::control {

model::Json problem_json(const model::Problem& problem) {
  const model::CodeText& text = model::code_texts()[static_cast<std::size_t>(problem.code)];
  model::Json out = {{"code", text.id},
                     {"title", text.title},
                     {"severity", problem.severity == model::Severity::warning ? "warning" : "error"},
                     {"pointer", problem.pointer},
                     {"expected", problem.expected},
                     {"found", problem.found},
                     {"advice", problem.advice},
                     {"text", model::to_text(problem)}};
  if (!problem.at.file.empty()) out["file"] = problem.at.file;
  if (problem.at.line > 0) {
    out["line"] = problem.at.line;
    out["column"] = problem.at.column;
  }
  return out;
}

model::Json problems_json(const model::Problems& problems) {
  model::Json out = model::Json::array();
  for (const model::Problem& problem : problems) out.push_back(problem_json(problem));
  return out;
}

} // namespace cupola::control
