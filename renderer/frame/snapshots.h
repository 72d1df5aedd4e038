// Pictures of running outputs for whoever asks: requests from any thread, read back after a frame without a
// stall, delivered by a thread of their own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "renderer/frame/loop.h"
#include "renderer/outputs/readback.h"

namespace cupola::frame {

class Snapshots {
public:
  Snapshots();
  /// Requests still open are answered with a problem. After end().
  ~Snapshots();
  Snapshots(const Snapshots&) = delete;
  Snapshots& operator=(const Snapshots&) = delete;

  /// Any thread.
  void request(std::string output, std::optional<int> max_width, SnapshotCallback callback);

  /// Render thread, before a frame begins: what is asked for until now gets a picture of that frame or of a
  /// later one, never of an earlier one.
  void accept();

  /// Render thread, after a frame: starts what was accepted and hands over what is finished.
  void serve(const std::vector<Picture>& pictures, std::uint64_t revision, std::uint64_t frame);

  /// Render thread: hands over what is finished; true while more is under way.
  bool collect();

  /// Render thread, its context still current: lets go of all GL objects. Requests are refused from then on.
  void end();

private:
  struct Request {
    std::string output;
    std::optional<int> max_width;
    SnapshotCallback callback;
  };
  /// A read that answers all requests that want the same.
  struct Read {
    std::string output;
    std::optional<int> max_width;
    std::uint64_t revision = 0, frame = 0;
    std::vector<SnapshotCallback> callbacks;
  };
  struct Delivery {
    Read read;
    outputs::Pixels pixels;
  };
  void begin(const std::vector<Picture>& pictures, std::uint64_t revision, std::uint64_t frame);
  void deliver();

  std::mutex mutex_; ///< held to push, swap and pop, never while reading back or converting
  std::vector<Request> requests_;
  std::deque<Delivery> deliveries_;
  std::condition_variable wake_;
  bool ended_ = false, closing_ = false, delivering_ = false;

  std::unique_ptr<outputs::Readback> readback_; ///< render thread
  std::vector<Request> accepted_;               ///< render thread
  std::deque<Read> under_way_;                  ///< render thread, in the order of readback_
  std::thread thread_;
};

} // namespace cupola::frame
