#include "server/control/http/pictures.h"

#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <pthread.h>
#include <thread>
#include <utility>
#include <vector>

namespace cupola::control {

namespace {

using Clock = std::chrono::steady_clock;

/// The requests for one key: those whose snapshot is under way, and those that wait for the next one.
struct Flight {
  std::vector<Pictures::Deliver> now, next;
  Clock::time_point deadline;
  std::uint64_t number = 0; ///< a snapshot that comes after its time is told by it
};

struct Job {
  PictureKey key;
  model::Result<RgbPicture> picture;
  std::vector<Pictures::Deliver> waiting;
};

} // namespace

struct Pictures::Core : std::enable_shared_from_this<Core> {
  Core(SnapshotSource given, std::chrono::milliseconds how_long)
      : source(std::move(given))
      , patience(how_long) {}

  void launch(const PictureKey& key, std::uint64_t number);
  void arrived(const PictureKey& key, std::uint64_t number, model::Result<RgbPicture> picture);
  void give_up_on_late(Clock::time_point now);
  void run();

  const SnapshotSource source;
  const std::chrono::milliseconds patience;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<PictureKey, Flight> flights;
  std::deque<Job> jobs;
  std::uint64_t last_number = 0;
  bool stop = false;
};

void Pictures::Core::launch(const PictureKey& key, std::uint64_t number) {
  source(key.output, [weak = weak_from_this(), key, number](model::Result<RgbPicture> picture) {
    if (const auto core = weak.lock()) core->arrived(key, number, std::move(picture));
  });
}

void Pictures::Core::arrived(const PictureKey& key, std::uint64_t number, model::Result<RgbPicture> picture) {
  std::optional<std::uint64_t> again;
  {
    const std::lock_guard lock(mutex);
    const auto it = flights.find(key);
    if (stop || it == flights.end() || it->second.number != number) return;
    Flight& flight = it->second;
    jobs.push_back({key, std::move(picture), std::exchange(flight.now, std::exchange(flight.next, {}))});
    if (flight.now.empty()) {
      flights.erase(it);
    } else {
      again = flight.number = ++last_number;
      flight.deadline = Clock::now() + patience;
    }
  }
  changed.notify_one();
  if (again) launch(key, *again);
}

/// With the lock held: flights beyond their time become failed jobs.
void Pictures::Core::give_up_on_late(Clock::time_point now) {
  for (auto it = flights.begin(); it != flights.end();) {
    Flight& flight = it->second;
    if (flight.deadline > now) {
      ++it;
      continue;
    }
    std::vector<Deliver> all = std::move(flight.now);
    for (Deliver& one : flight.next) all.push_back(std::move(one));
    jobs.push_back({it->first,
                    model::failure({model::Code::no_picture,
                                    "/outputs/" + it->first.output,
                                    "a picture within " + std::to_string(patience.count()) + " ms",
                                    "none",
                                    "Does the output render?",
                                    {}}),
                    std::move(all)});
    it = flights.erase(it);
  }
}

void Pictures::Core::run() {
  pthread_setname_np(pthread_self(), "encode");
  std::unique_lock lock(mutex);
  while (!stop) {
    give_up_on_late(Clock::now());
    if (jobs.empty()) {
      auto until = Clock::time_point::max();
      for (const auto& [key, flight] : flights) until = std::min(until, flight.deadline);
      if (flights.empty())
        changed.wait(lock);
      else
        changed.wait_until(lock, until);
      continue;
    }
    Job job = std::move(jobs.front());
    jobs.pop_front();
    lock.unlock();
    const model::Result<std::string> bytes = job.picture
                                                 ? encode(scaled(*job.picture, job.key.width), job.key.format)
                                                 : tl::unexpected(job.picture.error());
    for (const Deliver& deliver : job.waiting) deliver(bytes);
    job = {};
    lock.lock();
  }
}

Pictures::Pictures(SnapshotSource source, std::chrono::milliseconds patience)
    : core_(std::make_shared<Core>(std::move(source), patience))
    , worker_([core = core_.get()] { core->run(); }) {}

Pictures::~Pictures() {
  {
    const std::lock_guard lock(core_->mutex);
    core_->stop = true;
  }
  core_->changed.notify_one();
  worker_.join();
}

void Pictures::request(const PictureKey& key, Deliver deliver) {
  std::optional<std::uint64_t> number;
  {
    const std::lock_guard lock(core_->mutex);
    Flight& flight = core_->flights[key];
    if (flight.now.empty()) {
      flight.now.push_back(std::move(deliver));
      number = flight.number = ++core_->last_number;
      flight.deadline = Clock::now() + core_->patience;
    } else {
      flight.next.push_back(std::move(deliver));
    }
  }
  if (!number) return;
  core_->changed.notify_one(); // there is a deadline to watch
  core_->launch(key, *number);
}

} // namespace cupola::control
