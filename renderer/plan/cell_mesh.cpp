#include "renderer/plan/cell_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace cupola::plan {

namespace {

constexpr glm::ivec2 root{320, 256}; ///< 5:4: sloped borders keep 0.078 px clear of pixel centres
constexpr int shortest = 2;          ///< pixels; smaller cells are not made
constexpr double margin = 0.97;      ///< of the error allowed: between samples it is a little larger
constexpr double foresight = 0.9;    ///< of that: to which cells are refined before they are balanced
constexpr std::array<int, 3> rounds{4, 2, 2}; ///< sweeps of each round of balancing and splitting
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Barycentric coordinates: middles of the sides and of the cell.
constexpr std::array<std::array<double, 3>, 4> coarse{
    {{0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}, {0.5, 0.5, 0.0}, {1.0 / 3, 1.0 / 3, 1.0 / 3}}};
/// In steps of a quarter, without the corners. The first of them do for balancing.
constexpr std::uint32_t side_middles = 3;
constexpr std::array<std::array<double, 3>, 12> fine{{{0.0, 0.5, 0.5},
                                                      {0.5, 0.0, 0.5},
                                                      {0.5, 0.5, 0.0},
                                                      {0.5, 0.25, 0.25},
                                                      {0.25, 0.5, 0.25},
                                                      {0.25, 0.25, 0.5},
                                                      {0.0, 0.25, 0.75},
                                                      {0.0, 0.75, 0.25},
                                                      {0.25, 0.0, 0.75},
                                                      {0.75, 0.0, 0.25},
                                                      {0.25, 0.75, 0.0},
                                                      {0.75, 0.25, 0.0}}};

glm::ivec2 origin_of(const PixelRect& part) {
  // A corner in the middle, since most maps are symmetric; roots hang over all edges.
  const auto start = [](int from, int size, int step) {
    const int middle = size / 2, before = (middle + step - 1) / step * step;
    return from + middle - before;
  };
  return {start(part.x, part.width, root.x), start(part.y, part.height, root.y)};
}

glm::ivec2 extent_of(const PixelRect& part) {
  return glm::ivec2(part.x + part.width, part.y + part.height) - origin_of(part);
}

} // namespace

CellMesh::CellMesh(const projection::Map& map, glm::ivec2 picture, const ShownRows& rows, double max_error,
                   std::size_t budget)
    : picture_{map, picture, {}}
    , rows_(rows)
    , limit_(margin * max_error)
    , budget_(budget)
    , lattice_(origin_of(rows.part()), extent_of(rows.part()), root) {
  const PixelRect& part = rows.part();
  for (int y = part.y; y < part.y + part.height; ++y)
    if (const PixelRun run = rows.row(y); run.first < run.end) {
      picture_.inside = picture_.image({(run.first + run.end) * 0.5, y + 0.5});
      if (y >= part.y + part.height / 2) break;
    }
  refine();
  balance();
}

void CellMesh::add_node(glm::dvec2 at) {
  Node& node = nodes_.emplace_back();
  const auto weight = picture_.weight(at);
  node.fit = weight.has_value();
  if (!node.fit) return;
  node.weight = *weight;
  aim(node, at);
}

/// Gives a corner the ray beside it; none of that where nothing is shown.
void CellMesh::aim(Node& node, glm::dvec2 at) {
  auto ray = picture_.ray(at + node.shift);
  if (!ray) {
    node.shift = glm::dvec2(0.0);
    ray = picture_.ray(at);
  }
  if (ray) node.ray = glm::normalize(*ray);
}

void CellMesh::grow() {
  while (nodes_.size() < lattice_.points().size()) add_node(glm::dvec2(lattice_.points()[nodes_.size()]));
  cells_.resize(lattice_.triangles().size());
}

/// Calls row(y, first, end) with the pixels whose centres lie within the triangle, rows of the part only.
template <class Row>
void CellMesh::each_row(std::uint32_t triangle, Row row) const {
  std::array<glm::dvec2, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = lattice_.points()[lattice_.triangles()[triangle].corners[i]];
  const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
  const PixelRect& part = rows_.part();
  const int end = std::min(static_cast<int>(high), part.y + part.height);
  for (int y = std::max(static_cast<int>(low), part.y); y < end; ++y) {
    double left = infinite, right = -infinite;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 &a = p[i], &b = p[(i + 1) % 3];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = a.x + (b.x - a.x) * (y + 0.5 - a.y) / (b.y - a.y);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    row(y, static_cast<int>(std::ceil(left - 0.5)), static_cast<int>(std::ceil(right - 0.5)));
  }
}

