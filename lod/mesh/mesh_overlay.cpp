#include "lod/mesh/mesh_overlay.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lod {

namespace {

double length_at(double u, double v) { return std::sqrt(u * u + v * v + 1.0); }

}  // namespace

LineTable::LineTable(std::vector<double> lines) : line_(std::move(lines)) {
  double narrowest = line_.back() - line_.front();
  for (std::size_t k = 1; k < line_.size(); ++k) {
    const double width = line_[k] - line_[k - 1];
    inverse_width_.push_back(1.0 / width);
    narrowest = std::min(narrowest, width);
    widest_ = std::max(widest_, width);
  }
  buckets_per_unit_ = 1.0 / narrowest;
  const auto buckets = static_cast<std::size_t>((line_.back() - line_.front()) / narrowest) + 1;
  std::size_t k = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    while (line_[k] < line_.front() + static_cast<double>(b) * narrowest) ++k;
    first_in_bucket_.push_back(static_cast<int>(k));
  }
}

FineGrid::FineGrid(const Posts& posts, double radius)
    : key(posts.key),
      intervals(posts.intervals),
      radius_m(radius),
      u(grid_lines(posts.key, posts.intervals).u),
      v(grid_lines(posts.key, posts.intervals).v),
      padded_u(u.data(), u.data() + u.count()),
      depth(posts.height_m.size() + kDepthPad),
      length(posts.height_m.size()) {
  const auto side = static_cast<std::size_t>(posts.side());
  for (std::size_t j = 0; j < side; ++j) {
    const double v2 = v.data()[j] * v.data()[j];
    fill_depths({u.data(), posts.height_m.data() + j * side, v2, radius_m, side}, length.data() + j * side,
                depth.data() + j * side);
  }
  double least = depth.front();
  double steepest = 0.0;
  for (std::size_t j = 0; j + 1 < side; ++j) {
    const double* row = depth.data() + j * side;
    const DepthRange range = range_of_depths(row, row + side, side);
    least = std::min(least, range.least);
    steepest = std::max(steepest, range.cell);
  }
  highest_m = *std::max_element(posts.height_m.begin(), posts.height_m.end());
  padded_u.resize(padded_u.size() + kDepthPad, 1e6);
  std::fill(depth.end() - kDepthPad, depth.end(), least);
  depth_variation = steepest / least;
  // |grad log n| = |(u, v)| / n^2 <= 1/2.
  length_variation = std::expm1(0.5 * std::hypot(u.widest(), v.widest()));
}

CoarseMesh::CoarseMesh(const TileKey& tile, const TileMesh& mesh, std::span<const double> vertex_height_m,
                       double radius)
    : key(tile), intervals(mesh.intervals), radius_m(radius) {
  if (vertex_height_m.size() != mesh.vertices.size()) {
    throw std::invalid_argument("ErrorMeter: " + std::to_string(vertex_height_m.size()) + " heights for " +
                                std::to_string(mesh.vertices.size()) + " vertices of tile " + to_string(key));
  }
  const GridLines lines = grid_lines(key, intervals);
  vertices.resize(mesh.vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const double u = lines.u[mesh.vertices[k].i];
    const double v = lines.v[mesh.vertices[k].j];
    const double n = length_at(u, v);
    vertices[k] = {u, v, n * radius_m / (radius_m + vertex_height_m[k]), n};
  }
  const std::size_t count = mesh.triangle_count();
  triangles.reserve(count);
  triangle_boxes.reserve(count);
  // Edges are counted from both sides, but for those on borders; one more is written over.
  const std::size_t most_edges = 3 * count / 2 + 2 * static_cast<std::size_t>(intervals) + 2;
  segments.resize(most_edges);
  segment_boxes.resize(most_edges);
  std::size_t edges = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    // Vertices ascend, and triangles begin with their lowest one, counter-clockwise.
    const std::uint16_t* corner = mesh.triangles.data() + t;
    const std::uint16_t middle = std::min(corner[1], corner[2]);
    const std::uint16_t last = std::max(corner[1], corner[2]);
    triangles.add({corner[0], middle, last});
    const MeshVertex& p = mesh.vertices[corner[0]];
    const MeshVertex& q = mesh.vertices[middle];
    const MeshVertex& r = mesh.vertices[last];
    triangle_boxes.push_back({std::min(std::min(p.i, q.i), r.i), std::max(std::max(p.i, q.i), r.i), p.j, r.j});
    for (const auto& [a, b] :
         {std::pair(corner[0], corner[1]), std::pair(corner[1], corner[2]), std::pair(corner[2], corner[0])}) {
      const MeshVertex from = mesh.vertices[a];
      const MeshVertex to = mesh.vertices[b];
      segments.set(edges, {a, b});
      segment_boxes[edges] = {std::min(from.i, to.i), std::max(from.i, to.i), std::min(from.j, to.j),
                              std::max(from.j, to.j)};
      // Triangles are counter-clockwise, so an inner edge occurs once in each direction. Without branches, which nothing
      // could foresee.
      const bool slants = (from.i != to.i) & (from.j != to.j);
      const bool is_border =
          ((from.i == intervals) & (to.i == intervals)) | ((from.j == intervals) & (to.j == intervals));
      edges += static_cast<std::size_t>((slants & (a < b)) | is_border);
    }
  }
  segments.resize(edges);
  segment_boxes.resize(edges);
}

}  // namespace lod
