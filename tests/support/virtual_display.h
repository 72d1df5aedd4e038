// An X server of its own for a test, without a monitor, whose screen can be read as it is shown.
#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace cupola::tests {

/// A picture of the whole screen; rows from the top.
struct Screen {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return rgb.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3;
  }
};

/// Runs Xvfb with one screen of 1280x800 and points DISPLAY to it; ends it in the destructor.
class VirtualDisplay {
public:
  VirtualDisplay() {
    folder_ = std::filesystem::temp_directory_path() / ("cupola-screen-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    const std::string number = std::to_string(ends[1]);
    const std::array<const char*, 10> arguments{"Xvfb",     "-displayfd",  number.c_str(), "-screen",
                                                "0",        "1280x800x24", "-fbdir",       folder_.c_str(),
                                                "-noreset", nullptr};
    if (posix_spawnp(&pid_, "Xvfb", nullptr, nullptr, const_cast<char* const*>(arguments.data()), environ) !=
        0)
      pid_ = -1;
    close(ends[1]);
    std::array<char, 16> text{};
    const ssize_t got = pid_ > 0 ? read(ends[0], text.data(), text.size() - 1) : 0;
    close(ends[0]);
    if (got <= 0) return;
    ready_ = true;
    setenv("DISPLAY", (":" + std::to_string(std::atoi(text.data()))).c_str(), 1);
  }
  ~VirtualDisplay() {
    unsetenv("DISPLAY");
    if (pid_ > 0) {
      kill(pid_, SIGTERM);
      waitpid(pid_, nullptr, 0);
    }
    std::filesystem::remove_all(folder_);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// False where Xvfb is not installed.
  [[nodiscard]] bool ready() const { return ready_; }

  /// What the screen shows now. Xvfb keeps it in a file in the format of xwd [XWDFile.h]: a header of
  /// big-endian words, a table of colours, then pixels of four bytes, blue first.
  [[nodiscard]] Screen screen() const {
    std::ifstream file(folder_ / "Xvfb_screen0", std::ios::binary);
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                          std::istreambuf_iterator<char>()};
    const auto word = [&](std::size_t index) {
      std::uint32_t value = 0;
      for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[index * 4 + i];
      return static_cast<std::size_t>(value);
    };
    if (bytes.size() < 100) return {};
    const std::size_t width = word(4), height = word(5), row = word(12), colors = word(19);
    const std::size_t start = word(0) + colors * 12;
    Screen screen{static_cast<int>(width), static_cast<int>(height), {}};
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t at = start + y * row + x * 4;
        screen.rgb.insert(screen.rgb.end(), {bytes[at + 2], bytes[at + 1], bytes[at]});
      }
    return screen;
  }

private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;
  bool ready_ = false;
};

} // namespace cupola::tests
