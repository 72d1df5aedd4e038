// Live pictures for many who ask at once: one snapshot and one encoding for all of them.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <tuple>

#include "configs/model/problem.h"
#include "server/control/http/picture.h"

namespace cupola::control {

/// Asks for the next frame of an output that begins after the call; the picture may come on any thread.
/// Must not block or throw.
using SnapshotSource =
    std::function<void(const std::string& output, std::function<void(model::Result<RgbPicture>)> deliver)>;

/// What is wanted of an output.
struct PictureKey {
  std::string output;
  PictureFormat format = PictureFormat::png;
  int width = 0; ///< pixels, 0: as rendered
  bool operator<(const PictureKey& other) const {
    return std::tie(output, format, width) < std::tie(other.output, other.format, other.width);
  }
};

/// Any thread. Owns the thread "encode".
class Pictures {
public:
  using Deliver = std::function<void(const model::Result<std::string>&)>; ///< thread "encode"; never blocks

  Pictures(SnapshotSource source, std::chrono::milliseconds patience);
  ~Pictures(); ///< drops what is still asked for
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;

  /// The bytes of a picture taken after this call. Requests that come while a snapshot is under way share the
  /// next one: never a stale picture, and never more than one snapshot at a time for a key. After `patience`
  /// without a picture: CTL-109.
  void request(const PictureKey& key, Deliver deliver);

private:
  struct Core;
  std::shared_ptr<Core> core_; ///< shared with snapshots under way, which may outlive this
  std::thread worker_;
};

} // namespace cupola::control
