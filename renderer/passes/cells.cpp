#include "renderer/passes/cells.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "renderer/passes/cell_cut.h"
#include "renderer/passes/vertex_cache.h"

namespace cupola::passes {

namespace {

constexpr float shells_per_octave = 2.0f;
constexpr std::uint32_t prefetched = 3 * 8; ///< indices ahead of which vertices are fetched from memory
constexpr float rounding = 1e-5f;           ///< of depths and distances, relative

/// No point of a sphere is nearer to the eye.
float nearest_of_sphere(float distance, float radius) {
  return std::max(0.0f, distance - radius - rounding * (distance + radius));
}

/// A triangle of the scene as seen from the eye.
struct Triangle {
  std::uint32_t number; ///< of its first index: tells triangles apart
  std::array<std::uint32_t, 3> index;
  std::array<const content::Vertex*, 3> vertex;
  std::array<glm::vec3, 3> offset, view;
  /// Planes through the eye: edges[i] through the edge opposite corner i, not negative inside.
  std::array<glm::vec3, 3> edges;
  std::array<float, 3> lengths; ///< of `edges`
  float determinant;            ///< of the corners, made positive
  float nearest;                ///< no point of it is nearer to the eye, metres
  glm::vec3 axis;               ///< of a cone around it
  float sine, cosine;           ///< of the cone's half angle; cosine -1: no cone holds it
  bool opaque, blended;
  bool back; ///< seen from behind
};

/// What a thread keeps from task to task.
struct Scratch {
  VertexCache cache;
  std::array<std::vector<std::uint32_t>, depth_shells> indices; ///< of the run in the making, by shell
  std::vector<std::uint32_t> entries;                           ///< groups that the item is tried against
};

/// Distributes the items of one batch.
class Task {
public:
  Task(const FrameGeometry& geometry, const CellView& view, Occlusion& occlusion, Scratch& scratch,
       std::uint32_t number, EmittedBatch& out)
      : geometry_(geometry)
      , view_(view)
      , occlusion_(occlusion)
      , scratch_(scratch)
      , entries_(scratch.entries)
      , number_(number)
      , out_(out) {
    out_.clear();
  }

  void run(const TaskItems& task) {
    std::uint32_t material = task.items.front().material, run = task.first_run;
    for (const DrawItem& item : task.items) {
      if (item.material != material) finish(material, run++);
      material = item.material;
      this->item(item);
    }
    finish(material, run);
  }

private:
  /// Indices of one material go to the batch: shell by shell, or, where the order counts, as they stand.
  void finish(std::uint32_t material, std::uint32_t run) {
    const auto materials = static_cast<std::uint32_t>(geometry_.materials.size());
    for (std::uint32_t shell = 0; shell < depth_shells; ++shell)
      out_.take(scratch_.indices[shell], material, is_blended(material) ? run : shell * materials + material,
                0);
  }

  [[nodiscard]] bool is_blended(std::uint32_t material) const {
    return geometry_.materials[material].alpha_mode == content::AlphaMode::blend;
  }

  void item(const DrawItem& item) {
    find_entries(item);
    if (entries_.empty()) return;
    const content::Material& material = geometry_.materials[item.material];
    for (std::uint32_t i = 0; i + 2 < item.index_count; i += 3) {
      if (i + 2 + prefetched < item.index_count)
        for (std::uint32_t k = 0; k < 3; ++k)
          __builtin_prefetch(&geometry_.vertex(geometry_.index(item.first_index + i + prefetched + k)));
      triangle(item.first_index + i, material);
    }
  }

  /// Groups that the item's triangles are tried against: as small as a few of them get, without those in
  /// which all of the item is hidden.
  void find_entries(const DrawItem& item) {
    constexpr std::size_t enough = 8;
    const auto& groups = view_.pieces.groups();
    entries_.assign(1, 0);
    item_nearest_ = 0.0f;
    if (item.radius < 0.0f) return;
    const glm::vec3 center = view_.view_from_world * (item.center - view_.eye);
    item_nearest_ = nearest_of_sphere(glm::length(center), item.radius);
    for (std::size_t i = 0; i < entries_.size();) {
      const std::uint32_t at = entries_[i];
      const PieceTable::Group& group = groups[at];
      if (occlusion_.hides_in_group(at, item_nearest_) || !PieceTable::meets(group, center, item.radius)) {
        entries_[i] = entries_.back();
        entries_.pop_back();
      } else if (!group.is_leaf(at) && entries_.size() < enough) {
        entries_[i] = at + 1;
        entries_.push_back(groups[at + 1].next);
      } else {
        ++i;
      }
    }
    std::erase_if(entries_, [&](std::uint32_t entry) { return !may_show(entry, center, item.radius); });
  }

