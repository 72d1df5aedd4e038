#include "renderer/reference/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <embree3/rtcore.h>
#include <glm/vec2.hpp>
#include <limits>
#include <mutex>
#include <optional>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <vector>

#include "renderer/content/lighting.h"
#include "renderer/reference/surface.h"

namespace cupola::reference {
namespace {

constexpr int tile = 16;               ///< pixels along an edge
constexpr std::size_t max_layers = 64; ///< of blended surfaces behind each other
constexpr float opaque_enough = 1e-4f;

struct DeviceDeleter {
  void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }
};

/// Triangles as last seen from the eye: neighbouring samples mostly meet the same ones.
class SeenTriangles {
public:
  const SeenTriangle& get(const World& world, std::uint32_t triangle, const glm::dvec3& eye) {
    SeenTriangle& seen = slots_[triangle % slots_.size()];
    if (seen.triangle != triangle) seen = see_triangle(world, triangle, eye);
    return seen;
  }

private:
  std::array<SeenTriangle, 64> slots_{};
};

/// One ray on its way; Embree hands it to the filter. The context must stand first.
struct Shot {
  RTCIntersectContext context;
  const World* world;
  const Shading* shading;
  const Ray* ray;
  SeenTriangles* seen;
  std::array<std::uint32_t, max_layers> passed; ///< blended triangles already met
  std::size_t passed_count;
};

/// Whether a surface that the ray would meet lets it through: seen from its culled back, cut out, or met
/// before.
bool is_passed(Shot& shot, std::uint32_t triangle) {
  const auto* end = shot.passed.data() + shot.passed_count;
  if (std::find(static_cast<const std::uint32_t*>(shot.passed.data()), end, triangle) != end) return true;
  const content::Material& material = shot.world->material(triangle);
  const bool mask = material.alpha_mode == content::AlphaMode::mask;
  if (material.double_sided && !mask) return false;
  const SeenTriangle& seen = shot.seen->get(*shot.world, triangle, shot.shading->eye);
  const Crossing crossing = cross_triangle(seen, *shot.ray);
  if (!material.double_sided && !crossing.front) return true;
  return mask && base_alpha(*shot.world, *shot.shading, seen, crossing) < material.alpha_cutoff;
}

void filter(const RTCFilterFunctionNArguments* arguments) {
  auto* shot = reinterpret_cast<Shot*>(arguments->context);
  const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
  if (arguments->valid[0] == -1 && is_passed(*shot, triangle)) arguments->valid[0] = 0;
}

RTCRay embree_ray(const glm::dvec3& eye, const Ray& ray, double near) {
  RTCRay out{};
  out.org_x = static_cast<float>(eye.x);
  out.org_y = static_cast<float>(eye.y);
  out.org_z = static_cast<float>(eye.z);
  out.dir_x = static_cast<float>(ray.direction.x);
  out.dir_y = static_cast<float>(ray.direction.y);
  out.dir_z = static_cast<float>(ray.direction.z);
  out.tnear = static_cast<float>(near);
  out.tfar = std::numeric_limits<float>::infinity();
  out.mask = ~0u;
  return out;
}

/// Embree's copy of the triangles. Null where it has no memory for them.
RTCGeometry make_geometry(RTCDevice device, const std::vector<content::Vertex>& vertices,
                          const std::vector<std::uint32_t>& indices) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), indices.size() / 3));
  if (!corner || !index) {
    rtcReleaseGeometry(geometry);
    return nullptr;
  }
  for (const content::Vertex& vertex : vertices)
    for (int i = 0; i < 3; ++i) *corner++ = vertex.position[i];
  std::copy(indices.begin(), indices.end(), index);
  rtcCommitGeometry(geometry);
  return geometry;
}

/// The part of the viewport that is traced, in its own pixels.
Rect traced(const Request& request, const Picture& picture) {
  const Rect& rect = request.rect;
  const bool all = request.window.width <= 0 || request.window.height <= 0;
  const Rect window = all ? rect : request.window;
  const int left = std::max({0, rect.x, window.x}), top = std::max({0, rect.y, window.y});
  const int right = std::min({picture.width, rect.x + rect.width, window.x + window.width});
  const int bottom = std::min({picture.height, rect.y + rect.height, window.y + window.height});
  return {left - rect.x, top - rect.y, std::max(right - left, 0), std::max(bottom - top, 0)};
}

