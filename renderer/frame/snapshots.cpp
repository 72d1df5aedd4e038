#include "renderer/frame/snapshots.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

namespace cupola::frame {

namespace {

constexpr std::size_t buffers = 6;       ///< pictures read back at once
constexpr std::size_t max_waiting = 256; ///< requests; a viewer that asks faster is told so

model::Problem too_many() {
  return {model::Code::overloaded, "",
          "fewer than " + std::to_string(max_waiting) + " pictures asked for at once", "more",
          "Ask again when the last answer has come."};
}

model::Problem ended() {
  return {model::Code::stopping, "", "a running output", "the frame loop has ended", ""};
}

model::Problem unknown(const std::string& output, const std::vector<Picture>& pictures) {
  std::vector<std::string> names;
  for (const Picture& picture : pictures) names.push_back(picture.output);
  const std::string near = model::nearest(output, names);
  return {model::Code::unknown_resource, "/outputs/" + output, "an output of the show", '"' + output + '"',
          near.empty() ? "" : "Did you mean \"" + near + "\"?"};
}

} // namespace

Snapshots::Snapshots()
    : thread_([this] { deliver(); }) {}

Snapshots::~Snapshots() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Snapshots::request(std::string output, std::optional<int> max_width, SnapshotCallback callback) {
  std::optional<model::Problem> refused;
  {
    const std::lock_guard lock(mutex_);
    if (ended_)
      refused = ended();
    else if (requests_.size() >= max_waiting)
      refused = too_many();
    else
      requests_.push_back({std::move(output), max_width, std::move(callback)});
  }
  if (refused) // NOLINTNEXTLINE(bugprone-use-after-move): moved only where it was not refused
    callback(model::failure(std::move(*refused)));
}

void Snapshots::accept() {
  const std::lock_guard lock(mutex_);
  accepted_.insert(accepted_.end(), std::make_move_iterator(requests_.begin()),
                   std::make_move_iterator(requests_.end()));
  requests_.clear();
}

void Snapshots::serve(const std::vector<Picture>& pictures, std::uint64_t revision, std::uint64_t frame) {
  collect();
  if (!accepted_.empty()) begin(pictures, revision, frame);
}

void Snapshots::begin(const std::vector<Picture>& pictures, std::uint64_t revision, std::uint64_t frame) {
  if (!readback_) readback_ = std::make_unique<outputs::Readback>(buffers);
  std::vector<Request> later;
  std::vector<Read> reads;
  for (Request& request : accepted_) {
    const auto same = std::find_if(reads.begin(), reads.end(), [&](const Read& read) {
      return read.output == request.output && read.max_width == request.max_width;
    });
    if (same != reads.end()) {
      same->callbacks.push_back(std::move(request.callback));
      continue;
    }
    const auto picture = std::find_if(pictures.begin(), pictures.end(), [&](const Picture& candidate) {
      return candidate.output == request.output;
    });
    if (picture == pictures.end()) {
      request.callback(model::failure(unknown(request.output, pictures)));
      continue;
    }
    const outputs::Frame source{picture->texture, picture->width, picture->height, frame};
    if (!readback_->start(source, request.max_width, frame)) {
      later.push_back(std::move(request));
      continue;
    }
    Read& read = reads.emplace_back();
    read = {std::move(request.output), request.max_width, revision, frame, {}};
    read.callbacks.push_back(std::move(request.callback));
  }
  for (Read& read : reads) under_way_.push_back(std::move(read));
  accepted_ = std::move(later);
}

bool Snapshots::collect() {
  if (!readback_) return false;
  while (auto pixels = readback_->take()) {
    {
      const std::lock_guard lock(mutex_);
      deliveries_.push_back({std::move(under_way_.front()), std::move(*pixels)});
    }
    under_way_.pop_front();
    wake_.notify_all();
  }
  return readback_->pending();
}

void Snapshots::end() {
  std::vector<SnapshotCallback> unanswered;
  {
    std::unique_lock lock(mutex_);
    ended_ = true;
    for (Request& request : requests_) unanswered.push_back(std::move(request.callback));
    requests_.clear();
    for (Request& request : accepted_) unanswered.push_back(std::move(request.callback));
    accepted_.clear();
    // Pictures that are there already are delivered; their buffers must be let go before they are deleted.
    wake_.wait(lock, [this] { return deliveries_.empty() && !delivering_; });
  }
  for (Read& read : under_way_)
    for (SnapshotCallback& callback : read.callbacks) unanswered.push_back(std::move(callback));
  under_way_.clear();
  readback_.reset();
  for (const SnapshotCallback& callback : unanswered) callback(model::failure(ended()));
}

void Snapshots::deliver() {
  pthread_setname_np(pthread_self(), "snapshot");
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return closing_ || !deliveries_.empty(); });
    if (deliveries_.empty()) return;
    Delivery delivery = std::move(deliveries_.front());
    deliveries_.pop_front();
    delivering_ = true;
    lock.unlock();

    Snapshot snapshot{delivery.read.output,  delivery.read.revision, delivery.read.frame,
                      delivery.pixels.width, delivery.pixels.height, outputs::to_rgb(delivery.pixels)};
    delivery.pixels = {};
    for (const SnapshotCallback& callback : delivery.read.callbacks) callback(snapshot);

    lock.lock();
    delivering_ = false;
    wake_.notify_all();
  }
}

} // namespace cupola::frame