  /// Whether the sphere, all of it at least item_nearest_ away, may be seen in a piece of the group.
  [[nodiscard]] bool may_show(std::uint32_t entry, const glm::vec3& center, float radius) const {
    const auto& groups = view_.pieces.groups();
    const std::uint32_t end = groups[entry].next;
    for (std::uint32_t at = entry; at < end;) {
      const PieceTable::Group& group = groups[at];
      if (occlusion_.hides_in_group(at, item_nearest_) || !PieceTable::meets(group, center, radius))
        at = group.next;
      else if (group.is_leaf(at))
        return true;
      else
        ++at;
    }
    return false;
  }

  void triangle(std::uint32_t first_index, const content::Material& material) {
    Triangle t;
    t.number = first_index;
    for (std::uint32_t i = 0; i < 3; ++i) {
      t.index[i] = geometry_.index(first_index + i);
      t.vertex[i] = &geometry_.vertex(t.index[i]);
      t.offset[i] = t.vertex[i]->position - view_.eye;
    }
    const float facing =
        glm::dot(glm::cross(t.offset[1] - t.offset[0], t.offset[2] - t.offset[0]), t.offset[0]);
    t.back = facing >= 0.0f;
    if (t.back && !material.double_sided) return;
    for (std::size_t i = 0; i < 3; ++i) t.view[i] = view_.view_from_world * t.offset[i];
    for (std::size_t i = 0; i < 3; ++i) // by the difference: small triangles far away keep their digits
      t.edges[i] = glm::cross(t.view[(i + 1) % 3], t.view[(i + 2) % 3] - t.view[(i + 1) % 3]);
    t.determinant = glm::dot(t.edges[0], t.view[0]);
    if (t.determinant == 0.0f) return; // through the eye: seen edge on
    if (t.determinant < 0.0f) {
      t.determinant = -t.determinant;
      for (glm::vec3& edge : t.edges) edge = -edge;
    }
    for (std::size_t i = 0; i < 3; ++i) t.lengths[i] = glm::length(t.edges[i]);
    surround(t);
    t.blended = material.alpha_mode == content::AlphaMode::blend;
    t.opaque = material.alpha_mode == content::AlphaMode::opaque;
    flat_ = t.vertex[0]->normal == t.vertex[1]->normal && t.vertex[1]->normal == t.vertex[2]->normal;
    if (flat_) normal_ = pack_normal(t.vertex[0]->normal);
    for (const std::uint32_t entry : entries_) walk(t, entry);
  }

  /// The sphere around its middle: its cone, and the least distance to the eye.
  void surround(Triangle& t) const {
    const glm::vec3 middle = (t.view[0] + t.view[1] + t.view[2]) * (1.0f / 3.0f);
    float square = 0.0f;
    for (const glm::vec3& corner : t.view) {
      const glm::vec3 away = corner - middle;
      square = std::max(square, glm::dot(away, away));
    }
    const float distance = glm::length(middle), radius = std::sqrt(square);
    t.nearest = std::max(item_nearest_, nearest_of_sphere(distance, radius));
    t.cosine = -1.0f;
    if (radius >= 0.7f * distance) return;
    t.axis = middle / distance;
    t.sine = radius / distance + rounding;
    t.cosine = std::sqrt(1.0f - t.sine * t.sine);
  }