/// What a ray meets at a distance in lengths of its direction.
struct Layer {
  double distance;
  glm::vec4 met; ///< colour and opacity
};

/// What a thread keeps from pixel to pixel.
struct Scratch {
  SeenTriangles seen;
  std::vector<Layer> layers;
};

/// Colour and opacity of layers, nearest first; colours are multiplied by opacity already.
glm::vec4 composed(const std::vector<Layer>& layers) {
  glm::vec3 color(0.0f);
  float through = 1.0f;
  for (const Layer& layer : layers) {
    color += through * layer.met.a * glm::vec3(layer.met);
    through *= 1.0f - layer.met.a;
    if (through < opaque_enough) break;
  }
  return {color, 1.0f - through};
}

/// A viewport's pixels and their rays.
class Camera {
public:
  explicit Camera(const Request& request)
      : request_(request)
      , folds_(projection::folds(request.map)) {}

  /// Several rays may go through a place: those of covering().
  [[nodiscard]] bool folds() const { return folds_; }

  /// Ray through a place of the viewport in pixels, y downwards; world axes.
  [[nodiscard]] std::optional<glm::dvec3> ray(glm::dvec2 place) const {
    return in_world(projection::ray(request_.map, image_point(place)));
  }

  [[nodiscard]] std::vector<std::uint32_t> covering(glm::dvec2 place) const {
    return projection::covering(request_.map, image_point(place));
  }

  /// The ray of one of covering(), and how it changes.
  [[nodiscard]] std::optional<Ray> ray_by(std::uint32_t triangle, glm::dvec2 place) const {
    const auto at = [&](glm::dvec2 step) {
      return in_world(projection::ray_by(request_.map, triangle, image_point(place + step)));
    };
    const auto here = at({0.0, 0.0}), right = at({1.0, 0.0}), up = at({0.0, -1.0});
    if (!here || !right || !up) return std::nullopt;
    return Ray{*here, *right - *here, *up - *here};
  }

  /// Change of the ray per pixel along `step`, over one pixel around `place`; from one side alone at a border
  /// of what the projection shows.
  [[nodiscard]] glm::dvec3 change(glm::dvec2 place, glm::dvec2 step) const {
    const auto before = ray(place - 0.5 * step), after = ray(place + 0.5 * step);
    if (before && after) return *after - *before;
    const auto here = ray(place);
    if (here && after) return 2.0 * (*after - *here);
    if (here && before) return 2.0 * (*here - *before);
    return glm::dvec3(0.0);
  }

private:
  [[nodiscard]] glm::dvec2 image_point(glm::dvec2 place) const {
    return {2.0 * place.x / request_.rect.width - 1.0, 1.0 - 2.0 * place.y / request_.rect.height};
  }
  [[nodiscard]] std::optional<glm::dvec3> in_world(const std::optional<glm::dvec3>& view) const {
    if (!view) return std::nullopt;
    return request_.orientation * *view;
  }

  const Request& request_;
  bool folds_;
};

} // namespace

struct Tracer::Impl {
  World world;
  std::unique_ptr<RTCDeviceTy, DeviceDeleter> device;
  std::unique_ptr<RTCSceneTy, SceneDeleter> scene;
  model::Problems problems;

  void build();
  void trace(const Request& request, const Shading& shading, const Ray& ray, glm::vec2 pixel,
             Scratch& scratch) const;
  [[nodiscard]] bool trace_covers(const Request& request, const Camera& camera, const Shading& shading,
                                  glm::dvec2 place, glm::vec2 pixel, Scratch& scratch) const;
  [[nodiscard]] glm::vec4 pixel(const Request& request, const Camera& camera, const Shading& shading,
                                Scratch& scratch, int x, int y, const glm::vec4& beneath,
                                int picture_height) const;
};

