// The live show: the one place where it changes. Every door (file reload, HTTP, OSC, command line) hands in a
// Change and gets the same answer; everybody else reads an immutable Snapshot.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "configs/loader/loader.h"
#include "configs/model/change.h"
#include "configs/model/parameters.h"
#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/plan/plan.h"

namespace cupola::state {

/// What the content of a show needs beside its plain values: the loaded scene. Opaque here.
using Resources = std::shared_ptr<const void>;

/// One revision of the show, whole and unchanging. No member is null, except that `resources` is whatever
/// the loader of resources gave.
struct Snapshot {
  model::Revision revision = 0;                ///< from 1
  std::shared_ptr<const model::Json> document; ///< model::to_json(*show): every parameter, defaults included
  std::shared_ptr<const model::Show> show;
  std::shared_ptr<const plan::Plan> plan;
  Resources resources;      ///< the same pointer as long as the content is the same
  model::Problems warnings; ///< of loader and plan
};

/// The answer to a change that was taken. `differences` is empty, and `revision` the old one, where the
/// change altered nothing.
struct Accepted {
  model::Revision revision = 0;
  std::vector<model::Difference> differences;
  model::Cost cost = model::Cost::uniform; ///< the greatest of the differences
  model::Problems warnings;
};

using Answer = model::Result<Accepted>;

/// Called once, on the thread "prepare": hand over to your own thread, never block or throw.
using AnswerCallback = std::function<void(const Answer&)>;

/// The frame that first showed the revision (or a later one), or nullopt: not within the time, or never, and
/// then `why_not` says why. Called once, on the thread "shown", or on the caller's: never block or throw.
using ShownCallback = std::function<void(std::optional<std::uint64_t> frame, const model::Problems& why_not)>;

struct Options {
  /// Loads what scene.content names. Called on the thread "prepare" (the first time by make()), only when the
  /// content changed, or when a reloaded show names a file. Must not throw. Absent: resources stay null.
  std::function<model::Result<Resources>(const model::Show&)> load_resources;
  /// What would keep the show's outputs from being opened, or nothing. Called on the thread "prepare", only
  /// for changes that open outputs; problems refuse the change. Must not throw. Absent: nothing is tested.
  std::function<model::Problems(const model::Show&)> test_outputs;
  std::size_t max_waiting = 1024; ///< changes beyond these are refused at once (CTL-106)
};

/// All member functions may be called from any thread.
class LiveState {
public:
  /// Revision 1: plans the show and loads its resources on the calling thread. Problems carry the places that
  /// `loaded.positions` knows.
  [[nodiscard]] static model::Result<std::unique_ptr<LiveState>> make(loader::Loaded loaded, Options options);

  /// Refuses what still waits; returns when a load of resources in progress is through.
  ~LiveState();
  LiveState(const LiveState&) = delete;
  LiveState& operator=(const LiveState&) = delete;

  /// The newest accepted revision that is prepared. Never null. A short atomic load: fit for the render
  /// thread.
  [[nodiscard]] std::shared_ptr<const Snapshot> current() const;

  /// Queues a change; never blocks. Changes are checked in the order they came, each against the show that
  /// the ones before it leave, each with a revision of its own; the costly part (resources, publishing) is
  /// done for the last of those that waited together. Refused: nothing altered, and all problems with
  /// pointers. Parameters of Cost::restart are refused (CFG-210).
  void submit(model::Change change, AnswerCallback answer);

  /// Queues the replacement of the whole show by a file, under the same rules; problems carry
  /// file:line:column. A show that names a scene file has it loaded again, which counts as a change.
  void reload(std::filesystem::path file, AnswerCallback answer);

  /// Render thread, after presenting on all outputs: `revision` was in frame `frame`. Never blocks.
  void shown(model::Revision revision, std::uint64_t frame) noexcept;

  /// `revision` cannot be shown, what was shown before goes on. Any thread.
  void failed(model::Revision revision, model::Problems why);

  /// Calls back when a frame has shown `revision` or a later one; with nullopt when it failed, or after
  /// `timeout`.
  void when_shown(model::Revision revision, std::chrono::milliseconds timeout, ShownCallback callback);

private:
  struct Impl;
  explicit LiveState(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The value at an address of the show: a leaf, a struct, a map, "" for the whole document; null for an
/// optional one that is absent. Fails with CTL-102, naming the nearest known key.
[[nodiscard]] model::Result<model::Json> value_at(const Snapshot& snapshot, std::string_view pointer);

} // namespace cupola::state
