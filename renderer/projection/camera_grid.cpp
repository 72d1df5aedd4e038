#include "renderer/projection/camera_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

namespace cupola::projection {

namespace {

constexpr double border = 1e-12; // a point that was computed to lie on a border belongs to the triangle

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

} // namespace

CameraGrid::CameraGrid(int columns, int rows, std::vector<glm::dvec2> landings)
    : columns_(columns)
    , rows_(rows)
    , landings_(std::move(landings))
    , low_(landings_.front())
    , high_(landings_.front()) {
  for (const glm::dvec2& landing : landings_) {
    low_ = glm::min(low_, landing);
    high_ = glm::max(high_, landing);
  }
  sort_into_bins();
}

std::uint32_t CameraGrid::triangle_count() const {
  return 2u * static_cast<std::uint32_t>(columns_) * static_cast<std::uint32_t>(rows_);
}

std::array<std::uint32_t, 3> CameraGrid::triangle(std::uint32_t index) const {
  const auto across = static_cast<std::uint32_t>(columns_);
  const std::uint32_t cell = index / 2, a = cell / across * (across + 1) + cell % across;
  const std::uint32_t b = a + 1, c = a + across + 1, d = c + 1;
  if (index % 2 == 0) return {a, c, d};
  return {a, d, b};
}

glm::dvec2 CameraGrid::place(std::uint32_t vertex) const {
  const auto across = static_cast<std::uint32_t>(columns_) + 1;
  return {2.0 * (vertex % across) / columns_ - 1.0, 1.0 - 2.0 * (vertex / across) / rows_};
}

double CameraGrid::twice_area(std::uint32_t triangle) const {
  const auto [a, b, c] = this->triangle(triangle);
  return cross(landings_[b] - landings_[a], landings_[c] - landings_[a]);
}

int CameraGrid::column_of(double s, const Bins& bins) const {
  const double share = (s - low_.x) / std::max(high_.x - low_.x, border);
  return std::clamp(static_cast<int>(share * bins.columns), 0, bins.columns - 1);
}

int CameraGrid::row_of(double t, const Bins& bins) const {
  const double share = (t - low_.y) / std::max(high_.y - low_.y, border);
  return std::clamp(static_cast<int>(share * bins.rows), 0, bins.rows - 1);
}

CameraGrid::Range CameraGrid::bins_of(std::uint32_t triangle, const Bins& bins) const {
  const auto [a, b, c] = this->triangle(triangle);
  const glm::dvec2 low = glm::min(glm::min(landings_[a], landings_[b]), landings_[c]) - border;
  const glm::dvec2 high = glm::max(glm::max(landings_[a], landings_[b]), landings_[c]) + border;
  return {column_of(low.x, bins), column_of(high.x, bins), row_of(low.y, bins), row_of(high.y, bins)};
}

/// As many bins as cells, fewer where large triangles would fill too many of them.
void CameraGrid::sort_into_bins() {
  constexpr std::uint64_t most_per_triangle = 16;
  const std::uint32_t count = triangle_count();
  bins_ = {columns_, rows_};
  for (;;) {
    std::uint64_t entries = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Range r = bins_of(i, bins_);
      entries +=
          static_cast<std::uint64_t>(r.right - r.left + 1) * static_cast<std::uint64_t>(r.bottom - r.top + 1);
    }
    if (entries <= most_per_triangle * count || (bins_.columns == 1 && bins_.rows == 1)) break;
    bins_ = {std::max(1, bins_.columns / 2), std::max(1, bins_.rows / 2)};
  }
  const auto each_bin = [&](std::uint32_t triangle, const auto& visit) {
    const Range r = bins_of(triangle, bins_);
    for (int row = r.top; row <= r.bottom; ++row)
      for (int column = r.left; column <= r.right; ++column)
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(bins_.columns) +
              static_cast<std::size_t>(column));
  };
  first_.assign(static_cast<std::size_t>(bins_.columns) * static_cast<std::size_t>(bins_.rows) + 1, 0);
  for (std::uint32_t i = 0; i < count; ++i) each_bin(i, [&](std::size_t bin) { ++first_[bin + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  held_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < count; ++i) each_bin(i, [&](std::size_t bin) { held_[next[bin]++] = i; });
}

glm::dvec2 CameraGrid::shares(std::uint32_t triangle, glm::dvec2 st) const {
  const auto [a, b, c] = this->triangle(triangle);
  const glm::dvec2 right = landings_[b] - landings_[a], up = landings_[c] - landings_[a];
  const double area = cross(right, up);
  const glm::dvec2 from = st - landings_[a];
  return {cross(from, up) / area, cross(right, from) / area};
}

glm::dvec2 CameraGrid::place_of(std::uint32_t triangle, glm::dvec2 shares) const {
  const auto [a, b, c] = this->triangle(triangle);
  return place(a) + shares.x * (place(b) - place(a)) + shares.y * (place(c) - place(a));
}

template <class Visit>
void CameraGrid::visit_covering(glm::dvec2 st, const Visit& visit) const {
  if (!(st.x >= low_.x - border && st.x <= high_.x + border && st.y >= low_.y - border &&
        st.y <= high_.y + border))
    return;
  const std::size_t bin =
      static_cast<std::size_t>(row_of(st.y, bins_)) * static_cast<std::size_t>(bins_.columns) +
      static_cast<std::size_t>(column_of(st.x, bins_));
  for (std::uint32_t i = first_[bin]; i < first_[bin + 1]; ++i) {
    const glm::dvec2 at = shares(held_[i], st);
    const bool inside = at.x >= -border && at.y >= -border && at.x + at.y <= 1.0 + border;
    if (!inside) continue; // nor where the triangle is flat: then they are infinite or none
    if (!visit(held_[i], at)) return;
  }
}

std::optional<glm::dvec2> CameraGrid::seen_at(glm::dvec2 st) const {
  std::optional<glm::dvec2> seen;
  visit_covering(st, [&](std::uint32_t triangle, glm::dvec2 at) {
    seen = place_of(triangle, at);
    return false;
  });
  return seen;
}

std::vector<std::uint32_t> CameraGrid::covering(glm::dvec2 st) const {
  std::vector<std::uint32_t> out;
  visit_covering(st, [&](std::uint32_t triangle, glm::dvec2) {
    out.push_back(triangle);
    return true;
  });
  return out;
}

glm::dvec2 CameraGrid::seen_by(std::uint32_t triangle, glm::dvec2 st) const {
  return place_of(triangle, shares(triangle, st));
}

std::optional<glm::dvec2> CameraGrid::lands(glm::dvec2 place) const {
  const double x = 0.5 * (place.x + 1.0) * columns_, y = 0.5 * (1.0 - place.y) * rows_;
  const double slack = border * std::max(columns_, rows_);
  if (!(x >= -slack && x <= columns_ + slack && y >= -slack && y <= rows_ + slack)) return std::nullopt;
  const int column = std::clamp(static_cast<int>(x), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(y), 0, rows_ - 1);
  const double right = x - column, down = y - row;
  const std::size_t across = static_cast<std::size_t>(columns_) + 1;
  const std::size_t a = static_cast<std::size_t>(row) * across + static_cast<std::size_t>(column);
  const glm::dvec2 corner = landings_[a], opposite = landings_[a + across + 1];
  if (right >= down)
    return corner + down * (opposite - corner) + (right - down) * (landings_[a + 1] - corner);
  return corner + right * (opposite - corner) + (down - right) * (landings_[a + across] - corner);
}

} // namespace cupola::projection
