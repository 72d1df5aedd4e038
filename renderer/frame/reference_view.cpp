#include "renderer/frame/reference_view.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <pthread.h>
#include <thread>

#include "renderer/reference/picture.h"
#include "renderer/reference/tracer.h"

namespace cupola::frame {

struct ReferenceView::Impl {
  struct Job {
    std::shared_ptr<const Stage> stage;
    projection::Map map;
    int width = 0, height = 0;
    plan::CameraPose camera;
    double time = 0.0;
  };

  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Job> job; ///< next to be traced
  bool tracing = false;
  std::optional<reference::Picture> finished; ///< newest, not uploaded yet
  ReferenceOptions options;
  bool failed = false;      ///< the picture last traced
  model::Problems problems; ///< why
  std::atomic<bool> cancel{false};
  bool stop = false;

  gl::Texture texture;
  int width = 0, height = 0;

  std::jthread worker{[this] { run(); }}; // last: it uses all of the above

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
      cancel = true;
    }
    changed.notify_all();
  }

  void run() {
    pthread_setname_np(pthread_self(), "rays");
    std::shared_ptr<const content::Scene> scene;
    std::unique_ptr<reference::Tracer> tracer;
    content::Pose pose;
    for (;;) {
      Job now;
      ReferenceOptions wanted;
      {
        std::unique_lock lock(mutex);
        changed.wait(lock, [this] { return stop || job.has_value(); });
        if (stop) return;
        now = std::move(*job);
        job.reset();
        tracing = true;
        cancel = false;
        wanted = options;
      }
      if (scene != now.stage->scene) {
        scene = now.stage->scene;
        tracer = std::make_unique<reference::Tracer>(scene);
      }
      if (scene->rig) {
        content::pose(*scene, now.time, glm::vec3(now.camera.position), pose);
        tracer->move(pose);
      }
      const model::Show& show = *now.stage->show;
      reference::Request request;
      request.eye = now.camera.position;
      request.orientation = now.camera.orientation;
      request.near = show.camera.near;
      request.map = now.map;
      request.scene = show.scene;
      request.background = show.background;
      request.rect = {0, 0, now.width, now.height};
      const int drawn = show.quality.samples * show.quality.supersampling * show.quality.supersampling;
      request.samples = wanted.samples > 0 ? wanted.samples : drawn;
      request.threads = wanted.threads;
      request.progress = wanted.progress;
      request.cancel = &cancel;
      reference::Picture picture(now.width, now.height, glm::dvec3(0.0));
      const bool whole = tracer->render(request, picture);
      {
        const std::lock_guard lock(mutex);
        if (whole && !cancel) finished = std::move(picture);
        failed = !whole && !cancel;
        if (failed) problems = tracer->problems();
        tracing = false;
      }
      changed.notify_all();
    }
  }

  void upload() {
    std::optional<reference::Picture> picture;
    {
      const std::lock_guard lock(mutex);
      picture.swap(finished);
    }
    if (!picture) return;
    if (width != picture->width || height != picture->height || !texture) {
      width = picture->width;
      height = picture->height;
      texture = gl::Texture::make(GL_TEXTURE_2D);
      glTextureStorage2D(texture.id(), 1, GL_SRGB8_ALPHA8, width, height);
    }
    const std::vector<std::uint8_t> bytes = reference::encoded(*picture);
    const std::size_t row = static_cast<std::size_t>(width) * 4;
    for (int y = 0; y < height; ++y) // GL's row 0 is the lowest
      glTextureSubImage2D(texture.id(), 0, 0, height - 1 - y, width, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                          bytes.data() + static_cast<std::size_t>(y) * row);
  }
};

ReferenceView::ReferenceView()
    : impl_(std::make_unique<Impl>()) {}
ReferenceView::~ReferenceView() = default;

void ReferenceView::request(std::shared_ptr<const Stage> stage, const plan::ViewportPlan& viewport,
                            const plan::CameraPose& camera, double time) {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->tracing || impl_->job || impl_->finished) return;
    impl_->job =
        Impl::Job{std::move(stage), viewport.map, viewport.rect.width, viewport.rect.height, camera, time};
  }
  impl_->changed.notify_all();
}

bool ReferenceView::forget() {
  impl_->texture = {};
  const std::lock_guard lock(impl_->mutex);
  impl_->job.reset();
  impl_->finished.reset();
  impl_->failed = false;
  if (impl_->tracing) impl_->cancel = true;
  return !impl_->tracing;
}

bool ReferenceView::has_answer() const {
  if (impl_->texture) return true;
  const std::lock_guard lock(impl_->mutex);
  return impl_->finished.has_value() || impl_->failed;
}

void ReferenceView::set_options(ReferenceOptions options) {
  const std::lock_guard lock(impl_->mutex);
  impl_->options = std::move(options);
}

void ReferenceView::wait() {
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock, [this] {
    return impl_->finished.has_value() || impl_->stop || (impl_->failed && !impl_->tracing && !impl_->job);
  });
}

model::Problems ReferenceView::take_problems() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->problems, {});
}

GLuint ReferenceView::texture() {
  impl_->upload();
  return impl_->texture.id();
}

} // namespace cupola::frame
