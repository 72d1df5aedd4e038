#include "renderer/passes/distribute.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace cupola::passes {

namespace {

/// A corner of the polygon that is being cut: a combination of the scene triangle's corners.
struct Corner {
  glm::vec3 view;     ///< view space
  glm::vec3 weights;  ///< barycentric
  std::uint8_t edges; ///< bit e: lies on the scene triangle's edge from corner e to e + 1
  std::int8_t border; ///< 0: a corner of the scene's, 1: cut by a left border, 2: by a right border
};

/// A triangle cut by two planes has at most five corners.
struct Polygon {
  std::array<Corner, 8> corners;
  int count = 0;
  void push(const Corner& corner) {
    if (count < static_cast<int>(corners.size())) corners[static_cast<std::size_t>(count++)] = corner;
  }
};

struct Triangle {
  std::array<std::uint32_t, 3> index;
  std::array<glm::vec3, 3> view;
};

/// Where the edge from `p` to `q` meets the plane. On an edge of the scene's it is computed from that edge's
/// own ends, the smaller index first, so that all who share the edge agree to the last bit.
Corner cut(const Triangle& triangle, const Corner& p, const Corner& q, const glm::vec3& plane, float dp,
           float dq, std::int8_t border) {
  const int shared = p.edges & q.edges;
  if (shared != 0) {
    const auto edge = static_cast<std::size_t>(shared & 1 ? 0 : (shared & 2 ? 1 : 2));
    std::size_t low = edge, high = (edge + 1) % 3;
    if (triangle.index[low] > triangle.index[high]) std::swap(low, high);
    const float dl = glm::dot(plane, triangle.view[low]), dh = glm::dot(plane, triangle.view[high]);
    if ((dl < 0.0f) != (dh < 0.0f)) {
      const float t = dl / (dl - dh);
      Corner made{triangle.view[low] + (triangle.view[high] - triangle.view[low]) * t, glm::vec3(0.0f),
                  static_cast<std::uint8_t>(1u << edge), border};
      made.weights[static_cast<int>(low)] = 1.0f - t;
      made.weights[static_cast<int>(high)] = t;
      return made;
    }
  }
  const float t = dp / (dp - dq);
  return {p.view + (q.view - p.view) * t, p.weights + (q.weights - p.weights) * t,
          static_cast<std::uint8_t>(shared), border};
}

/// The part of the polygon on the side of the plane where its distance times `side` is not negative.
void clip(const Triangle& triangle, const Polygon& in, const glm::vec3& plane, float side, std::int8_t border,
          Polygon& out) {
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const Corner& p = in.corners[static_cast<std::size_t>(i)];
    const Corner& q = in.corners[static_cast<std::size_t>((i + 1) % in.count)];
    const float dp = glm::dot(plane, p.view), dq = glm::dot(plane, q.view);
    const bool p_in = dp * side >= 0.0f, q_in = dq * side >= 0.0f;
    if (p_in) out.push(p);
    if (p_in != q_in) {
      // From the inside to the outside, whichever way round the polygon runs.
      out.push(p_in ? cut(triangle, p, q, plane, dp, dq, border)
                    : cut(triangle, q, p, plane, dq, dp, border));
    }
  }
  if (out.count < 3) out.count = 0;
}

std::uint32_t pack_normal(const glm::vec3& normal) {
  const auto part = [](float x) {
    return static_cast<std::uint32_t>(
               static_cast<std::int32_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 511.0f))) &
           1023u;
  };
  return part(normal.x) | part(normal.y) << 10 | part(normal.z) << 20;
}

std::uint32_t mix_color(const std::array<std::uint32_t, 3>& colors, const glm::vec3& weights) {
  if (colors[0] == colors[1] && colors[1] == colors[2]) return colors[0];
  std::uint32_t out = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    float sum = 0.5f;
    for (int i = 0; i < 3; ++i)
      sum += static_cast<float>(colors[static_cast<std::size_t>(i)] >> shift & 255u) * weights[i];
    out |= static_cast<std::uint32_t>(std::clamp(sum, 0.0f, 255.0f)) << shift;
  }
  return out;
}

/// Everything of a view that does not change from task to task.
struct StripTables {
  std::vector<glm::mat3> to_screen; ///< per strip, from view space
  std::vector<glm::vec3> borders;   ///< plane left of strip k at k, the last one right of the last strip
};

StripTables make_tables(const StripView& view) {
  StripTables tables;
  for (const plan::Piece& piece : view.set.pieces) {
    tables.to_screen.emplace_back(piece.to_screen);
    tables.borders.emplace_back(piece.planes[0]);
  }
  tables.borders.push_back(view.azimuths.full_turn() ? tables.borders.front()
                                                     : glm::vec3(-view.set.pieces.back().planes[1]));
  return tables;
}

