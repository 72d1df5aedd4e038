#include "renderer/outputs/main_thread.h"

#include <doctest/doctest.h>
#include <poll.h>

#include <atomic>
#include <thread>

using cupola::outputs::MainThread;

namespace {

bool readable(int fd, int milliseconds) {
  pollfd entry{fd, POLLIN, 0};
  return poll(&entry, 1, milliseconds) == 1;
}

} // namespace

TEST_CASE("tasks run on the main thread, in order, and run() waits for them") {
  MainThread main;
  CHECK_FALSE(readable(main.fd(), 0));
  std::vector<int> order;
  std::thread::id ran_on;
  std::atomic<bool> returned = false;
  std::thread other([&] {
    main.post([&] { order.push_back(1); });
    main.run([&] {
      ran_on = std::this_thread::get_id();
      order.push_back(2);
    });
    returned = true;
  });
  while (!returned) {
    if (readable(main.fd(), 10)) main.serve();
  }
  other.join();
  CHECK(ran_on == std::this_thread::get_id());
  CHECK(order == std::vector<int>{1, 2});
}

TEST_CASE("on the main thread run() does not wait for itself") {
  MainThread main;
  bool ran = false;
  CHECK(main.run([&] { ran = true; }));
  CHECK(ran);
}

TEST_CASE("what waits at close() still runs, later tasks are refused") {
  MainThread main;
  int count = 0;
  CHECK(main.post([&] { ++count; }));
  main.close();
  CHECK(count == 1);
  CHECK_FALSE(main.post([&] { ++count; }));
  bool taken = true;
  std::thread([&] { taken = main.run([&] { ++count; }); }).join();
  CHECK_FALSE(taken);
  CHECK(count == 1);
}
