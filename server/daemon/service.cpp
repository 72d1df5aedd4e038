#include "server/daemon/service.h"

#include <systemd/sd-daemon.h>
#include <time.h>

namespace cupola::daemon::service {

namespace {

/// A status is one line.
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

} // namespace

std::optional<std::chrono::milliseconds> beat_interval() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  return std::chrono::milliseconds(microseconds / 2000);
}

void ready(const std::string& text) { sd_notify(0, ("READY=1\nSTATUS=" + one_line(text)).c_str()); }

void reloading() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const long long microseconds = now.tv_sec * 1'000'000LL + now.tv_nsec / 1000;
  sd_notifyf(0, "RELOADING=1\nMONOTONIC_USEC=%lld\nSTATUS=reloading", microseconds);
}

void status(const std::string& text) { sd_notify(0, ("STATUS=" + one_line(text)).c_str()); }

void beat() { sd_notify(0, "WATCHDOG=1"); }

void stopping() { sd_notify(0, "STOPPING=1\nSTATUS=stopping"); }

} // namespace cupola::daemon::service