/// Distributes the items of one batch.
class Task {
public:
  Task(const FrameGeometry& geometry, const StripView& view, const StripTables& tables, EmittedBatch& out)
      : geometry_(geometry)
      , view_(view)
      , tables_(tables)
      , out_(out) {
    to_axes_ = view.azimuths.axes_from_view() * view.view_from_world;
    out_.vertices.clear();
    out_.indices.clear();
    out_.runs.clear();
    out_.pairs = 0;
    shared_.fill({});
  }

  void item(const DrawItem& item) {
    if (item.radius >= 0.0f && !view_.azimuths.full_turn() &&
        view_.azimuths.sphere(to_axes_ * (item.center - view_.eye), item.radius).count == 0)
      return;
    const bool double_sided = geometry_.materials[item.material].double_sided;
    const auto first = static_cast<std::uint32_t>(out_.indices.size());
    for (std::uint32_t i = 0; i + 2 < item.index_count; i += 3) triangle(item.first_index + i, double_sided);
    const auto count = static_cast<std::uint32_t>(out_.indices.size()) - first;
    if (count == 0) return;
    if (!out_.runs.empty() && out_.runs.back().material == item.material)
      out_.runs.back().index_count += count;
    else
      out_.runs.push_back({item.material, first, count});
  }

private:
  void triangle(std::uint32_t first_index, bool double_sided) {
    Triangle triangle;
    std::array<glm::vec3, 3> offset;
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.index[i] = geometry_.index(first_index + static_cast<std::uint32_t>(i));
      source_[i] = &geometry_.vertex(triangle.index[i]);
      offset[i] = source_[i]->position - view_.eye;
    }
    if (!double_sided &&
        glm::dot(glm::cross(offset[1] - offset[0], offset[2] - offset[0]), offset[0]) >= 0.0f)
      return;
    std::array<float, 3> azimuth;
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.view[i] = view_.view_from_world * offset[i];
      azimuth[i] = azimuth_of(triangle.index[i], offset[i]);
    }
    const StripRange range = view_.azimuths.triangle(azimuth[0], azimuth[1], azimuth[2]);
    if (range.count == 0) return;
    out_.pairs += static_cast<std::uint64_t>(range.count);
    Polygon whole;
    for (std::size_t i = 0; i < 3; ++i) {
      glm::vec3 weights(0.0f);
      weights[static_cast<int>(i)] = 1.0f;
      whole.push({triangle.view[i], weights, static_cast<std::uint8_t>(1u << i | 1u << (i + 2) % 3), 0});
    }
    if (range.wide)
      each_strip_alone(triangle, whole, range);
    else
      strip_by_strip(triangle, whole, range);
  }

  /// Cuts off one strip after the other from left to right; what remains goes on.
  void strip_by_strip(const Triangle& triangle, const Polygon& whole, const StripRange& range) {
    const int strips = view_.azimuths.count();
    Polygon rest = whole, left, right;
    // Left of the first strip there may be a part outside the field, or outside by the margin of rounding.
    clip(triangle, rest, tables_.borders[static_cast<std::size_t>(range.first)], 1.0f, 1, left);
    rest = left;
    for (int i = 0; i < range.count && rest.count > 0; ++i) {
      const int strip = (range.first + i) % strips;
      const glm::vec3& border = tables_.borders[static_cast<std::size_t>(strip) + 1];
      clip(triangle, rest, border, -1.0f, 2, left);
      emit(triangle, left, strip);
      if (i + 1 == range.count) break;
      clip(triangle, rest, border, 1.0f, 1, right);
      rest = right;
    }
  }

  /// For triangles that the axis pierces or that span nearly half a turn: each strip cuts the whole.
  void each_strip_alone(const Triangle& triangle, const Polygon& whole, const StripRange& range) {
    Polygon half, part;
    for (int i = 0; i < range.count; ++i) {
      const int strip = (range.first + i) % view_.azimuths.count();
      clip(triangle, whole, tables_.borders[static_cast<std::size_t>(strip)], 1.0f, 1, half);
      if (half.count == 0) continue;
      clip(triangle, half, tables_.borders[static_cast<std::size_t>(strip) + 1], -1.0f, 2, part);
      emit(triangle, part, strip);
    }
  }

  void emit(const Triangle& triangle, const Polygon& polygon, int strip) {
    if (polygon.count < 3) return;
    std::array<glm::vec3, 8> h;
    int above = 0, below = 0, before = 0;
    for (int i = 0; i < polygon.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      h[at] = tables_.to_screen[static_cast<std::size_t>(strip)] * polygon.corners[at].view;
      above += h[at].y > h[at].z ? 1 : 0;
      below += h[at].y < -h[at].z ? 1 : 0;
      before += h[at].z < view_.near ? 1 : 0;
    }
    if (above == polygon.count || below == polygon.count || before == polygon.count) return;
    std::array<std::uint32_t, 8> index;
    for (int i = 0; i < polygon.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      index[at] = vertex(triangle, polygon.corners[at], h[at], strip);
    }
    for (int i = 1; i + 1 < polygon.count; ++i)
      out_.indices.insert(out_.indices.end(), {index[0], index[static_cast<std::size_t>(i)],
                                               index[static_cast<std::size_t>(i) + 1]});
  }

  /// The emitted vertex of a corner; one that a neighbour has emitted for the same strip is used again.
  std::uint32_t vertex(const Triangle& triangle, const Corner& corner, const glm::vec3& h, int strip) {
    Shared key{~0u, ~0u, 0, 0};
    if (!view_.edges && corner.edges != 0) {
      std::size_t low = 0, high = 0;
      if (corner.border == 0) {
        low = high = corner.weights[0] == 1.0f ? 0 : (corner.weights[1] == 1.0f ? 1 : 2);
      } else {
        low = corner.edges & 1 ? 0 : (corner.edges & 2 ? 1 : 2);
        high = (low + 1) % 3;
        if (triangle.index[low] > triangle.index[high]) std::swap(low, high);
      }
      key = {triangle.index[low], triangle.index[high], strip * 4 + corner.border, 0};
      const std::size_t slot =
          (key.low * 2654435761u ^ key.high * 40503u ^ static_cast<std::uint32_t>(key.tag) * 97u) &
          (shared_.size() - 1);
      Shared& entry = shared_[slot];
      if (entry.low == key.low && entry.high == key.high && entry.tag == key.tag) return entry.index;
      key.index = static_cast<std::uint32_t>(out_.vertices.size());
      entry = key;
    }
    const glm::vec3& w = corner.weights;
    const content::Vertex &a = *source_[0], &b = *source_[1], &c = *source_[2];
    EmittedVertex made;
    made.clip = glm::vec4(h.x, h.y, view_.near, h.z);
    if (corner.border == 0) {
      const content::Vertex& own = w[0] == 1.0f ? a : (w[1] == 1.0f ? b : c);
      made.offset = own.position - view_.eye;
      made.normal = pack_normal(own.normal);
      made.uv = own.uv;
      made.color = own.color;
    } else {
      made.offset =
          (a.position - view_.eye) * w.x + (b.position - view_.eye) * w.y + (c.position - view_.eye) * w.z;
      made.normal = pack_normal(a.normal * w.x + b.normal * w.y + c.normal * w.z);
      made.uv = a.uv * w.x + b.uv * w.y + c.uv * w.z;
      made.color = mix_color({a.color, b.color, c.color}, w);
    }
    made.corner = {w.x, w.y};
    out_.vertices.push_back(made);
    return static_cast<std::uint32_t>(out_.vertices.size() - 1);
  }

  float azimuth_of(std::uint32_t vertex, const glm::vec3& offset) {
    Azimuth& entry = azimuths_[vertex & (azimuths_.size() - 1)];
    if (entry.vertex != vertex) entry = {vertex, StripAzimuths::azimuth(to_axes_ * offset)};
    return entry.azimuth;
  }

  struct Azimuth {
    std::uint32_t vertex = ~0u;
    float azimuth = 0.0f;
  };
  struct Shared {
    std::uint32_t low = ~0u, high = ~0u;
    int tag = -1;
    std::uint32_t index = 0;
  };

  const FrameGeometry& geometry_;
  const StripView& view_;
  const StripTables& tables_;
  EmittedBatch& out_;
  glm::mat3 to_axes_;
  std::array<const content::Vertex*, 3> source_{};
  std::array<Azimuth, 1024> azimuths_{};
  std::array<Shared, 2048> shared_{};
};

constexpr std::uint32_t indices_per_task = 3 * 1536;

} // namespace

void distribute_strips(const FrameGeometry& geometry, std::span<const DrawItem> items, const StripView& view,
                       std::vector<EmittedBatch>& batches) {
  const StripTables tables = make_tables(view);
  std::vector<std::span<const DrawItem>> tasks;
  std::size_t begin = 0;
  std::uint32_t indices = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    indices += items[i].index_count;
    if (indices >= indices_per_task || i + 1 == items.size()) {
      tasks.push_back(items.subspan(begin, i + 1 - begin));
      begin = i + 1;
      indices = 0;
    }
  }
  batches.resize(tasks.size());
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
    Task task(geometry, view, tables, batches[i]);
    for (const DrawItem& item : tasks[i]) task.item(item);
  });
}

} // namespace cupola::passes
