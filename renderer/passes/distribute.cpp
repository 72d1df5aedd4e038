#include "renderer/passes/distribute.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

namespace cupola::passes {

namespace {

constexpr float shells_per_octave = 1.0f; ///< each costs a draw for every material and group of strips

/// A strip as a test and a projection.
struct Strip {
  glm::mat3 to_screen;   ///< from view space
  glm::vec3 left, right; ///< planes through the eye, inside where not negative
};

std::vector<Strip> strips_of(const plan::PieceSet& set) {
  std::vector<Strip> strips;
  for (const plan::Piece& piece : set.pieces)
    strips.push_back({glm::mat3(piece.to_screen), glm::vec3(piece.planes[0]), glm::vec3(piece.planes[1])});
  return strips;
}

/// Distributes the items of one batch.
class Task {
public:
  Task(const FrameGeometry& geometry, const StripView& view, std::span<const Strip> strips,
       std::uint32_t first_run, EmittedBatch& out)
      : geometry_(geometry)
      , view_(view)
      , strips_(strips)
      , out_(out)
      , to_axes_(view.azimuths.axes_from_view() * view.view_from_world)
      , groups_((strips.size() + static_cast<std::size_t>(view.group_size) - 1) /
                static_cast<std::size_t>(view.group_size))
      , indices_(depth_shells * groups_)
      , run_(first_run) {
    out_.clear();
  }

  void item(const DrawItem& item) {
    if (started_ && item.material != material_) {
      finish();
      ++run_;
    }
    material_ = item.material;
    started_ = true;
    if (item.radius >= 0.0f && !view_.azimuths.full_turn() &&
        view_.azimuths.sphere(to_axes_ * (item.center - view_.eye), item.radius).count == 0)
      return;
    const content::Material& material = geometry_.materials[item.material];
    blended_ = material.alpha_mode == content::AlphaMode::blend;
    const bool double_sided = material.double_sided;
    for (std::uint32_t i = 0; i + 2 < item.index_count; i += 3) triangle(item.first_index + i, double_sided);
  }

  /// The triangles of a run go to the batch, group by group.
  void finish() {
    const auto materials = static_cast<std::uint32_t>(geometry_.materials.size());
    const auto groups = static_cast<std::uint32_t>(groups_);
    for (std::uint32_t i = 0; i < indices_.size(); ++i)
      out_.take(indices_[i], material_, blended_ ? run_ : i / groups * materials + material_, i % groups);
  }

private:
  struct Corner {
    std::uint32_t index;
    const content::Vertex* vertex;
    glm::vec3 offset, view;
  };
  using Corners = std::array<Corner, 3>;

  void triangle(std::uint32_t first_index, bool double_sided) {
    Corners corners;
    for (std::uint32_t i = 0; i < 3; ++i) {
      Corner& corner = corners[i];
      corner.index = geometry_.index(first_index + i);
      corner.vertex = &geometry_.vertex(corner.index);
      corner.offset = corner.vertex->position - view_.eye;
    }
    const glm::vec3 normal =
        glm::cross(corners[1].offset - corners[0].offset, corners[2].offset - corners[0].offset);
    if (!double_sided && glm::dot(normal, corners[0].offset) >= 0.0f) return;
    std::array<float, 3> azimuths;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i].view = view_.view_from_world * corners[i].offset;
      azimuths[i] = azimuth_of(corners[i]);
    }
    const StripRange range = view_.azimuths.triangle(azimuths[0], azimuths[1], azimuths[2]);
    for (int i = 0; i < range.count; ++i) emit(corners, (range.first + i) % view_.azimuths.count());
  }

  void emit(const Corners& corners, int number) {
    const Strip& strip = strips_[static_cast<std::size_t>(number)];
    std::array<glm::vec3, 3> h;
    int above = 0, below = 0, before = 0, left = 0, right = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      h[i] = strip.to_screen * corners[i].view;
      above += h[i].y > h[i].z ? 1 : 0;
      below += h[i].y < -h[i].z ? 1 : 0;
      before += h[i].z < view_.near ? 1 : 0;
      left += glm::dot(strip.left, corners[i].view) < 0.0f ? 1 : 0;
      right += glm::dot(strip.right, corners[i].view) < 0.0f ? 1 : 0;
    }
    if (above == 3 || below == 3 || before == 3 || left == 3 || right == 3) return;
    ++out_.pairs;
    const std::size_t shell =
        blended_ ? 0 : depth_shell(std::min({h[0].z, h[1].z, h[2].z}), shells_per_octave);
    std::vector<std::uint32_t>& indices =
        indices_[shell * groups_ + static_cast<std::size_t>(number / view_.group_size)];
    for (std::size_t i = 0; i < 3; ++i) indices.push_back(vertex(corners[i], i, h[i], number));
  }

  /// The emitted vertex of a corner; one that a neighbour has emitted for the same strip is used again.
  std::uint32_t vertex(const Corner& corner, std::size_t which, const glm::vec3& h, int strip) {
    const auto next = static_cast<std::uint32_t>(out_.vertices.size());
    if (!view_.edges) {
      Shared& entry =
          shared_[(corner.index * 31u + static_cast<std::uint32_t>(strip) * 7u) & (shared_.size() - 1)];
      if (entry.vertex == corner.index && entry.strip == strip) return entry.emitted;
      entry = {corner.index, strip, next};
    }
    const content::Vertex& own = *corner.vertex;
    out_.vertices.push_back({{h.x, h.y, static_cast<float>(strip % view_.group_size), h.z},
                             corner.offset,
                             pack_normal(own.normal),
                             own.uv,
                             own.color,
                             {which == 0 ? 1.0f : 0.0f, which == 1 ? 1.0f : 0.0f}});
    return next;
  }

  float azimuth_of(const Corner& corner) {
    Azimuth& entry = azimuths_[corner.index & (azimuths_.size() - 1)];
    if (entry.vertex != corner.index)
      entry = {corner.index, StripAzimuths::azimuth(to_axes_ * corner.offset)};
    return entry.azimuth;
  }

  struct Azimuth {
    std::uint32_t vertex = ~0u;
    float azimuth = 0.0f;
  };
  struct Shared {
    std::uint32_t vertex = ~0u;
    int strip = -1;
    std::uint32_t emitted = 0;
  };

  const FrameGeometry& geometry_;
  const StripView& view_;
  std::span<const Strip> strips_;
  EmittedBatch& out_;
  glm::mat3 to_axes_;
  std::size_t groups_;                              ///< of strips
  std::vector<std::vector<std::uint32_t>> indices_; ///< of the run in the making, by shell and group
  std::uint32_t material_ = 0, run_;
  bool started_ = false, blended_ = false;
  std::array<Azimuth, 1024> azimuths_{};
  std::array<Shared, 4096> shared_{};
};

constexpr std::uint32_t indices_per_task = 3 * 2048;

} // namespace

void distribute_strips(const FrameGeometry& geometry, std::span<const DrawItem> items, const StripView& view,
                       std::vector<EmittedBatch>& batches) {
  const std::vector<Strip> strips = strips_of(view.set);
  const std::vector<TaskItems> tasks = split_items(items, indices_per_task);
  batches.resize(tasks.size());
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
    Task task(geometry, view, strips, tasks[i].first_run, batches[i]);
    for (const DrawItem& item : tasks[i].items) task.item(item);
    task.finish();
  });
}

} // namespace cupola::passes