CellMesh::Coverage CellMesh::coverage(std::uint32_t triangle) const {
  long shown = 0, all = 0;
  each_row(triangle, [&](int y, int first, int end) {
    const PixelRun run = rows_.row(y);
    shown += std::max(0, std::min(end, run.end) - std::max(first, run.first));
    all += end - first;
  });
  if (shown == 0) return Coverage::none;
  for (const std::uint32_t corner : lattice_.triangles()[triangle].corners) {
    const glm::ivec2 at = lattice_.points()[corner];
    const PixelRect& part = rows_.part();
    if (at.x < part.x || at.y < part.y || at.x > part.x + part.width || at.y > part.y + part.height)
      return Coverage::some;
  }
  return shown == all ? Coverage::whole : Coverage::some;
}

bool CellMesh::splittable(std::uint32_t triangle) const {
  return lattice_.triangles().size() < budget_ && lattice_.divisible(triangle, shortest);
}

bool CellMesh::add_sample(std::uint32_t triangle, glm::dvec2 at, const std::array<double, 3>& share) {
  const auto ray = picture_.ray(at);
  if (!ray) return false;
  samples_.push_back({share, at, *ray});
  ++cells_[triangle].sample_count;
  return true;
}

/// Where not all is shown: some of the pixels that are.
void CellMesh::sample_shown(std::uint32_t triangle) {
  constexpr int most = 7; // rows, and pixels of a row
  std::vector<std::array<int, 3>> runs;
  each_row(triangle, [&](int y, int first, int end) {
    const PixelRun run = rows_.row(y);
    first = std::max(first, run.first);
    end = std::min(end, run.end);
    if (first < end) runs.push_back({y, first, end});
  });
  const auto& corners = lattice_.triangles()[triangle].corners;
  std::array<glm::dvec2, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = lattice_.points()[corners[i]];
  const auto area = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
  const double whole = area(p[1] - p[0], p[2] - p[0]);
  const int row_count = std::min(most, static_cast<int>(runs.size()));
  for (int i = 0; i < row_count; ++i) {
    const auto& [y, first, end] =
        runs[row_count == 1 ? 0 : i * (runs.size() - 1) / static_cast<std::size_t>(row_count - 1)];
    const int count = std::min(most, end - first);
    for (int j = 0; j < count; ++j) {
      const int x = count == 1 ? first : first + j * (end - 1 - first) / (count - 1);
      const glm::dvec2 at(x + 0.5, y + 0.5);
      const double b = area(at - p[0], p[2] - p[0]) / whole, c = area(p[1] - p[0], at - p[0]) / whole;
      add_sample(triangle, at, {1.0 - b - c, b, c});
    }
  }
}

/// Takes the samples of a cell that shows something.
void CellMesh::sample(std::uint32_t triangle) {
  Cell& cell = cells_[triangle];
  cell.first_sample = static_cast<std::uint32_t>(samples_.size());
  cell.sample_count = 0;
  if (cell.coverage == Coverage::some) {
    sample_shown(triangle);
  } else {
    const auto& c = lattice_.triangles()[triangle].corners;
    const auto& points = lattice_.points();
    for (const auto& share : fine)
      add_sample(triangle,
                 share[0] * glm::dvec2(points[c[0]]) + share[1] * glm::dvec2(points[c[1]]) +
                     share[2] * glm::dvec2(points[c[2]]),
                 share);
  }
}

