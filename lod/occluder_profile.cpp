#include "lod/occluder_profile.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace lod {

namespace {

// A vertex of the mesh relative to one family of lines: `across` counts grid lines, `along` is the chart
// coordinate that runs along them. In the plane of a line a point of the surface is z (along, size), where z is
// its depth along the face's axis and size = sqrt(1 + line^2).
struct GridVertex {
  int across;
  double across_chart;
  double along;
  double depth;
};

struct PlanePoint {
  double x, y;
};

double distance_to_centre(const PlanePoint& a, const PlanePoint& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double t = length2 > 0.0 ? std::clamp(-(a.x * dx + a.y * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(a.x + t * dx, a.y + t * dy);
}

// One of the two families of lines of a tile, with the lowest radius over each piece.
class LineFamily {
 public:
  LineFamily(int intervals, const std::vector<double>& across, const std::vector<double>& along)
      : step_(intervals / kOccluderStrips), across_(across) {
    for (int n = 0; n <= kOccluderPieces; ++n)
      ends_[static_cast<std::size_t>(n)] = along[static_cast<std::size_t>(n * (intervals / kOccluderPieces))];
    for (auto& line : lowest_m_) line.fill(std::numeric_limits<double>::infinity());
  }

  void add(const std::array<GridVertex, 3>& corner) {
    const auto [low, high] = std::minmax({corner[0].across, corner[1].across, corner[2].across});
    for (int line = (low + step_ - 1) / step_; line * step_ <= high; ++line) cut(corner, line);
  }

  std::array<OccluderProfile::Line, kOccluderStrips + 1> lowered(double radius_m, double lower_m) const {
    std::array<OccluderProfile::Line, kOccluderStrips + 1> occluders{};
    for (std::size_t line = 0; line < occluders.size(); ++line) {
      for (std::size_t piece = 0; piece < kOccluderPieces; ++piece) {
        const double radius = lowest_m_[line][piece];
        const double height = radius * (1.0 - 2e-15) - radius_m - lower_m;
        float down = static_cast<float>(height);
        if (static_cast<double>(down) > height)
          down = std::nextafter(down, -std::numeric_limits<float>::infinity());
        occluders[line][piece] = down;
      }
    }
    return occluders;
  }

 private:
  // Intersects a triangle with a line: a straight segment, or a single corner.
  void cut(const std::array<GridVertex, 3>& corner, int line) {
    const int at = line * step_;
    const double fixed = across_[static_cast<std::size_t>(at)];
    const double size = std::sqrt(1.0 + fixed * fixed);
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    PlanePoint a{}, b{};
    const auto meet = [&](double along, double depth) {
      const PlanePoint p{along * depth, size * depth};
      if (along < from) from = along, a = p;
      if (along > to) to = along, b = p;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const GridVertex& p = corner[k];
      const GridVertex& q = corner[(k + 1) % 3];
      if (p.across == at) meet(p.along, p.depth);
      if ((p.across < at) == (q.across < at) || p.across == at || q.across == at) continue;
      // Inverse depth and chart coordinates are affine along an edge.
      const double t = (fixed - p.across_chart) / (q.across_chart - p.across_chart);
      meet(p.along + t * (q.along - p.along), 1.0 / ((1.0 - t) / p.depth + t / q.depth));
    }
    const auto first = static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(0, std::upper_bound(ends_.begin(), ends_.end(), from) - ends_.begin() - 1));
    for (std::size_t piece = first > 0 && from == ends_[first] ? first - 1 : first; piece < kOccluderPieces;
         ++piece) {
      if (ends_[piece] > to) break;
      const auto clipped = [&](double along) {
        if (along <= from) return a;
        if (along >= to) return b;
        const double t = (along - from) / (to - from);
        const double depth = 1.0 / ((1.0 - t) * size / a.y + t * size / b.y);
        return PlanePoint{along * depth, size * depth};
      };
      double& lowest = lowest_m_[static_cast<std::size_t>(line)][piece];
      lowest = std::min(lowest, distance_to_centre(clipped(std::max(from, ends_[piece])),
                                                   clipped(std::min(to, ends_[piece + 1]))));
    }
  }

  int step_;
  const std::vector<double>& across_;
  std::array<double, kOccluderPieces + 1> ends_{};
  std::array<std::array<double, kOccluderPieces>, kOccluderStrips + 1> lowest_m_{};
};

}  // namespace

OccluderProfile make_occluder_profile(const TileKey& key, const TileMesh& mesh,
                                      std::span<const double> height_m, double exaggeration, double radius_m,
                                      double lower_m) {
  if (mesh.intervals <= 0 || mesh.intervals % kOccluderPieces != 0) {
    throw std::invalid_argument("occluder profile of tile " + to_string(key) + ": its grid of " +
                                std::to_string(mesh.intervals) + " intervals does not divide into " +
                                std::to_string(kOccluderPieces) + " pieces");
  }
  if (height_m.size() != mesh.vertices.size()) {
    throw std::invalid_argument("occluder profile of tile " + to_string(key) + ": " +
                                std::to_string(height_m.size()) + " heights for " +
                                std::to_string(mesh.vertices.size()) + " vertices");
  }
  const GridLines lines = grid_lines(key, mesh.intervals);
  std::vector<GridVertex> by_column, by_row;
  by_column.reserve(mesh.vertices.size());
  by_row.reserve(mesh.vertices.size());
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    const MeshVertex& vertex = mesh.vertices[n];
    const double u = lines.u[vertex.i];
    const double v = lines.v[vertex.j];
    const double radius = radius_m + exaggeration * height_m[n];
    if (!(radius > 0.0)) {
      throw std::invalid_argument("occluder profile of tile " + to_string(key) +
                                  ": a vertex at or below the planet's centre");
    }
    const double depth = radius / std::sqrt(u * u + v * v + 1.0);
    by_column.push_back({vertex.i, u, v, depth});
    by_row.push_back({vertex.j, v, u, depth});
  }
  LineFamily columns(mesh.intervals, lines.u, lines.v);
  LineFamily rows(mesh.intervals, lines.v, lines.u);
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::size_t a = mesh.triangles[t], b = mesh.triangles[t + 1], c = mesh.triangles[t + 2];
    columns.add({by_column[a], by_column[b], by_column[c]});
    rows.add({by_row[a], by_row[b], by_row[c]});
  }
  return {columns.lowered(radius_m, lower_m), rows.lowered(radius_m, lower_m)};
}

}  // namespace lod
