// What systemd hears [sd_notify(3)]. Without systemd nothing happens. Main thread.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace cupola::daemon::service {

/// How often beat() should be called: half the interval that systemd allows; nullopt without a watchdog.
[[nodiscard]] std::optional<std::chrono::milliseconds> beat_interval();

void ready(const std::string& status);
void reloading();
void status(const std::string& text);
void beat();
void stopping();

} // namespace cupola::daemon::service