/// The error at the samples, or infinite where the cell has no pyramid.
void CellMesh::measure(std::uint32_t triangle) {
  Cell& cell = cells_[triangle];
  cell.error = infinite;
  const auto& c = lattice_.triangles()[triangle].corners;
  if (!nodes_[c[0]].fit || !nodes_[c[1]].fit || !nodes_[c[2]].fit) return;
  const auto corner = [&](std::size_t i) { return Corner{nodes_[c[i]].ray, nodes_[c[i]].weight, {}}; };
  const auto at = [&](std::size_t i) { return glm::dvec2(lattice_.points()[c[i]]); };
  const Drawing draw({corner(0), corner(1), corner(2)}, {at(0), at(1), at(2)});
  if (!draw.fit()) return;
  cell.error = 0.0;
  for (std::uint32_t i = cell.first_sample; i < cell.first_sample + cell.sample_count; ++i) {
    Sample& sample = samples_[i];
    sample.error = draw(sample.ray) - sample.at;
    const double error = glm::length(sample.error);
    cell.error = std::isfinite(error) ? std::max(cell.error, error) : infinite;
    if (cell.error == infinite) break;
  }
  if (cell.coverage == Coverage::whole)
    for (const std::uint32_t node : c) cell.error = std::max(cell.error, glm::length(nodes_[node].shift));
}

/// What the error would be if the cell's own corners were shifted at their best: half of the largest
/// difference between two errors, corners included, which have none.
double CellMesh::balanced_error(std::uint32_t triangle) {
  Cell& cell = cells_[triangle];
  samples_.clear();
  if (cell.coverage == Coverage::some) {
    sample(triangle);
  } else {
    cell.first_sample = cell.sample_count = 0;
    const auto& c = lattice_.triangles()[triangle].corners;
    const auto& points = lattice_.points();
    for (const auto& share : coarse)
      add_sample(triangle,
                 share[0] * glm::dvec2(points[c[0]]) + share[1] * glm::dvec2(points[c[1]]) +
                     share[2] * glm::dvec2(points[c[2]]),
                 share);
  }
  measure(triangle);
  if (cell.error == infinite) return infinite;
  double square = 0.0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    square = std::max(square, glm::dot(samples_[i].error, samples_[i].error));
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec2 between = samples_[i].error - samples_[j].error;
      square = std::max(square, glm::dot(between, between));
    }
  }
  return 0.5 * std::sqrt(square);
}

void CellMesh::refine() {
  grow();
  std::vector<std::uint32_t> open(lattice_.triangles().size());
  for (std::uint32_t i = 0; i < open.size(); ++i) open[i] = i;
  while (!open.empty()) {
    const std::uint32_t triangle = open.back();
    open.pop_back();
    Cell& cell = cells_[triangle];
    cell.coverage = coverage(triangle);
    if (cell.coverage == Coverage::none || !splittable(triangle)) continue;
    if (balanced_error(triangle) <= foresight * limit_) continue;
    lattice_.bisect(triangle, open);
    grow();
  }
  samples_.clear();
}

/// Shifts that make the sum of the eighth powers of all errors smaller: least squares with weights, steps
/// short enough for that power. To first order a corner's shift moves what is drawn by minus the shift, times
/// the corner's share.
void CellMesh::relax(int sweeps) {
  constexpr double damping = 0.2; // below 2 / 7: all corners step together
  std::vector<glm::dvec2> force(nodes_.size());
  std::vector<double> mass(nodes_.size());
  const double unit = 1.0 / (limit_ * limit_), farthest = 0.99 * limit_;
  const auto weight = [&](glm::dvec2 error) {
    const double square = glm::dot(error, error) * unit + 1e-3;
    return square * square * square;
  };
  // What the errors would be without any shift.
  for (std::uint32_t t = 0; t < cells_.size(); ++t) {
    const Cell& cell = cells_[t];
    if (cell.coverage == Coverage::none || cell.error == infinite) continue;
    const auto& c = lattice_.triangles()[t].corners;
    for (std::uint32_t i = cell.first_sample; i < cell.first_sample + cell.sample_count; ++i) {
      Sample& sample = samples_[i];
      for (std::size_t k = 0; k < 3; ++k) sample.error += sample.share[k] * nodes_[c[k]].shift;
    }
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const double w = weight(nodes_[i].shift);
      force[i] = -w * nodes_[i].shift;
      mass[i] = w;
    }
    for (std::uint32_t t = 0; t < cells_.size(); ++t) {
      const Cell& cell = cells_[t];
      if (cell.coverage == Coverage::none || cell.error == infinite) continue;
      const auto& c = lattice_.triangles()[t].corners;
      const std::array<glm::dvec2, 3> shift{nodes_[c[0]].shift, nodes_[c[1]].shift, nodes_[c[2]].shift};
      const std::uint32_t count =
          cell.coverage == Coverage::whole ? std::min(cell.sample_count, side_middles) : cell.sample_count;
      for (std::uint32_t i = cell.first_sample; i < cell.first_sample + count; ++i) {
        const Sample& s = samples_[i];
        const glm::dvec2 error =
            s.error - s.share[0] * shift[0] - s.share[1] * shift[1] - s.share[2] * shift[2];
        const double w = weight(error);
        for (std::size_t k = 0; k < 3; ++k) {
          force[c[k]] += w * s.share[k] * error;
          mass[c[k]] += w * s.share[k] * s.share[k];
        }
      }
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      glm::dvec2& shift = nodes_[i].shift;
      shift += damping * force[i] / mass[i];
      const double length = glm::length(shift);
      if (length > farthest) shift *= farthest / length;
    }
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].fit) aim(nodes_[i], glm::dvec2(lattice_.points()[i]));
}

