#include "renderer/outputs/files.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "renderer/outputs/image_file.h"
#include "renderer/outputs/readback.h"

namespace cupola::outputs {

namespace {

/// Pictures under way from the GPU to the disk: what a slow disk can hold up.
constexpr std::size_t queue_length = 6;

/// Pictures still waiting when the output closes are written for so long, then given up.
constexpr auto closing_time = std::chrono::milliseconds(400);

std::string file_name(const FilesOptions& options, std::uint64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return options.name + '-' + digits + '.' + options.format;
}

/// The writing thread and its queue. The queue is as long as there are buffers to read back into.
class Writer {
public:
  explicit Writer(FilesOptions options)
      : options_(std::move(options))
      , thread_([this] { work(); }) {}

  ~Writer() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
      give_up_at_ = std::chrono::steady_clock::now() + closing_time;
    }
    wake_.notify_one();
    thread_.join();
  }

  void submit(Pixels pixels) {
    {
      const std::lock_guard lock(mutex_);
      queue_.push_back(std::move(pixels));
    }
    wake_.notify_one();
  }

  std::atomic<std::uint64_t> written{0}, failed{0};

  model::Problems take_problems() {
    const std::lock_guard lock(mutex_);
    return std::exchange(problems_, {});
  }

private:
  std::optional<Pixels> next() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return closing_ || !queue_.empty(); });
    if (queue_.empty() || (closing_ && std::chrono::steady_clock::now() > give_up_at_)) return std::nullopt;
    Pixels pixels = std::move(queue_.front());
    queue_.pop_front();
    return pixels;
  }

  void work() {
    pthread_setname_np(pthread_self(), "files");
    while (const auto pixels = next()) {
      const auto result = write_image(options_.directory / file_name(options_, written),
                                      ByteView{pixels->rgba, pixels->width, pixels->height, true, false});
      if (result) {
        ++written;
        failing_ = false;
        continue;
      }
      ++failed;
      if (std::exchange(failing_, true)) continue; // one line until it works again
      const std::lock_guard lock(mutex_);
      problems_.insert(problems_.end(), result.error().begin(), result.error().end());
    }
    const std::lock_guard lock(mutex_);
    queue_.clear(); // lets the buffers go
  }

  FilesOptions options_;
  std::mutex mutex_; ///< held to push and pop, never while writing
  std::condition_variable wake_;
  std::deque<Pixels> queue_;
  model::Problems problems_;
  bool closing_ = false;
  bool failing_ = false; ///< writing thread only
  std::chrono::steady_clock::time_point give_up_at_{};
  std::thread thread_;
};

class Files final : public Output {
public:
  explicit Files(const FilesOptions& options)
      : options_(options) {}

  ~Files() override {
    writer_.reset(); // lets the read-back buffers go before they are deleted
  }

  std::string describe() const override {
    return "files " + std::to_string(options_.width) + "x" + std::to_string(options_.height) + " in " +
           options_.directory.string() + " as " + options_.format;
  }

  void draw(const Frame& frame) override {
    if (!readback_) readback_ = std::make_unique<Readback>(queue_length);
    collect();
    if (options_.limit > 0 && started_ - writer_->failed >= static_cast<std::uint64_t>(options_.limit))
      return;
    if (readback_->start(frame, std::nullopt, frame.number)) {
      ++started_;
      behind_ = false;
      return;
    }
    ++dropped_;
    if (std::exchange(behind_, true)) return;
    problems_.push_back({model::Code::image_unwritable,
                         "",
                         "a disk that takes every frame in " + options_.directory.string(),
                         "pictures are dropped",
                         "Use a faster disk, a smaller picture or a lower frame rate.",
                         {},
                         model::Severity::warning});
  }

  void present() override {}

  Counters counters() const override { return {writer_->written, dropped_ + writer_->failed}; }

  model::Problems take_problems() override {
    model::Problems all = std::exchange(problems_, {});
    for (auto& problem : writer_->take_problems()) all.push_back(std::move(problem));
    return all;
  }

private:
  void collect() {
    while (auto pixels = readback_->take()) writer_->submit(std::move(*pixels));
  }

  FilesOptions options_;
  std::unique_ptr<Readback> readback_; ///< made on the render thread, at the first frame
  std::unique_ptr<Writer> writer_ = std::make_unique<Writer>(options_);
  std::uint64_t started_ = 0, dropped_ = 0;
  bool behind_ = false;
  model::Problems problems_;
};

} // namespace

namespace {

model::Problem unwritable(const FilesOptions& options, const std::string& why) {
  return {model::Code::image_unwritable, "/outputs/" + options.name + "/directory",
          "a folder that pictures can be written to", options.directory.string() + " (" + why + ')', ""};
}

/// "" or why no file can be made in the folder.
std::string why_not(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return error ? error.message() : "not a folder";
  return access(folder.c_str(), W_OK | X_OK) == 0 ? "" : std::generic_category().message(errno);
}

} // namespace

model::Problems test_files(const FilesOptions& options) {
  // The nearest folder that is there decides whether the rest can be made.
  std::error_code error;
  std::filesystem::path nearest = std::filesystem::absolute(options.directory, error);
  while (!std::filesystem::exists(nearest, error) && nearest.has_relative_path())
    nearest = nearest.parent_path();
  const std::string why = why_not(nearest);
  return why.empty() ? model::Problems{} : model::Problems{unwritable(options, why)};
}

model::Result<std::unique_ptr<Output>> open_files(const FilesOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.directory, error);
  const std::string why = error ? error.message() : why_not(options.directory);
  if (!why.empty()) return model::failure(unwritable(options, why));
  return std::make_unique<Files>(options);
}

} // namespace cupola::outputs