void Tracer::Impl::build() {
  problems.clear();
  scene.reset(device ? rtcNewScene(device.get()) : nullptr);
  if (scene) {
    rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                             RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    const auto& indices = world.scene->geometry.indices;
    if (!indices.empty()) {
      if (RTCGeometry geometry = make_geometry(device.get(), world.vertices(), indices)) {
        rtcAttachGeometry(scene.get(), geometry);
        rtcReleaseGeometry(geometry);
      }
    }
    rtcCommitScene(scene.get());
  }
  const RTCError error = rtcGetDeviceError(device.get());
  if (scene && error == RTC_ERROR_NONE) return;
  scene.reset();
  problems.push_back(
      {.code = model::Code::rays_unavailable,
       .pointer = "",
       .expected =
           "a ray structure of " + std::to_string(world.scene->geometry.indices.size() / 3) + " triangles",
       .found = "Embree's error " + std::to_string(static_cast<int>(error)),
       .advice = error == RTC_ERROR_OUT_OF_MEMORY ? "Use a smaller scene or more memory." : ""});
}

/// Adds what the ray meets, nearest first, up to something opaque.
void Tracer::Impl::trace(const Request& request, const Shading& shading, const Ray& ray, glm::vec2 place,
                         Scratch& scratch) const {
  Shot shot;
  rtcInitIntersectContext(&shot.context);
  shot.context.filter = filter;
  shot.world = &world;
  shot.shading = &shading;
  shot.ray = &ray;
  shot.seen = &scratch.seen;
  shot.passed_count = 0;

  float through = 1.0f;
  RTCRayHit hit{};
  hit.ray = embree_ray(request.eye, ray, request.near);
  while (true) {
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.get(), &shot.context, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
    const SeenTriangle& triangle = scratch.seen.get(world, hit.hit.primID, request.eye);
    const glm::vec4 met = surface_color(world, shading, triangle, cross_triangle(triangle, ray), place);
    scratch.layers.push_back({hit.ray.tfar, met});
    through *= 1.0f - met.a;
    if (through < opaque_enough || shot.passed_count == max_layers) break;
    shot.passed[shot.passed_count++] = hit.hit.primID;
    hit.ray.tnear = hit.ray.tfar; // the same place again, for surfaces that lie in one plane
    hit.ray.tfar = std::numeric_limits<float>::infinity();
  }
}

/// All that is met along the rays of a place in a fold, by distance. False where nothing is shown.
bool Tracer::Impl::trace_covers(const Request& request, const Camera& camera, const Shading& shading,
                                glm::dvec2 place, glm::vec2 pixel, Scratch& scratch) const {
  const std::vector<std::uint32_t> covering = camera.covering(place);
  for (const std::uint32_t triangle : covering)
    if (const auto ray = camera.ray_by(triangle, place)) trace(request, shading, *ray, pixel, scratch);
  std::stable_sort(scratch.layers.begin(), scratch.layers.end(),
                   [](const Layer& a, const Layer& b) { return a.distance < b.distance; });
  return !covering.empty();
}

glm::vec4 Tracer::Impl::pixel(const Request& request, const Camera& camera, const Shading& shading,
                              Scratch& scratch, int x, int y, const glm::vec4& beneath,
                              int picture_height) const {
  const glm::dvec2 corner(x, y);
  const glm::dvec2 center = corner + 0.5;
  const glm::dvec2 right(1.0, 0.0), up(0.0, -1.0);
  Ray ray{};
  const bool smooth = !camera.folds() && camera.ray(center).has_value();
  if (smooth) {
    ray.per_x = camera.change(center, right);
    ray.per_y = camera.change(center, up);
  }
  const auto follow = [&](glm::dvec2 place, glm::vec2 in_picture) {
    if (camera.folds()) return trace_covers(request, camera, shading, place, in_picture, scratch);
    const auto direction = camera.ray(place);
    if (!direction) return false;
    ray.direction = *direction;
    if (!smooth) {
      ray.per_x = camera.change(place, right);
      ray.per_y = camera.change(place, up);
    }
    trace(request, shading, ray, in_picture, scratch);
    return true;
  };
  const glm::vec3 background(request.background);
  glm::dvec4 sum(0.0);
  for (int i = 0; i < request.samples; ++i) {
    const glm::dvec2 place = corner + sample_position(i, request.samples);
    scratch.layers.clear();
    if (!follow(place, {request.rect.x + place.x, picture_height - (request.rect.y + place.y)})) {
      sum += glm::dvec4(beneath);
      continue;
    }
    const glm::vec4 met = composed(scratch.layers);
    sum += glm::dvec4(glm::vec3(met) + (1.0f - met.a) * background, met.a);
  }
  return glm::vec4(sum / static_cast<double>(request.samples));
}