  void walk(const Triangle& t, std::uint32_t entry) {
    const auto& groups = view_.pieces.groups();
    const std::uint32_t end = groups[entry].next;
    for (std::uint32_t at = entry; at < end;) {
      const PieceTable::Group& group = groups[at];
      const Meeting meeting = occlusion_.hides_in_group(at, t.nearest) ? Meeting::none : meeting_of(t, group);
      if (meeting == Meeting::none) {
        at = group.next;
        continue;
      }
      if (meeting == Meeting::all) {
        for (std::uint32_t i = 0; i < group.count; ++i) whole_piece(t, group.first + i);
        at = group.next;
        continue;
      }
      if (group.is_leaf(at))
        for (std::uint32_t i = 0; i < group.count; ++i)
          if (!apart(t, view_.pieces.cones()[group.first + i])) piece(t, group.first + i);
      ++at;
    }
  }

  enum class Meeting : std::uint8_t { none, some, all };

  /// Whether the triangle's cone and another have no ray in common. Neither is wider than half a turn, so
  /// that the sum of their half angles is not more than that.
  static bool apart(const Triangle& t, const PieceTable::Cone& cone) {
    return t.cosine > 0.0f &&
           glm::dot(t.axis, cone.axis) < t.cosine * cone.cosine - t.sine * cone.sine - rounding;
  }

  /// A cone against the triangle's pyramid: beyond one of its planes, within all, or neither.
  static Meeting meeting_of(const Triangle& t, const PieceTable::Group& group) {
    if (group.cosine <= -1.0f) return Meeting::some;
    if (apart(t, group)) return Meeting::none;
    bool within = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const float height = glm::dot(t.edges[i], group.axis), reach = group.sine * t.lengths[i];
      if (height < -reach) return Meeting::none;
      within = within && height > reach;
    }
    return within ? Meeting::all : Meeting::some;
  }

  void piece(const Triangle& t, std::uint32_t number) {
    const PieceTable::Piece& piece = view_.pieces.pieces()[number];
    Polygon polygon;
    std::array<int, 3> outside{};
    for (std::size_t i = 0; i < 3; ++i) {
      Point point;
      for (int axis = 0; axis < 3; ++axis) {
        point.in_piece[axis] = glm::dot(piece.planes[static_cast<std::size_t>(axis)], t.view[i]);
        outside[static_cast<std::size_t>(axis)] += point.in_piece[axis] < 0.0f ? 1 : 0;
      }
      point.in_triangle = glm::vec3(0.0f);
      point.in_triangle[static_cast<int>(i)] = 1.0f;
      point.edges = static_cast<std::uint8_t>(7u & ~(1u << i)); // edge k lies opposite corner k
      point.border = -1;
      polygon.push(point);
    }
    if (outside[0] == 3 || outside[1] == 3 || outside[2] == 3) return;
    if (outside[0] + outside[1] + outside[2] > 0) {
      switch (coverage(t, piece)) {
      case Meeting::none:
        return;
      case Meeting::all:
        whole_piece(t, number);
        return;
      case Meeting::some:
        break;
      }
      Polygon other;
      for (int axis = 0; axis < 3; ++axis) {
        if (outside[static_cast<std::size_t>(axis)] == 0) continue;
        cut(polygon, axis, other);
        std::swap(polygon, other);
      }
      if (polygon.count == 0) return;
    }
    emit(t, polygon, number, piece);
  }

  /// The piece's rays against the triangle's planes.
  [[nodiscard]] Meeting coverage(const Triangle& t, const PieceTable::Piece& piece) const {
    bool within = true;
    for (std::size_t i = 0; i < 3; ++i) {
      int outside = 0;
      for (const std::uint32_t corner : piece.corners)
        outside += glm::dot(t.edges[i], view_.pieces.corners()[corner].ray) < 0.0f ? 1 : 0;
      if (outside == 3) return Meeting::none;
      within = within && outside == 0;
    }
    return within ? Meeting::all : Meeting::some;
  }

  [[nodiscard]] glm::vec3 landing(const PieceTable::Piece& piece, const glm::vec3& in_piece) const {
    const auto& corners = view_.pieces.corners();
    return in_piece.x * corners[piece.corners[0]].landing + in_piece.y * corners[piece.corners[1]].landing +
           in_piece.z * corners[piece.corners[2]].landing;
  }

