#include "server/control/loop.h"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <future>
#include <pthread.h>
#include <spdlog/spdlog.h>
#include <thread>

namespace cupola::control {

struct Loop::Impl {
  boost::asio::io_context context{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> guard{context.get_executor()};
  std::thread thread;

  void run() {
    pthread_setname_np(pthread_self(), "control");
    for (;;) {
      try {
        context.run();
        return;
      } catch (const std::exception& error) {
        spdlog::error("control: {}", error.what()); // one handler has failed; the others go on
      }
    }
  }
};

Loop::Loop()
    : impl_(std::make_unique<Impl>()) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

Loop::~Loop() {
  impl_->context.stop();
  impl_->thread.join();
}

boost::asio::io_context& Loop::context() { return impl_->context; }

void Loop::run_and_wait(const std::function<void()>& work) {
  std::promise<void> done;
  boost::asio::post(impl_->context, [&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

} // namespace cupola::control