/// Halves all cells above the limit that can be; whether there were any. New corners are not shifted.
bool CellMesh::split_bad() {
  std::vector<std::uint32_t> bad, changed;
  for (std::uint32_t t = 0; t < cells_.size(); ++t)
    if (cells_[t].coverage != Coverage::none && cells_[t].error > limit_ && splittable(t)) bad.push_back(t);
  std::vector<bool> touched(cells_.size(), false);
  for (const std::uint32_t t : bad) {
    if (touched[t] || !splittable(t)) continue;
    const std::size_t from = changed.size();
    lattice_.bisect(t, changed);
    for (std::size_t i = from; i < changed.size(); ++i)
      if (changed[i] < touched.size()) touched[changed[i]] = true;
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  grow();
  for (const std::uint32_t t : changed) {
    cells_[t] = {};
    cells_[t].coverage = coverage(t);
    if (cells_[t].coverage == Coverage::none) continue;
    sample(t);
    measure(t);
  }
  return !changed.empty();
}

void CellMesh::measure_all() {
  for (std::uint32_t t = 0; t < cells_.size(); ++t)
    if (cells_[t].coverage != Coverage::none) measure(t);
}

void CellMesh::balance() {
  for (std::uint32_t t = 0; t < cells_.size(); ++t)
    if (cells_[t].coverage != Coverage::none) sample(t);
  measure_all();
  for (const int sweeps : rounds) {
    relax(sweeps);
    measure_all();
    if (!split_bad()) return;
  }
  while (split_bad()) {}
}

void CellMesh::append_to(PieceSet& set) const {
  set.unfinished = lattice_.triangles().size() >= budget_;
  std::vector<std::uint32_t> numbers(nodes_.size(), Lattice::none);
  const auto screen = [&](std::uint32_t node) { return picture_.image(glm::dvec2(lattice_.points()[node])); };
  const double unfit = std::max(limit_, margin * worst_drawn);
  double square_sum = set.rms_error * set.rms_error * static_cast<double>(set.triangles.size());
  for (std::uint32_t t = 0; t < cells_.size(); ++t) {
    const Cell& cell = cells_[t];
    if (cell.coverage == Coverage::none) continue;
    const auto& c = lattice_.triangles()[t].corners;
    if (cell.error > unfit) {
      set.looked_up.push_back({screen(c[0]), screen(c[1]), screen(c[2])});
      continue;
    }
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& number = numbers[c[i]];
      if (number == Lattice::none) {
        number = static_cast<std::uint32_t>(set.corners.size());
        const Node& node = nodes_[c[i]];
        set.corners.push_back({node.ray, node.weight, screen(c[i])});
      }
      triangle[i] = number;
    }
    set.triangles.push_back(triangle);
    set.shown.push_back(cell.coverage == Coverage::whole ? Shown::all : Shown::some);
    set.max_error = std::max(set.max_error, cell.error);
    double mean = 0.0;
    for (std::uint32_t i = cell.first_sample; i < cell.first_sample + cell.sample_count; ++i)
      mean += glm::dot(samples_[i].error, samples_[i].error) / cell.sample_count;
    square_sum += mean;
  }
  if (!set.triangles.empty())
    set.rms_error = std::sqrt(square_sum / static_cast<double>(set.triangles.size()));
}

} // namespace cupola::plan
