#include "configs/loader/report.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace cupola::loader {

using model::Problem;
using model::Problems;

void Report::add(Problem problem) {
  if (full()) {
    ++left_out_;
    error_left_out_ |= problem.severity == model::Severity::error;
    return;
  }
  Problems one{std::move(problem)};
  locate(one, values_);
  problems_.push_back(std::move(one.front()));
}

void Report::add_at_key(Problem problem) {
  if (const auto key = keys_.find(problem.pointer); key != keys_.end()) problem.at = key->second;
  add(std::move(problem));
}

bool Report::refused(std::string_view pointer) const {
  const auto inside = [](std::string_view part, std::string_view whole) {
    return part.starts_with(whole) && (part.size() == whole.size() || part[whole.size()] == '/');
  };
  return std::any_of(problems_.begin(), problems_.end(), [&](const Problem& problem) {
    // A key that is not known, or wanting, leaves the others of its object as they are.
    if (problem.severity != model::Severity::error || problem.code == model::Code::unknown_key) return false;
    return inside(problem.pointer, pointer) || inside(pointer, problem.pointer);
  });
}

Problems Report::take() {
  std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& a, const Problem& b) {
    return std::tie(a.at.line, a.at.column) < std::tie(b.at.line, b.at.column);
  });
  if (left_out_ > 0) {
    Problem rest{model::Code::too_many, "", "at most " + std::to_string(limit) + " problems in a report",
                 std::to_string(left_out_) + " more", "Repair these first."};
    if (!problems_.empty()) rest.at.file = problems_.front().at.file;
    if (!error_left_out_) rest.severity = model::Severity::warning;
    problems_.push_back(std::move(rest));
  }
  left_out_ = 0;
  return std::exchange(problems_, {});
}

void locate(Problems& problems, const Positions& positions) {
  for (Problem& problem : problems) {
    if (problem.at.line > 0 || !problem.at.file.empty()) continue;
    std::string_view pointer = problem.pointer;
    for (;;) {
      if (const auto found = positions.find(pointer); found != positions.end()) {
        problem.at = found->second;
        break;
      }
      if (pointer.empty()) break;
      const std::size_t slash = pointer.rfind('/');
      pointer = pointer.substr(0, slash == std::string_view::npos ? 0 : slash);
    }
  }
}

} // namespace cupola::loader
