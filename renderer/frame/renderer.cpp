#include "renderer/frame/renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <glm/matrix.hpp>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "renderer/frame/automatic_quality.h"
#include "renderer/frame/fixed_programs.h"
#include "renderer/frame/method_choice.h"
#include "renderer/frame/realised.h"
#include "renderer/frame/reference_view.h"
#include "renderer/frame/scene_pose.h"
#include "renderer/passes/cubemap_pass.h"
#include "renderer/passes/frame_block.h"
#include "renderer/passes/gpu_pieces.h"
#include "renderer/passes/lookup_pass.h"
#include "renderer/passes/piece_area.h"
#include "renderer/passes/piece_lines.h"
#include "renderer/passes/scene_pass.h"
#include "renderer/plan/camera.h"

namespace cupola::frame {

namespace {

constexpr std::size_t upload_bytes_per_frame = 8u << 20;

} // namespace

/// What is kept of a viewport with triangular pieces as long as they stay.
struct Cells {
  std::shared_ptr<const plan::Plan> plan; ///< owns `set`
  const plan::PieceSet* set = nullptr;
  std::optional<passes::PieceTable> table;
  std::optional<passes::PieceArea> area;
  passes::Occlusion occlusion;
};

/// What the GPU engine keeps of a viewport; it is loaded anew when its pieces or its size have changed.
struct GpuView {
  passes::GpuPieces engine;
  std::shared_ptr<const plan::Plan> plan; ///< owns `set`
  const plan::PieceSet* set = nullptr;
  int scale = 0;
};

struct Renderer::Impl {
  explicit Impl(RendererOptions given)
      : options(std::move(given)) {}

  RendererOptions options;
  Device device = query_device();
  FixedPrograms fixed;
  passes::ScenePrograms programs;
  passes::ScenePass pass{programs};
  passes::LookupPass lookup;
  std::map<std::string, GpuView> gpu_views; ///< by output/viewport: each keeps its own list
  std::optional<passes::GpuPieces::Programs> gpu_programs;
  bool gpu_refused = false;           ///< the driver does not compile them
  std::map<std::string, Cells> cells; ///< by output/viewport
  std::map<std::string, ReferenceView> references;
  gl::VertexArray empty_array = gl::VertexArray::make();
  gl::Buffer frame_block = gl::Buffer::make();
  std::optional<Realised> current, next;
  AutomaticQuality quality{device, options.offline};
  MethodChoice choice;                                ///< for the viewports with method auto
  std::map<std::array<int, 3>, MethodChoice> choices; ///< for this work at other levels of quality
  std::shared_ptr<const Stage> waiting;
  model::Problems problems;
  std::vector<Picture> pictures;
  ScenePose moving;
  passes::DrawList list;

