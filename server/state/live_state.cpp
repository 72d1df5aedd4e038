#include "server/state/live_state.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <thread>
#include <utility>
#include <variant>

#include "server/state/frame_log.h"
#include "server/state/log_budget.h"
#include "server/state/merge.h"

namespace cupola::state {

using model::Code;
using model::Json;
using model::Problem;
using model::Problems;

namespace {

using SnapshotPtr = std::shared_ptr<const Snapshot>;

/// The newest snapshot. A lock is held for the copy of a pointer and nothing else:
/// std::atomic<std::shared_ptr> of libstdc++ 12 lets a reader go with relaxed order, which is a data race.
class Published {
public:
  [[nodiscard]] SnapshotPtr load() const {
    const std::lock_guard lock(mutex_);
    return snapshot_;
  }
  void store(SnapshotPtr next) {
    const std::lock_guard lock(mutex_);
    snapshot_.swap(next);
  } // the old one, if this was the last reference, is freed by whoever called, after the lock

private:
  mutable std::mutex mutex_;
  SnapshotPtr snapshot_;
};

struct Item {
  std::variant<model::Change, std::filesystem::path> what;
  AnswerCallback answer;
  [[nodiscard]] bool is_file() const { return what.index() == 1; }
  [[nodiscard]] std::string origin() const {
    return is_file() ? "reload" : std::get<model::Change>(what).origin;
  }
};

/// A snapshot on its way, still without resources.
struct Candidate {
  SnapshotPtr snapshot;
  loader::Positions positions; ///< of a reloaded file
};

Problem moved(model::Revision expected, model::Revision found) {
  return {Code::revision_moved,
          "",
          "revision " + std::to_string(expected),
          "revision " + std::to_string(found),
          "Read the show again and repeat.",
          {}};
}

bool names_a_file(const model::Show& show) { return std::holds_alternative<model::Gltf>(show.scene.content); }

/// What the document says at the place of a difference, for messages.
std::string words_at(const Snapshot& snapshot, const std::string& pointer) {
  const auto value = value_at(snapshot, pointer);
  return value && !value->is_null() ? value->dump(-1, ' ', false, Json::error_handler_t::replace) : "nothing";
}

/// Document → planned snapshot without resources, with the revision left at 0. All problems, located.
model::Result<Candidate> plan_candidate(model::Result<loader::Loaded> loaded) {
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  auto planned = plan::make_plan(loaded->show);
  if (!planned) {
    loader::locate(planned.error(), loaded->positions);
    return tl::unexpected(std::move(planned.error()));
  }
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->document = std::make_shared<const Json>(model::to_json(loaded->show));
  snapshot->show = std::make_shared<const model::Show>(std::move(loaded->show));
  snapshot->plan = std::make_shared<const plan::Plan>(std::move(planned->plan));
  snapshot->warnings = std::move(loaded->warnings);
  loader::locate(planned->warnings, loaded->positions);
  snapshot->warnings.insert(snapshot->warnings.end(), planned->warnings.begin(), planned->warnings.end());
  return Candidate{std::move(snapshot), std::move(loaded->positions)};
}

model::Result<loader::Loaded> edited(const Snapshot& base, const model::Change& change) {
  if (change.expects && *change.expects != base.revision)
    return model::failure(moved(*change.expects, base.revision));
  Json document = *base.document;
  Problems problems;
  for (const model::Edit& edit : change.edits)
    if (auto problem = apply_edit(document, edit)) problems.push_back(std::move(*problem));
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return loader::decode_show(document);
}

/// Differences that only a restart can bring about, as problems.
Problems refusals(const Snapshot& from, const Snapshot& to,
                  const std::vector<model::Difference>& differences) {
  Problems problems;
  for (const model::Difference& difference : differences)
    if (difference.cost == model::Cost::restart)
      problems.push_back({Code::needs_restart,
                          difference.pointer,
                          words_at(from, difference.pointer),
                          words_at(to, difference.pointer),
                          "Change it in the show file and restart the daemon.",
                          {}});
  return problems;
}

model::Cost greatest(const std::vector<model::Difference>& differences) {
  model::Cost cost = model::Cost::uniform;
  for (const model::Difference& difference : differences) cost = std::max(cost, difference.cost);
  return cost;
}

/// What a change makes of `base`: its answer, and the snapshot that follows (`base` itself for a no-op).
struct Considered {
  Answer answer;
  Candidate next;
};

Considered consider(const SnapshotPtr& base, const Item& item, const Options& options) try {
  auto candidate =
      plan_candidate(item.is_file() ? loader::load_show(std::get<std::filesystem::path>(item.what))
                                    : edited(*base, std::get<model::Change>(item.what)));
  if (!candidate) return {tl::unexpected(std::move(candidate.error())), {base, {}}};
  Accepted accepted;
  accepted.differences = model::differences(*base->show, *candidate->snapshot->show);
  accepted.cost = greatest(accepted.differences);
  accepted.warnings = candidate->snapshot->warnings;
  if (accepted.cost == model::Cost::restart) {
    Problems problems = refusals(*base, *candidate->snapshot, accepted.differences);
    loader::locate(problems, candidate->positions);
    return {tl::unexpected(std::move(problems)), {base, {}}};
  }
  if (accepted.cost == model::Cost::reopen && options.test_outputs) {
    Problems problems = options.test_outputs(*candidate->snapshot->show);
    loader::locate(problems, candidate->positions);
    if (!problems.empty()) return {tl::unexpected(std::move(problems)), {base, {}}};
  }
  const bool files_again = item.is_file() && names_a_file(*candidate->snapshot->show);
  if (accepted.differences.empty() && !files_again) {
    accepted.revision = base->revision;
    return {std::move(accepted), {base, {}}};
  }
  if (files_again) accepted.cost = std::max(accepted.cost, model::Cost::rebuild);

  auto next = std::make_shared<Snapshot>(*candidate->snapshot);
  next->revision = accepted.revision = base->revision + 1;
  return {std::move(accepted), {std::move(next), std::move(candidate->positions)}};
} catch (const std::exception& error) {
  return {model::failure({Code::bad_request, "", "a change that can be carried out", error.what(), {}, {}}),
          {base, {}}};
}

} // namespace

struct LiveState::Impl {
  explicit Impl(Options given)
      : options(std::move(given)) {}