  /// Where an edge of the scene crosses a border lands at the same place to the last bit, whichever of the
  /// two triangles at the edge and of the two pieces at the border asks: else a sample could fall between
  /// them.
  [[nodiscard]] glm::vec3 crossing(const Triangle& t, const Point& point,
                                   const PieceTable::Piece& piece) const {
    const std::size_t edge = first_edge(point);
    glm::vec3 p = t.view[(edge + 1) % 3], q = t.view[(edge + 2) % 3];
    if (std::array{q.x, q.y, q.z} < std::array{p.x, p.y, p.z}) std::swap(p, q);
    const auto border = static_cast<std::size_t>(point.border);
    const glm::vec3& normal = piece.borders[border];
    const auto [first, second] =
        std::minmax(piece.corners[(border + 1) % 3], piece.corners[(border + 2) % 3]);
    const PieceTable::Corner& a = view_.pieces.corners()[first];
    const PieceTable::Corner& b = view_.pieces.corners()[second];
    const float from = glm::dot(normal, p), to = glm::dot(normal, q);
    const float t_cross = from == to ? 0.0f : std::clamp(from / (from - to), 0.0f, 1.0f);
    const glm::vec3 at = p + t_cross * (q - p);
    const glm::vec3 beside_a = glm::cross(normal, a.ray), beside_b = glm::cross(normal, b.ray);
    return glm::dot(beside_b, at) / glm::dot(beside_b, a.ray) * a.landing +
           glm::dot(beside_a, at) / glm::dot(beside_a, b.ray) * b.landing;
  }

  static std::size_t first_edge(const Point& point) {
    return point.edges & 1u ? 0 : (point.edges & 2u ? 1 : 2);
  }

  void emit(const Triangle& t, const Polygon& polygon, std::uint32_t number, const PieceTable::Piece& piece) {
    std::array<glm::vec3, 6> h;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
    for (int i = 0; i < polygon.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Point& point = polygon.points[at];
      const bool crosses = point.border >= 0 && point.edges != 0;
      h[at] = crosses ? crossing(t, point, piece) : landing(piece, point.in_piece);
      nearest = std::min(nearest, h[at].z);
      farthest = std::max(farthest, h[at].z);
    }
    if (farthest < view_.near) return;
    ++out_.pairs;
    if (occlusion_.hides(number, nearest)) {
      ++out_.hidden;
      return;
    }
    std::array<std::uint32_t, 6> index;
    for (int i = 0; i < polygon.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      index[at] = vertex(t, polygon.points[at], h[at], number, piece);
    }
    // Fronts run counter-clockwise on the screen, also where the piece shows them mirrored.
    for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(polygon.count); ++i)
      add(t, nearest, {index[0], index[i], index[i + 1]}, piece.mirrored);
  }

  void add(const Triangle& t, float depth, std::array<std::uint32_t, 3> index, bool turned) {
    if (turned) std::swap(index[1], index[2]);
    std::vector<std::uint32_t>& indices =
        scratch_.indices[t.blended ? 0 : depth_shell(depth, shells_per_octave)];
    indices.insert(indices.end(), index.begin(), index.end());
  }

  /// The triangle covers all of the piece: its part is the piece itself.
  void whole_piece(const Triangle& t, std::uint32_t number) {
    const PieceTable::Piece& piece = view_.pieces.pieces()[number];
    std::array<Point, 3> points;
    std::array<glm::vec3, 3> h;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f, reach = 0.0f;
    for (std::size_t i = 0; i < 3; ++i) {
      const PieceTable::Corner& corner = view_.pieces.corners()[piece.corners[i]];
      const glm::vec3 share(glm::dot(t.edges[0], corner.ray), glm::dot(t.edges[1], corner.ray),
                            glm::dot(t.edges[2], corner.ray));
      const float sum = share.x + share.y + share.z;
      points[i] = {glm::vec3(0.0f), share / sum, 0, 3};
      h[i] = corner.landing * (t.determinant / sum);
      reach = std::max(reach, t.determinant / sum); // rays have length 1
      nearest = std::min(nearest, h[i].z);
      farthest = std::max(farthest, h[i].z);
    }
    if (farthest < view_.near) return;
    ++out_.pairs;
    if (occlusion_.hides(number, nearest)) {
      ++out_.hidden;
      return;
    }
    if (t.opaque && nearest >= view_.near)
      occlusion_.cover(number, farthest * (1.0f + rounding), reach * (1.0f + rounding));
    std::array<std::uint32_t, 3> index;
    for (std::size_t i = 0; i < 3; ++i) {
      index[i] = shared({t.number, piece.corners[i], ~0u, ~0u}, t, points[i], h[i]);
    }
    // Pieces run counter-clockwise on the screen.
    add(t, nearest, index, t.back);
  }