  void take_waiting();
  void upload(double time);
  void take_quality();
  void go_on_with(Realised realised);
  [[nodiscard]] model::Method method_of(const plan::ViewportPlan& viewport) const;
  [[nodiscard]] bool trying() const;
  [[nodiscard]] bool wants_cubemap() const;
  bool references_answer(double time);
  void drop_references();
  passes::FrameScene pose_scene(const plan::CameraPose& camera, double time);
  passes::DrawCounts draw_output(const plan::OutputPlan& output, const passes::FrameScene& scene,
                                 const plan::CameraPose& camera, double time);
  Cells& cells_of(const std::string& key, const plan::PieceSet& set);
  bool on_gpu();
  passes::DrawCounts draw_on_gpu(const std::string& key, const plan::ViewportPlan& viewport,
                                 const passes::FrameScene& scene, int scale);
  passes::DrawCounts draw_pieces(const std::string& key, const plan::ViewportPlan& viewport,
                                 const passes::FrameScene& scene, int scale);
  void draw_reference(const std::string& key, const plan::ViewportPlan& viewport,
                      const plan::CameraPose& camera, double time);
};

Renderer::Renderer(std::unique_ptr<Impl> impl)
    : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;

model::Result<std::unique_ptr<Renderer>> Renderer::make(RendererOptions options) {
  if (epoxy_gl_version() < 45)
    return model::failure(
        {model::Code::gl_unavailable,
         "",
         "an OpenGL 4.5 core context",
         std::to_string(epoxy_gl_version() / 10) + '.' + std::to_string(epoxy_gl_version() % 10),
         "Use a newer driver.",
         {},
         {}});
  model::Result<FixedPrograms> fixed = build_fixed();
  if (!fixed) return tl::unexpected(fixed.error());
  auto impl = std::make_unique<Impl>(std::move(options));
  impl->fixed = std::move(*fixed);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

const Device& Renderer::device() const { return impl_->device; }
const std::vector<Picture>& Renderer::pictures() const { return impl_->pictures; }
void Renderer::set_beside(double milliseconds) { impl_->quality.set_beside(milliseconds); }
model::Problems Renderer::take_problems() { return std::exchange(impl_->problems, {}); }

void Renderer::set_stage(std::shared_ptr<const Stage> stage) {
  const auto is = [&stage](const std::optional<Realised>& realised) {
    return realised && realised->stage == stage;
  };
  if (!stage || impl_->waiting == stage || is(impl_->next)) return;
  if (is(impl_->current) && !impl_->next && !impl_->waiting) return;
  impl_->waiting = std::move(stage);
}

/// A stage in the making that has the newest scene goes on with its upload under newer plain values; one
/// whose scene is out of date is dropped.
void Renderer::Impl::take_waiting() {
  if (!waiting) return;
  const Realised* before = current ? &*current : nullptr;
  if (next && next->stage->scene == waiting->scene) before = &*next;
  const auto make = [&](const model::Quality& wanted) { return realise(waiting, before, device, wanted); };
  const model::Quality wanted = quality.of(*waiting), least = AutomaticQuality::plainest(*waiting);
  model::Result<Realised> made = make(wanted);
  if (!made && wanted != least) made = make(least);
  waiting = nullptr;
  if (!made) {
    problems.insert(problems.end(), made.error().begin(), made.error().end());
    return;
  }
  next = std::move(*made);
}

namespace {

/// Calls f(key, viewport) for each viewport of a stage that rays are traced for.
template <class F>
void each_reference(const Stage& stage, F f) {
  for (const plan::OutputPlan& output : stage.plan->outputs)
    for (const plan::ViewportPlan& viewport : output.viewports)
      if (viewport.method == model::Method::reference) f(output.name + '/' + viewport.name, viewport);
}

} // namespace

/// Every viewport of the next stage that rays are traced for has a picture. Pictures that an earlier stage
/// asked for count too: edits that keep coming do not hold the swap up.
bool Renderer::Impl::references_answer(double time) {
  bool all = true;
  each_reference(*next->stage, [&](const std::string& key, const plan::ViewportPlan& viewport) {
    ReferenceView& view = references[key];
    if (view.has_answer()) return;
    view.set_options({options.reference_samples, 1, options.progress});
    view.request(next->stage, viewport, plan::camera_at(next->stage->show->camera, time), time);
    all = false;
  });
  return all;
}

/// What neither stage traces rays for is let go, so that nothing old is shown should it come back.
void Renderer::Impl::drop_references() {
  if (references.empty()) return;
  std::set<std::string> used;
  const auto note = [&](const std::string& key, const plan::ViewportPlan&) { used.insert(key); };
  if (current) each_reference(*current->stage, note);
  if (next) each_reference(*next->stage, note);
  for (auto it = references.begin(); it != references.end();)
    it = !used.contains(it->first) && it->second.forget() ? references.erase(it) : std::next(it);
}

namespace {

/// Both stages ask for about the same work: a measured choice of the method holds for both.
bool same_work(const Stage& a, const Stage& b) {
  const auto shapes = [](const model::Show& show) {
    std::vector<std::size_t> indices;
    for (const auto& [name, projection] : show.projections) indices.push_back(projection.shape.index());
    return indices;
  };
  return a.scene == b.scene && a.show->quality == b.show->quality && a.show->outputs == b.show->outputs &&
         a.show->scene.style.kind == b.show->scene.style.kind && shapes(*a.show) == shapes(*b.show);
}

bool any_viewport(const plan::Plan& plan, const auto& is) {
  for (const plan::OutputPlan& output : plan.outputs)
    if (std::any_of(output.viewports.begin(), output.viewports.end(), is)) return true;
  return false;
}

} // namespace

/// How a viewport is drawn in this frame.
model::Method Renderer::Impl::method_of(const plan::ViewportPlan& viewport) const {
  if (viewport.method != model::Method::automatic) return viewport.method;
  if (!viewport.pieces) return model::Method::cubemap;
  return options.offline && !options.measure_methods ? model::Method::piecewise : choice.method();
}

bool Renderer::Impl::trying() const {
  return choice.trying() && (!options.offline || options.measure_methods) &&
         any_viewport(*current->stage->plan, [](const plan::ViewportPlan& viewport) {
           return viewport.method == model::Method::automatic && viewport.pieces;
         });
}

bool Renderer::Impl::wants_cubemap() const {
  return current->cubemap && any_viewport(*current->stage->plan, [this](const plan::ViewportPlan& viewport) {
           return method_of(viewport) == model::Method::cubemap ||
                  (viewport.pieces && !viewport.pieces->looked_up.empty());
         });
}

void Renderer::Impl::upload(double time) {
  if (!next) return;
  if (!next->scene_ready) {
    if (!current || options.offline) {
      while (!next->scene->upload(upload_bytes_per_frame)) {}
      next->scene_ready = true;
    } else {
      next->scene_ready = next->scene->upload(upload_bytes_per_frame);
    }
  }
  if (!next->scene_ready) return;
  // At the start there is nothing better to show meanwhile; off-line, drawing waits.
  if (current && !options.offline && !references_answer(time)) return;
  if (current && same_work(*current->stage, *next->stage)) {
    go_on_with(std::move(*next));
  } else {
    choice.restart();
    choices.clear();
    quality.restart(*next->stage);
    current = std::move(*next);
  }
  next.reset();
}

/// The same work, perhaps at another level of quality: what is quicker there may be another method, and is
/// tried once.
void Renderer::Impl::go_on_with(Realised realised) {
  const auto key = [](const model::Quality& drawn) {
    return std::array{drawn.anisotropy, drawn.samples, drawn.supersampling};
  };
  if (realised.quality != current->quality) {
    choices[key(current->quality)] = choice;
    choice = choices[key(realised.quality)];
  }
  current = std::move(realised);
}

/// The stage goes on with the quality that is chosen now.
void Renderer::Impl::take_quality() {
  const model::Quality wanted = quality.of(*current->stage);
  if (wanted == current->quality) return;
  model::Result<Realised> made = realise(current->stage, &*current, device, wanted);
  if (!made) {
    quality.refuse();
    return;
  }
  go_on_with(std::move(*made));
}

passes::FrameScene Renderer::Impl::pose_scene(const plan::CameraPose& camera, double time) {
  const content::Scene& scene = current->scene->scene();
  const model::Show& show = *current->stage->show;
  const glm::vec3 eye(camera.position);
  moving.place(current->scene, time, eye);
  const content::Pose& pose = moving.pose();
  const auto& lights = scene.rig ? pose.lights : scene.lights;
  const std::span<const content::Cluster> clusters(scene.rig ? pose.clusters : scene.geometry.clusters);
  passes::order_for_eye(scene, clusters, pose.vertices, eye, list);
  if (!list.blended_indices.empty()) current->scene->set_indices(list.blended_first, list.blended_indices);

  const passes::FrameBlock block = passes::make_frame_block(show, camera, lights);
  glNamedBufferData(frame_block.id(), sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block.id());

  const std::span<const content::Vertex> vertices(scene.geometry.vertices);
  const passes::FrameGeometry geometry{scene.rig ? vertices.first(scene.static_vertices) : vertices,
                                       pose.vertices,
                                       scene.geometry.indices,
                                       {list.blended_indices, list.blended_first},
                                       scene.materials};
  return {*current->scene,
          list,
          geometry,
          eye,
          glm::mat3(glm::transpose(camera.orientation)),
          static_cast<float>(show.camera.near),
          show.scene.style.kind,
          !lights.empty(),
          device.software && current->samples > 1,
          show.debug.primitives};
}

Cells& Renderer::Impl::cells_of(const std::string& key, const plan::PieceSet& set) {
  Cells& own = cells[key];
  if (own.set != &set || own.plan != current->stage->plan) {
    own.plan = current->stage->plan;
    own.set = &set;
    own.table.emplace(set);
    own.area.emplace(set);
  }
  return own;
}

/// Pieces are drawn by the GPU engine.
bool Renderer::Impl::on_gpu() {
  const model::Engine engine = current->stage->show->pieces.engine;
  if (engine == model::Engine::cpu || (engine == model::Engine::automatic && device.software)) return false;
  if (gpu_programs || gpu_refused) return gpu_programs.has_value();
  model::Result<passes::GpuPieces::Programs> made = passes::GpuPieces::make_programs();
  gpu_refused = !made;
  if (made)
    gpu_programs = std::move(*made);
  else
    problems.insert(problems.end(), made.error().begin(), made.error().end());
  return gpu_programs.has_value();
}

passes::DrawCounts Renderer::Impl::draw_on_gpu(const std::string& key, const plan::ViewportPlan& viewport,
                                               const passes::FrameScene& scene, int scale) {
  const plan::PieceSet& set = *viewport.pieces;
  GpuView& own = gpu_views[key];
  if (own.set != &set || own.plan != current->stage->plan || own.scale != scale) {
    own.plan = current->stage->plan;
    own.set = &set;
    own.scale = scale;
    const glm::dvec2 pixels(viewport.rect.width * scale, viewport.rect.height * scale);
    if (set.strips)
      own.engine.load_strips(set, passes::StripAzimuths(set, viewport.map.orientation));
    else
      own.engine.load_triangles(set, *cells_of(key, set).table, pixels);
  }
  return own.engine.draw(*gpu_programs, pass, scene,
                         static_cast<std::uint64_t>(current->stage->show->pieces.max_replicated),
                         static_cast<float>(scale));
}

passes::DrawCounts Renderer::Impl::draw_pieces(const std::string& key, const plan::ViewportPlan& viewport,
                                               const passes::FrameScene& scene, int scale) {
  const plan::PieceSet& set = *viewport.pieces;
  if (set.pieces.size() == 1 && set.pieces.front().plane_count == 0) {
    passes::DrawCounts counts =
        pass.draw_direct(scene, set.pieces.front().to_screen, static_cast<float>(scale));
    counts.pairs = counts.triangles;
    return counts;
  }
  const glm::vec3 background(current->stage->show->background);
  Cells* own = set.strips ? nullptr : &cells_of(key, set);
  if (own) own->area->prepare(fixed.area, viewport.map, background, current->cubemap.get());
  if (on_gpu()) {
    if (own) own->area->draw_background(fixed.area, background, nullptr);
    return draw_on_gpu(key, viewport, scene, scale);
  }
  const auto ceiling = static_cast<std::uint64_t>(current->stage->show->pieces.max_replicated);
  if (!own)
    return pass.draw_strips_cpu(scene, set, passes::StripAzimuths(set, viewport.map.orientation), ceiling,
                                scale);
  return pass.draw_cells_cpu(scene, *own->table, own->occlusion, ceiling, scale,
                             [&] { own->area->draw_background(fixed.area, background, &own->occlusion); });
}

void Renderer::Impl::draw_reference(const std::string& key, const plan::ViewportPlan& viewport,
                                    const plan::CameraPose& camera, double time) {
  ReferenceView& view = references[key];
  view.set_options({options.reference_samples, options.offline ? 0 : 1, options.progress});
  view.request(current->stage, viewport, camera, time);
  if (options.offline) view.wait();
  model::Problems failed = view.take_problems();
  problems.insert(problems.end(), failed.begin(), failed.end());
  const GLuint texture = view.texture();
  if (texture == 0) return;
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glUseProgram(fixed.picture.id());
  glBindTextureUnit(0, texture);
  glBindSampler(0, 0);
  glBindVertexArray(empty_array.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

passes::DrawCounts Renderer::Impl::draw_output(const plan::OutputPlan& output,
                                               const passes::FrameScene& scene,
                                               const plan::CameraPose& camera, double time) {
  const passes::OutputTarget& target = *current->outputs.at(output.name);
  const glm::vec3 background(current->stage->show->background);
  const int scale = target.scale();
  passes::DrawCounts counts;
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  for (const plan::ViewportPlan& viewport : output.viewports) {
    const plan::PixelRect& r = viewport.rect;
    const std::array rect{r.x * scale, (output.height - r.y - r.height) * scale, r.width * scale,
                          r.height * scale};
    const std::string key = output.name + '/' + viewport.name;
    glViewport(rect[0], rect[1], rect[2], rect[3]);
    glScissor(rect[0], rect[1], rect[2], rect[3]);
    glEnable(GL_SCISSOR_TEST);
    switch (method_of(viewport)) {
    case model::Method::piecewise:
      passes::set_scene_state();
      if (viewport.pieces->strips) {
        glClearColor(background.r, background.g, background.b, 1.0f);
        glClearDepth(0.0);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
      }
      counts += draw_pieces(key, viewport, scene, scale);
      if (current->stage->show->debug.pieces) {
        glScissor(rect[0], rect[1], rect[2], rect[3]); // strips have moved it
        passes::PieceLines(*viewport.pieces, r, scale).draw(fixed.piece_lines);
      }
      break;
    case model::Method::cubemap:
      lookup.draw(viewport.map, *current->cubemap);
      break;
    case model::Method::automatic: // has been resolved
    case model::Method::reference:
      draw_reference(key, viewport, camera, time);
      break;
    }
    glDisable(GL_SCISSOR_TEST);
  }
  target.finish(fixed.downsample.id(), empty_array.id());
  pictures.push_back({output.name, target.picture(), target.width(), target.height()});
  return counts;
}

FrameStatistics Renderer::draw(double time) {
  impl_->take_waiting();
  impl_->upload(time);
  impl_->drop_references();
  FrameStatistics statistics;
  if (!impl_->current) return statistics;
  impl_->take_quality();
  const Realised& current = *impl_->current;
  const model::Show& show = *current.stage->show;
  const plan::CameraPose camera = plan::camera_at(show.camera, time);

  const bool trying = impl_->trying();
  if (trying) glFinish();
  impl_->quality.begin(*current.stage);
  const auto start = std::chrono::steady_clock::now();
  passes::set_scene_state();
  const passes::FrameScene scene = impl_->pose_scene(camera, time);
  passes::DrawCounts counts;
  if (impl_->wants_cubemap())
    counts += passes::draw_cubemap(impl_->pass, scene, *current.cubemap_plan, *current.cubemap,
                                   glm::vec3(show.background), current.cubemap_style_scale);
  impl_->pictures.clear();
  for (const plan::OutputPlan& output : current.stage->plan->outputs)
    counts += impl_->draw_output(output, scene, camera, time);
  if (trying) {
    glFinish();
    impl_->choice.record(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  impl_->quality.end(*current.stage, !trying && !impl_->next);
  for (const model::Problems& refused : {impl_->programs.take_problems(), impl_->lookup.take_problems()})
    impl_->problems.insert(impl_->problems.end(), refused.begin(), refused.end());

  statistics.revision = current.stage->revision;
  statistics.triangles = current.scene->scene().geometry.indices.size() / 3;
  statistics.drawn = counts.triangles;
  statistics.replicated = counts.pairs;
  statistics.vertex_bytes = current.scene->bytes() + counts.bytes;
  statistics.quality = {current.anisotropy, current.samples, current.quality.supersampling};
  statistics.automatic_quality = show.quality.automatic;
  statistics.uploading = impl_->next.has_value();
  return statistics;
}

} // namespace cupola::frame
