#include "server/daemon/log.h"

#include <pthread.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

namespace cupola::daemon {

namespace {

enum class Look { text, journal, json };

std::string thread_name() {
  std::array<char, 16> name{};
  pthread_getname_np(pthread_self(), name.data(), name.size());
  return name.data();
}

/// UTC, milliseconds, as ISO 8601.
std::string timestamp(std::chrono::system_clock::time_point time) {
  const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
  const std::time_t seconds = since / 1000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", parts.tm_year + 1900, parts.tm_mon + 1,
                     parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec, since % 1000);
}

/// As in sd-daemon(3).
int priority(spdlog::level::level_enum level) {
  switch (level) {
  case spdlog::level::critical:
    return 2;
  case spdlog::level::err:
    return 3;
  case spdlog::level::warn:
    return 4;
  case spdlog::level::info:
    return 6;
  default:
    return 7;
  }
}

class Formatter final : public spdlog::formatter {
public:
  explicit Formatter(Look look)
      : look_(look) {}

  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    const std::string_view text(message.payload.data(), message.payload.size());
    const auto name = spdlog::level::to_string_view(message.level);
    const std::string_view level(name.data(), name.size());
    const auto to = std::back_inserter(out);
    switch (look_) {
    case Look::text:
      fmt::format_to(to, "{} {} {}: {}\n", timestamp(message.time), level, thread_name(), text);
      break;
    case Look::journal:
      fmt::format_to(to, "<{}>{}: {}\n", priority(message.level), thread_name(), text);
      break;
    case Look::json: {
      const nlohmann::ordered_json line{
          {"time", timestamp(message.time)}, {"level", level}, {"thread", thread_name()}, {"message", text}};
      fmt::format_to(to, "{}\n", line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
      break;
    }
    }
  }

  [[nodiscard]] std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<Formatter>(look_);
  }

private:
  Look look_;
};

/// Standard error is the journal's own stream [systemd.exec(5), $JOURNAL_STREAM].
bool journal_listens() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  if (!stream || fstat(STDERR_FILENO, &status) != 0) return false;
  return fmt::format("{}:{}", status.st_dev, status.st_ino) == stream;
}

} // namespace

void set_up_log(bool json, const std::string& level) {
  auto logger =
      std::make_shared<spdlog::logger>("cupolad", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_formatter(std::make_unique<Formatter>(json                ? Look::json
                                                    : journal_listens() ? Look::journal
                                                                        : Look::text));
  logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(std::move(logger));
}

void log_problems(const model::Problems& problems) {
  for (const model::Problem& problem : problems) {
    const bool warning = problem.severity == model::Severity::warning;
    spdlog::log(warning ? spdlog::level::warn : spdlog::level::err, "{}", model::to_text(problem));
  }
}

outputs::Messages messages_to_log() {
  return [](outputs::MessageLevel level, std::string_view text) {
    const auto as = level == outputs::MessageLevel::error     ? spdlog::level::err
                    : level == outputs::MessageLevel::warning ? spdlog::level::warn
                                                              : spdlog::level::info;
    spdlog::log(as, "{}", text);
  };
}

} // namespace cupola::daemon