  std::uint32_t vertex(const Triangle& t, const Point& point, const glm::vec3& h, std::uint32_t number,
                       const PieceTable::Piece& piece) {
    VertexCache::Key key{};
    if (point.border < 0) {
      const std::size_t own = point.in_triangle.x == 1.0f ? 0 : (point.in_triangle.y == 1.0f ? 1 : 2);
      key = {t.index[own], number, ~1u, ~0u};
    } else if (point.edges != 0) {
      // On an edge of the scene and on a border: four parts meet here.
      const std::size_t edge = first_edge(point);
      const std::uint32_t a = t.index[(edge + 1) % 3], b = t.index[(edge + 2) % 3];
      const auto border = static_cast<std::size_t>(point.border);
      const std::uint32_t c = piece.corners[(border + 1) % 3], d = piece.corners[(border + 2) % 3];
      key = {std::min(a, b), std::max(a, b), std::min(c, d), std::max(c, d)};
    } else {
      const glm::vec3& b = point.in_piece;
      const std::size_t corner = b.x > b.y ? (b.x > b.z ? 0 : 2) : (b.y > b.z ? 1 : 2);
      key = {t.number, piece.corners[corner], ~0u, ~0u};
    }
    return shared(key, t, point, h);
  }

  /// The emitted vertex of a key; one that a neighbour has emitted is used again.
  std::uint32_t shared(const VertexCache::Key& key, const Triangle& t, const Point& point,
                       const glm::vec3& h) {
    if (!view_.edges) {
      VertexCache::Entry& entry = scratch_.cache.at(key);
      if (entry.key == key && entry.batch == number_) return entry.emitted;
      entry = {key, number_, static_cast<std::uint32_t>(out_.vertices.size())};
    }
    const auto next = static_cast<std::uint32_t>(out_.vertices.size());
    const glm::vec3& w = point.in_triangle;
    const content::Vertex &a = *t.vertex[0], &b = *t.vertex[1], &c = *t.vertex[2];
    out_.vertices.push_back({{h.x, h.y, 0.0f, h.z},
                             t.offset[0] * w.x + t.offset[1] * w.y + t.offset[2] * w.z,
                             flat_ ? normal_ : pack_normal(a.normal * w.x + b.normal * w.y + c.normal * w.z),
                             a.uv * w.x + b.uv * w.y + c.uv * w.z,
                             mix_color(t.vertex, w),
                             {w.x, w.y}});
    return next;
  }

  const FrameGeometry& geometry_;
  const CellView& view_;
  Occlusion& occlusion_;
  Scratch& scratch_;
  std::vector<std::uint32_t>& entries_;
  std::uint32_t number_; ///< of the batch
  EmittedBatch& out_;
  float item_nearest_ = 0.0f; ///< no triangle of the item is nearer to the eye, metres
  bool flat_ = false;
  std::uint32_t normal_ = 0;
};

constexpr std::uint32_t indices_per_task = 3 * 1024;

} // namespace

void distribute_cells(const FrameGeometry& geometry, std::span<const DrawItem> items, const CellView& view,
                      Occlusion& occlusion, std::vector<EmittedBatch>& batches) {
  const std::vector<TaskItems> tasks = split_items(items, indices_per_task);
  batches.resize(tasks.size());
  // From near to far, so that what hides comes before what is hidden.
  std::atomic<std::size_t> next = 0;
  tbb::parallel_for(0, tbb::this_task_arena::max_concurrency(), [&](int) {
    std::unique_ptr<Scratch> scratch;
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
      if (!scratch) scratch = std::make_unique<Scratch>();
      Task(geometry, view, occlusion, *scratch, static_cast<std::uint32_t>(i), batches[i]).run(tasks[i]);
    }
  });
}

} // namespace cupola::passes
