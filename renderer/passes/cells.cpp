#include "renderer/passes/cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <tbb/parallel_for.h>

namespace cupola::passes {

void Occlusion::reset(std::size_t pieces) {
  if (size_ != pieces) {
    depths_ = std::make_unique<std::atomic<float>[]>(pieces);
    size_ = pieces;
  }
  for (std::size_t i = 0; i < pieces; ++i)
    depths_[i].store(std::numeric_limits<float>::infinity(), std::memory_order_relaxed);
}

void Occlusion::cover(std::uint32_t piece, float farthest) {
  std::atomic<float>& depth = depths_[piece];
  float before = depth.load(std::memory_order_relaxed);
  while (farthest < before && !depth.compare_exchange_weak(before, farthest, std::memory_order_relaxed)) {}
}

namespace {

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
  bool opaque;
  bool back; ///< seen from behind
};

/// A corner of a part: barycentric coordinates in the piece's pyramid and in the triangle.
struct Point {
  glm::vec3 in_piece;
  glm::vec3 in_triangle; ///< sum 1
  std::uint8_t edges;    ///< bits of the triangle's edges it lies on
  int border;            ///< of the piece: 0, 1, 2 opposite that corner; -1: a corner of the triangle
};

struct Polygon {
  std::array<Point, 6> points;
  int count = 0;
  void push(const Point& point) { points[static_cast<std::size_t>(count++)] = point; }
};

/// Where the segment from the inside point p to the outside point q meets the border b[axis] = 0.
Point meet(const Point& p, const Point& q, int axis) {
  const float t = p.in_piece[axis] / (p.in_piece[axis] - q.in_piece[axis]);
  Point out;
  out.in_piece = p.in_piece + t * (q.in_piece - p.in_piece);
  out.in_piece[axis] = 0.0f;
  out.in_triangle = p.in_triangle + t * (q.in_triangle - p.in_triangle);
  out.edges = p.edges & q.edges;
  out.border = axis;
  return out;
}

/// Keeps b[axis] >= 0. Cuts go from the inside to the outside whichever way round the polygon runs, so that
/// the two triangles at an edge find the same point.
void cut(const Polygon& in, int axis, Polygon& out) {
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const Point& p = in.points[static_cast<std::size_t>(i)];
    const Point& q = in.points[static_cast<std::size_t>(i + 1 == in.count ? 0 : i + 1)];
    const bool p_in = p.in_piece[axis] >= 0.0f, q_in = q.in_piece[axis] >= 0.0f;
    if (p_in) out.push(p);
    if (p_in != q_in) out.push(p_in ? meet(p, q, axis) : meet(q, p, axis));
  }
  if (out.count < 3) out.count = 0;
}

std::uint32_t mix_color(const std::array<const content::Vertex*, 3>& of, const glm::vec3& weights) {
  if (of[0]->color == of[1]->color && of[1]->color == of[2]->color) return of[0]->color;
  std::uint32_t out = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    float sum = 0.5f;
    for (int i = 0; i < 3; ++i)
      sum += static_cast<float>(of[static_cast<std::size_t>(i)]->color >> shift & 255u) * weights[i];
    out |= static_cast<std::uint32_t>(std::clamp(sum, 0.0f, 255.0f)) << shift;
  }
  return out;
}

/// Emitted vertices that a neighbour may use again.
class VertexCache {
public:
  struct Key {
    std::uint32_t a, b, c, d;
    bool operator==(const Key&) const = default;
  };
  /// The slot of a key: a hit when its key is the same.
  struct Entry {
    Key key{~0u, ~0u, ~0u, ~0u};
    std::uint32_t emitted = 0;
  };
  Entry& at(const Key& key) {
    const std::uint32_t hash =
        key.a * 2654435761u ^ key.b * 2246822519u ^ key.c * 3266489917u ^ key.d * 668265263u;
    return entries_[(hash ^ hash >> 15) & (entries_.size() - 1)];
  }

private:
  std::array<Entry, 8192> entries_{};
};

/// Distributes the items of one batch.
class Task {
public:
  Task(const FrameGeometry& geometry, const CellView& view, Occlusion& occlusion, EmittedBatch& out)
      : geometry_(geometry)
      , view_(view)
      , occlusion_(occlusion)
      , out_(out) {
    out_.vertices.clear();
    out_.indices.clear();
    out_.portions.clear();
    out_.pairs = out_.hidden = 0;
  }

  void item(const DrawItem& item) {
    find_entries(item);
    if (entries_.empty()) return;
    const content::Material& material = geometry_.materials[item.material];
    const auto first = static_cast<std::uint32_t>(out_.indices.size());
    for (std::uint32_t i = 0; i + 2 < item.index_count; i += 3) triangle(item.first_index + i, material);
    const auto count = static_cast<std::uint32_t>(out_.indices.size()) - first;
    if (count == 0) return;
    if (!out_.portions.empty() && out_.portions.back().material == item.material)
      out_.portions.back().index_count += count;
    else
      out_.portions.push_back(
          {item.material, static_cast<std::uint32_t>(out_.portions.size()), 0, first, count});
  }

private:
  /// Groups that the item's triangles are tried against: as small as a few of them get.
  void find_entries(const DrawItem& item) {
    constexpr std::size_t enough = 8;
    const auto& groups = view_.pieces.groups();
    entries_.assign(1, 0);
    if (item.radius < 0.0f) return;
    const glm::vec3 center = view_.view_from_world * (item.center - view_.eye);
    for (std::size_t i = 0; i < entries_.size();) {
      const std::uint32_t at = entries_[i];
      const PieceTable::Group& group = groups[at];
      if (!PieceTable::meets(group, center, item.radius)) {
        entries_[i] = entries_.back();
        entries_.pop_back();
      } else if (group.next != at + 1 && entries_.size() < enough) {
        entries_[i] = at + 1;
        entries_.push_back(groups[at + 1].next);
      } else {
        ++i;
      }
    }
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
    t.opaque = material.alpha_mode == content::AlphaMode::opaque;
    flat_ = t.vertex[0]->normal == t.vertex[1]->normal && t.vertex[1]->normal == t.vertex[2]->normal;
    if (flat_) normal_ = pack_normal(t.vertex[0]->normal);
    for (const std::uint32_t entry : entries_) walk(t, entry);
  }

