// Collects what is wrong with one glTF file. Private to the glTF reader.
#pragma once

#include <string>
#include <utility>

#include "configs/model/problem.h"

namespace cupola::content::gltf {

class Report {
public:
  explicit Report(std::string file)
      : file_(std::move(file)) {}

  void error(model::Code code, std::string pointer, std::string expected, std::string found) {
    add(code, std::move(pointer), std::move(expected), std::move(found), {}, model::Severity::error);
  }
  void invalid(std::string pointer, std::string expected, std::string found) {
    error(model::Code::scene_invalid, std::move(pointer), std::move(expected), std::move(found));
  }
  /// The picture is poorer than the file describes.
  void warning(std::string pointer, std::string expected, std::string found, std::string advice = {}) {
    add(model::Code::scene_unsupported, std::move(pointer), std::move(expected), std::move(found),
        std::move(advice), model::Severity::warning);
  }
  [[nodiscard]] bool failed() const { return errors_ > 0; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] model::Problems take() { return std::move(problems_); }

private:
  static constexpr std::size_t most = 100; ///< of each severity: a broken file repeats itself

  void add(model::Code code, std::string pointer, std::string expected, std::string found, std::string advice,
           model::Severity severity) {
    std::size_t& count = severity == model::Severity::error ? errors_ : warnings_;
    if (++count > most) return;
    problems_.push_back({code,
                         std::move(pointer),
                         std::move(expected),
                         std::move(found),
                         std::move(advice),
                         {file_, 0, 0},
                         severity});
  }

  std::string file_;
  model::Problems problems_;
  std::size_t errors_ = 0, warnings_ = 0;
};

/// "/accessors/3" + "/count".
[[nodiscard]] inline std::string path(const char* list, std::size_t index, const char* rest = "") {
  return std::string("/") + list + '/' + std::to_string(index) + rest;
}

} // namespace cupola::content::gltf