  void work();
  void process(std::vector<Item>& batch);
  bool process_together(std::vector<Item*>& items);
  model::Result<Resources> load(const model::Show& show) const;
  void enqueue(Item item);
  void answer(const Item& item, const Answer& given);

  Options options;
  Published current;
  FrameLog frames;

  std::mutex mutex; ///< guards queue and stop
  std::condition_variable arrived;
  std::deque<Item> queue;
  bool stop = false;

  LogBudget budget{20}; ///< thread "prepare"
  std::thread worker;
};

model::Result<Resources> LiveState::Impl::load(const model::Show& show) const try {
  if (!options.load_resources) return Resources{};
  return options.load_resources(show);
} catch (const std::exception& error) {
  return model::failure(
      {Code::scene_unreadable, "/scene/content", "content that can be loaded", error.what(), {}, {}});
}

/// Considers the items one after another, loads what the last of them needs, publishes, answers. False, with
/// nothing done, when the resources cannot be loaded and it is not clear whose fault that is.
bool LiveState::Impl::process_together(std::vector<Item*>& items) {
  const SnapshotPtr base = current.load();
  Candidate candidate{base, {}};
  std::vector<Answer> answers;
  bool load_again = false;
  for (const Item* item : items) {
    Considered considered = consider(candidate.snapshot, *item, options);
    const bool advanced = considered.next.snapshot != candidate.snapshot;
    if (advanced) {
      load_again = load_again || (item->is_file() && names_a_file(*considered.next.snapshot->show));
      candidate = std::move(considered.next);
    }
    answers.push_back(std::move(considered.answer));
  }

  if (candidate.snapshot != base) {
    auto next = std::make_shared<Snapshot>(*candidate.snapshot);
    const bool same_content = next->show->scene.content == base->show->scene.content;
    if (same_content && !load_again) {
      next->resources = base->resources;
    } else {
      auto resources = load(*next->show);
      if (!resources && items.size() > 1) return false;
      if (!resources) {
        loader::locate(resources.error(), candidate.positions);
        answers.front() = tl::unexpected(std::move(resources.error()));
        next.reset();
      } else {
        next->resources = std::move(*resources);
      }
    }
    if (next) {
      frames.keep(base);
      current.store(std::move(next));
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i) answer(*items[i], answers[i]);
  return true;
}

void LiveState::Impl::process(std::vector<Item>& batch) {
  std::vector<Item*> all;
  for (Item& item : batch) all.push_back(&item);
  if (process_together(all)) return;
  for (Item* item : all) {
    std::vector<Item*> one{item};
    process_together(one);
  }
}

void LiveState::Impl::answer(const Item& item, const Answer& given) {
  if (!given) {
    if (const auto missed = budget.admit(LogBudget::Clock::now())) {
      if (*missed > 0) spdlog::warn("{} more refused changes were not logged", *missed);
      for (const Problem& problem : given.error())
        spdlog::warn("{}: refused: {}", item.origin(), model::to_text(problem));
    }
  } else if (!given->differences.empty() || item.is_file()) {
    const std::size_t count = given->differences.size();
    spdlog::log(item.is_file() ? spdlog::level::info : spdlog::level::debug,
                "{}: revision {}, {} differences from {} ({})", item.origin(), given->revision, count,
                count == 0 ? "none" : given->differences.front().pointer, model::cost_name(given->cost));
  }
  if (!item.answer) return;
  try {
    item.answer(given);
  } catch (const std::exception& error) {
    spdlog::error("{}: the answer could not be delivered: {}", item.origin(), error.what());
  }
}

void LiveState::Impl::work() {
  pthread_setname_np(pthread_self(), "prepare");
  for (;;) {
    std::vector<Item> batch;
    bool stopping = false;
    {
      std::unique_lock lock(mutex);
      arrived.wait(lock, [this] { return stop || !queue.empty(); });
      stopping = stop;
      std::move(queue.begin(), queue.end(), std::back_inserter(batch));
      queue.clear();
    }
    if (!stopping) {
      process(batch);
      continue;
    }
    for (const Item& item : batch)
      answer(item, model::failure({Code::stopping, "", "a running daemon", "one that is stopping", {}, {}}));
    return;
  }
}

void LiveState::Impl::enqueue(Item item) {
  std::optional<Problem> refusal;
  {
    const std::lock_guard lock(mutex);
    if (stop)
      refusal = Problem{Code::stopping, "", "a running daemon", "one that is stopping", {}, {}};
    else if (queue.size() >= options.max_waiting)
      refusal = Problem{Code::overloaded,
                        "",
                        "at most " + std::to_string(options.max_waiting) + " changes waiting",
                        "one more",
                        "Send fewer changes a second.",
                        {}};
    else
      queue.push_back(std::move(item));
  }
  if (!refusal)
    arrived.notify_one();
  else if (item.answer) // NOLINT(bugprone-use-after-move): moved only without a refusal
    item.answer(model::failure(std::move(*refusal)));
}

LiveState::LiveState(std::unique_ptr<Impl> impl)
    : impl_(std::move(impl)) {
  impl_->worker = std::thread([state = impl_.get()] { state->work(); });
}

LiveState::~LiveState() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->arrived.notify_one();
  impl_->worker.join();
}

model::Result<std::unique_ptr<LiveState>> LiveState::make(loader::Loaded loaded, Options options) {
  auto candidate = plan_candidate(std::move(loaded));
  if (!candidate) return tl::unexpected(std::move(candidate.error()));
  auto impl = std::make_unique<Impl>(std::move(options));
  auto resources = impl->load(*candidate->snapshot->show);
  if (!resources) {
    loader::locate(resources.error(), candidate->positions);
    return tl::unexpected(std::move(resources.error()));
  }
  auto first = std::make_shared<Snapshot>(*candidate->snapshot);
  first->revision = 1;
  first->resources = std::move(*resources);
  impl->current.store(std::move(first));
  return std::unique_ptr<LiveState>(new LiveState(std::move(impl)));
}

std::shared_ptr<const Snapshot> LiveState::current() const { return impl_->current.load(); }

void LiveState::submit(model::Change change, AnswerCallback answer) {
  impl_->enqueue({std::move(change), std::move(answer)});
}

void LiveState::reload(std::filesystem::path file, AnswerCallback answer) {
  impl_->enqueue({std::move(file), std::move(answer)});
}

void LiveState::shown(model::Revision revision, std::uint64_t frame) noexcept {
  impl_->frames.shown(revision, frame);
}

void LiveState::failed(model::Revision revision, model::Problems why) {
  impl_->frames.failed(revision, std::move(why));
}

void LiveState::when_shown(model::Revision revision, std::chrono::milliseconds timeout,
                           ShownCallback callback) {
  impl_->frames.when_shown(revision, timeout, std::move(callback));
}

model::Result<Json> value_at(const Snapshot& snapshot, std::string_view pointer) {
  const Json* value = snapshot.document.get();
  if (pointer.empty()) return *value;
  if (const auto found = model::find(*snapshot.show, pointer)) {
    const Json::json_pointer at{std::string(pointer)};
    return value->contains(at) ? (*value)[at] : Json(); // absent: an optional value that is not there
  }
  return model::failure(unknown_path(*value, pointer));
}

} // namespace cupola::state