Tracer::Tracer(std::shared_ptr<const content::Scene> scene, const content::Pose* pose)
    : impl_(std::make_unique<Impl>()) {
  World& world = impl_->world;
  world.scene = std::move(scene);
  world.images.resize(world.scene->images.size());
  tbb::parallel_for(std::size_t{0}, world.images.size(), [&world](std::size_t i) {
    world.images[i] = content::make_mipmaps(world.scene->images[i]);
  });
  world.material_of_triangle.resize(world.scene->geometry.indices.size() / 3);
  for (const content::Cluster& cluster : world.scene->geometry.clusters)
    std::fill_n(world.material_of_triangle.begin() + cluster.first_index / 3, cluster.index_count / 3,
                cluster.material);
  impl_->device.reset(rtcNewDevice(nullptr));
  if (pose)
    move(*pose);
  else
    impl_->build();
}

Tracer::~Tracer() = default;

const model::Problems& Tracer::problems() const { return impl_->problems; }

void Tracer::move(const content::Pose& pose) {
  World& world = impl_->world;
  const auto& still = world.scene->geometry.vertices;
  world.moved.assign(still.begin(), still.begin() + world.scene->static_vertices);
  world.moved.insert(world.moved.end(), pose.vertices.begin(), pose.vertices.end());
  world.moved_lights = pose.lights;
  world.posed = true;
  impl_->build();
}

bool Tracer::render(const Request& request, Picture& picture) const {
  if (!impl_->problems.empty()) return false;
  const Camera camera(request);
  Shading shading;
  shading.lighting = content::lighting_of(request.scene);
  shading.style = request.scene.style;
  shading.eye = request.eye;
  shading.sample_width =
      static_cast<float>(1.0 / std::sqrt(static_cast<double>(std::max(request.samples, 1))));

  const Rect part = traced(request, picture);
  const int across = (part.width + tile - 1) / tile, down = (part.height + tile - 1) / tile;
  std::mutex reporting;
  int done = 0;
  bool complete = true;
  const auto draw = [&](int number) {
    if (request.cancel && request.cancel->load(std::memory_order_relaxed)) {
      const std::lock_guard lock(reporting);
      complete = false;
      return;
    }
    Scratch scratch;
    const int left = part.x + number % across * tile, top = part.y + number / across * tile;
    for (int y = top; y < std::min(top + tile, part.y + part.height); ++y)
      for (int x = left; x < std::min(left + tile, part.x + part.width); ++x) {
        glm::vec4& target = picture.at(request.rect.x + x, request.rect.y + y);
        target = impl_->pixel(request, camera, shading, scratch, x, y, target, picture.height);
      }
    const std::lock_guard lock(reporting);
    ++done;
    if (request.progress) request.progress(static_cast<double>(done) / (across * down));
  };
  const auto most =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  tbb::task_arena arena(request.threads > 0 ? std::min(request.threads, most) : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_for(0, across * down, draw); });
  return complete;
}

glm::dvec2 sample_position(int index, int count) {
  double reversed = 0.0, digit = 0.5; // the index's binary digits, mirrored at the point
  for (unsigned rest = static_cast<unsigned>(index); rest != 0; rest >>= 1, digit *= 0.5)
    if (rest & 1u) reversed += digit;
  const double half = 0.5 / count;
  const double y = reversed + half;
  return {(index + 0.5) / count, y < 1.0 ? y : y - 1.0};
}

} // namespace cupola::reference