  void walk(const Triangle& t, std::uint32_t entry) {
    const auto& groups = view_.pieces.groups();
    const std::uint32_t end = groups[entry].next;
    for (std::uint32_t at = entry; at < end;) {
      const PieceTable::Group& group = groups[at];
      const Meeting meeting = meeting_of(t, group);
      if (meeting == Meeting::none) {
        at = group.next;
        continue;
      }
      if (meeting == Meeting::all) {
        for (std::uint32_t i = 0; i < group.count; ++i) whole_piece(t, group.first + i);
        at = group.next;
        continue;
      }
      if (group.next == at + 1)
        for (std::uint32_t i = 0; i < group.count; ++i) piece(t, group.first + i);
      ++at;
    }
  }

  enum class Meeting : std::uint8_t { none, some, all };

  /// A cone against the triangle's pyramid: beyond one of its planes, within all, or neither.
  static Meeting meeting_of(const Triangle& t, const PieceTable::Group& group) {
    if (group.cosine <= -1.0f) return Meeting::some;
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

  void emit(const Triangle& t, const Polygon& polygon, std::uint32_t number, const PieceTable::Piece& piece) {
    std::array<glm::vec3, 6> h;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
    for (int i = 0; i < polygon.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      h[at] = landing(piece, polygon.points[at].in_piece);
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
      add(index[0], index[i], index[i + 1], piece.mirrored);
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool turned) {
    out_.indices.insert(out_.indices.end(), {a, turned ? c : b, turned ? b : c});
  }

  /// The triangle covers all of the piece: its part is the piece itself.
  void whole_piece(const Triangle& t, std::uint32_t number) {
    const PieceTable::Piece& piece = view_.pieces.pieces()[number];
    std::array<Point, 3> points;
    std::array<glm::vec3, 3> h;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
    for (std::size_t i = 0; i < 3; ++i) {
      const PieceTable::Corner& corner = view_.pieces.corners()[piece.corners[i]];
      const glm::vec3 share(glm::dot(t.edges[0], corner.ray), glm::dot(t.edges[1], corner.ray),
                            glm::dot(t.edges[2], corner.ray));
      const float sum = share.x + share.y + share.z;
      points[i] = {glm::vec3(0.0f), share / sum, 0, 3};
      h[i] = corner.landing * (t.determinant / sum);
      nearest = std::min(nearest, h[i].z);
      farthest = std::max(farthest, h[i].z);
    }
    if (farthest < view_.near) return;
    ++out_.pairs;
    if (occlusion_.hides(number, nearest)) {
      ++out_.hidden;
      return;
    }
    if (t.opaque && nearest >= view_.near) occlusion_.cover(number, farthest * (1.0f + 1e-5f));
    std::array<std::uint32_t, 3> index;
    for (std::size_t i = 0; i < 3; ++i) {
      index[i] = shared({t.number, piece.corners[i], ~0u, ~0u}, t, points[i], h[i]);
    }
    // Pieces run counter-clockwise on the screen.
    add(index[0], index[1], index[2], t.back);
  }

  std::uint32_t vertex(const Triangle& t, const Point& point, const glm::vec3& h, std::uint32_t number,
                       const PieceTable::Piece& piece) {
    VertexCache::Key key{};
    if (point.border < 0) {
      const std::size_t own = point.in_triangle.x == 1.0f ? 0 : (point.in_triangle.y == 1.0f ? 1 : 2);
      key = {t.index[own], number, ~1u, ~0u};
    } else if (point.edges != 0) {
      // On an edge of the scene and on a border: four parts meet here.
      const std::size_t edge = point.edges & 1u ? 0 : (point.edges & 2u ? 1 : 2);
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
      VertexCache::Entry& entry = cache_.at(key);
      if (entry.key == key) return entry.emitted;
      entry = {key, static_cast<std::uint32_t>(out_.vertices.size())};
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
  EmittedBatch& out_;
  std::vector<std::uint32_t> entries_;
  VertexCache cache_;
  bool flat_ = false;
  std::uint32_t normal_ = 0;
};

constexpr std::uint32_t indices_per_task = 3 * 1024;

} // namespace

void distribute_cells(const FrameGeometry& geometry, std::span<const DrawItem> items, const CellView& view,
                      Occlusion& occlusion, std::vector<EmittedBatch>& batches) {
  const std::vector<std::span<const DrawItem>> tasks = split_items(items, indices_per_task);
  batches.resize(tasks.size());
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
    Task task(geometry, view, occlusion, batches[i]);
    for (const DrawItem& item : tasks[i]) task.item(item);
  });
}

} // namespace cupola::passes
