#include "vpe/voxel/smooth/smooth_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vpe::voxel {

namespace {

using lod::Edge;

// The slope at a line is before * (h - h_before) + behind * (h_behind - h).
template <class Weights>
std::vector<Weights> line_weights(const std::vector<double>& lines) {
  std::vector<Weights> weights(lines.size());
  for (std::size_t k = 1; k + 1 < lines.size(); ++k) {
    const double da = lines[k] - lines[k - 1];
    const double db = lines[k + 1] - lines[k];
    weights[k] = {db / (da * (da + db)), da / (db * (da + db))};
  }
  return weights;
}

float below(double h) {
  const auto rounded = static_cast<float>(h);
  return static_cast<double>(rounded) <= h ? rounded
                                           : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}

float above(double h) { return -below(-h); }

}  // namespace

SmoothTile::SmoothTile(const paging::SurfaceTile& posts, const BorderRule& rule, core::RayPatch patch,
                       double radius_m)
    : key_(posts.data.posts.key),
      intervals_(posts.data.posts.intervals),
      is_bicubic_(patch == core::RayPatch::kBicubic),
      base_m_(0.5 * (posts.min_height_m + posts.max_height_m)),
      lines_(posts.lines),
      u_weights_(line_weights<Weights>(lines_.u)),
      v_weights_(line_weights<Weights>(lines_.v)),
      radius_m_(radius_m) {
  const std::vector<double>& heights = posts.data.posts.height_m;
  posts_.resize(heights.size());
  for (std::size_t n = 0; n < heights.size(); ++n) posts_[n] = static_cast<float>(heights[n] - base_m_);
  set_border(rule, posts, post_shift_m_);
  set_bounds();
  set_sagitta(radius_m);
}

void SmoothTile::set_border(const BorderRule& rule, const paging::SurfaceTile& posts, double& shift_m) {
  const int n = intervals_;
  border_.resize(is_bicubic_ ? static_cast<std::size_t>(4 * n) : 0);
  for (const Edge edge : lod::kEdges) {
    const std::vector<BorderNode> nodes = rule.edge(key_, edge);
    const bool north = edge == Edge::kWest || edge == Edge::kEast;
    const bool is_far = edge == Edge::kEast || edge == Edge::kNorth;
    const double outwards = is_far ? 1 : -1;
    for (int k = 0; k <= n; ++k) {
      const BorderNode& node = nodes[static_cast<std::size_t>(k)];
      const int i = north ? (is_far ? n : 0) : k;
      const int j = north ? k : (is_far ? n : 0);
      posts_[static_cast<std::size_t>(j * (n + 1) + i)] = static_cast<float>(node.height_m - base_m_);
      shift_m = std::max(shift_m, std::abs(node.height_m - posts.data.posts.at(i, j)));
      if (!is_bicubic_) continue;
      Slopes& slopes = border_[border_place(i, j)];
      const bool is_corner = k == 0 || k == n;
      (north ? slopes.v : slopes.u) = static_cast<float>(node.along);
      if (is_corner) {
        slopes.uv = static_cast<float>(rule.corner_twist(key_, i == 0 ? 0 : 1, j == 0 ? 0 : 1));
        continue;
      }
      (north ? slopes.u : slopes.v) = static_cast<float>(outwards * node.across);
      slopes.uv = static_cast<float>(outwards * node.twist);
    }
  }
  // Posts are floats about the middle.
  shift_m += 1e-7 * (posts.max_height_m - posts.min_height_m);
}

// South, north, west, east; corners belong to the first two.
std::size_t SmoothTile::border_place(int i, int j) const {
  const int n = intervals_;
  if (j == 0) return static_cast<std::size_t>(i);
  if (j == n) return static_cast<std::size_t>(n + 1 + i);
  return static_cast<std::size_t>(2 * (n + 1) + (i == 0 ? 0 : n - 1) + j - 1);
}

SmoothTile::Slopes SmoothTile::slopes(int i, int j) const {
  const int n = intervals_;
  if (i == 0 || j == 0 || i == n || j == n) return border_[border_place(i, j)];
  const Weights& wu = u_weights_[static_cast<std::size_t>(i)];
  const Weights& wv = v_weights_[static_cast<std::size_t>(j)];
  const auto along_u = [&](int row) {
    return wu.before * (post(i, row) - post(i - 1, row)) + wu.behind * (post(i + 1, row) - post(i, row));
  };
  const double low = along_u(j - 1);
  const double here = along_u(j);
  const double high = along_u(j + 1);
  const double along_v = wv.before * (post(i, j) - post(i, j - 1)) + wv.behind * (post(i, j + 1) - post(i, j));
  return {static_cast<float>(here), static_cast<float>(along_v),
          static_cast<float>(wv.before * (here - low) + wv.behind * (high - here))};
}

PatchNode SmoothTile::node(int i, int j, double du, double dv) const {
  const Slopes s = slopes(i, j);
  return {post(i, j), du * static_cast<double>(s.u), dv * static_cast<double>(s.v),
          du * dv * static_cast<double>(s.uv)};
}

SmoothPatch SmoothTile::patch(int i, int j, double exaggeration) const {
  if (!is_bicubic_)
    return bilinear_patch(exaggeration * post(i, j), exaggeration * post(i + 1, j),
                          exaggeration * post(i, j + 1), exaggeration * post(i + 1, j + 1));
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  const double du = lines_.u[at(i + 1)] - lines_.u[at(i)];
  const double dv = lines_.v[at(j + 1)] - lines_.v[at(j)];
  const auto scaled = [&](int column, int row) {
    const PatchNode n = node(column, row, du, dv);
    return PatchNode{exaggeration * n.h, exaggeration * n.hu, exaggeration * n.hv, exaggeration * n.huv};
  };
  return bicubic_patch(scaled(i, j), scaled(i + 1, j), scaled(i, j + 1), scaled(i + 1, j + 1));
}

void SmoothTile::set_bounds() {
  const int n = intervals_;
  const auto side = static_cast<std::size_t>(n) + 1;
  const auto cells = static_cast<std::size_t>(n);
  // A row of nodes: slopes for a unit of the chart.
  struct Row {
    std::vector<double> h, u, v, uv;
  };
  const auto make_row = [&](int j) {
    Row row;
    for (std::vector<double>* values : {&row.h, &row.u, &row.v, &row.uv}) values->resize(side);
    for (std::size_t i = 0; i < side; ++i) {
      row.h[i] = post(static_cast<int>(i), j);
      if (!is_bicubic_) continue;
      const Slopes s = slopes(static_cast<int>(i), j);
      row.u[i] = static_cast<double>(s.u);
      row.v[i] = static_cast<double>(s.v);
      row.uv[i] = static_cast<double>(s.uv);
    }
    return row;
  };
  std::vector<double> low(cells);
  std::vector<double> high(cells);
  std::vector<Bounds> bounds(cells * cells);
  Row south = make_row(0);
  for (int j = 0; j < n; ++j) {
    Row north = make_row(j + 1);
    const double dv = (lines_.v[static_cast<std::size_t>(j) + 1] - lines_.v[static_cast<std::size_t>(j)]) / 3;
    for (std::size_t i = 0; i < cells; ++i) {
      const double h00 = south.h[i], h10 = south.h[i + 1], h01 = north.h[i], h11 = north.h[i + 1];
      double least = std::min(std::min(h00, h10), std::min(h01, h11));
      double most = std::max(std::max(h00, h10), std::max(h01, h11));
      const double flat = std::abs(h00 - h10 - h01 + h11) / 4;
      double off = 0;
      if (is_bicubic_) {
        const double du = (lines_.u[i + 1] - lines_.u[i]) / 3;
        // The Bezier points beside each corner; (x, y): the corner's place, and the directions to the cell.
        const auto corner = [&](const Row& row, std::size_t k, double x, double y, double h, double across,
                                double up, double far) {
          const double bu = h + x * du * row.u[k];
          const double bv = h + y * dv * row.v[k];
          const double both = bu + y * dv * (row.v[k] + x * du * row.uv[k]);
          least = std::min(least, std::min(bu, std::min(bv, both)));
          most = std::max(most, std::max(bu, std::max(bv, both)));
          // Of the bilinear patch.
          const double level_u = h + (across - h) / 3;
          const double level_v = h + (up - h) / 3;
          const double level = (4 * h + 2 * across + 2 * up + far) / 9;
          off = std::max(
              off, std::max(std::abs(bu - level_u), std::max(std::abs(bv - level_v), std::abs(both - level))));
        };
        corner(south, i, 1, 1, h00, h10, h01, h11);
        corner(south, i + 1, -1, 1, h10, h00, h11, h01);
        corner(north, i, 1, -1, h01, h11, h00, h10);
        corner(north, i + 1, -1, -1, h11, h01, h10, h00);
      }
      facet_deviation_m_ = std::max(facet_deviation_m_, flat + off * 15 / 16);
      bounds[static_cast<std::size_t>(j) * cells + i] = {below(base_m_ + least), above(base_m_ + most)};
    }
    south = std::move(north);
  }
  std::size_t width = cells;
  std::vector<Bounds> fine = std::move(bounds);
  while (width > 1) {
    const std::size_t half = width / 2;
    Level level;
    level.side = half;
    level.blocks.resize(half * half);
    for (std::size_t j = 0; j < half; ++j) {
      for (std::size_t i = 0; i < half; ++i) {
        const Bounds& a = fine[2 * j * width + 2 * i];
        const Bounds& b = fine[2 * j * width + 2 * i + 1];
        const Bounds& c = fine[(2 * j + 1) * width + 2 * i];
        const Bounds& d = fine[(2 * j + 1) * width + 2 * i + 1];
        level.blocks[j * half + i] = {std::min(std::min(a.low_m, b.low_m), std::min(c.low_m, d.low_m)),
                                      std::max(std::max(a.high_m, b.high_m), std::max(c.high_m, d.high_m))};
      }
    }
    fine = level.blocks;
    blocks_.push_back(std::move(level));
    width = half;
  }
}

void SmoothTile::set_sagitta(double radius_m) {
  const int n = intervals_;
  double widest_u = 0;
  double widest_v = 0;
  double steepest_u = 0;
  double steepest_v = 0;
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  for (int k = 0; k < n; ++k) {
    const double du = lines_.u[at(k + 1)] - lines_.u[at(k)];
    const double dv = lines_.v[at(k + 1)] - lines_.v[at(k)];
    widest_u = std::max(widest_u, du);
    widest_v = std::max(widest_v, dv);
    for (int m = 0; m <= n; ++m) {
      steepest_u = std::max(steepest_u, std::abs(post(k + 1, m) - post(k, m)) / du);
      steepest_v = std::max(steepest_v, std::abs(post(m, k + 1) - post(m, k)) / dv);
    }
  }
  const auto nearest = [](const std::vector<double>& lines) {
    const double low = lines.front();
    const double high = lines.back();
    return low <= 0 && high >= 0 ? 0.0 : std::min(std::abs(low), std::abs(high));
  };
  const double u = nearest(lines_.u);
  const double v = nearest(lines_.v);
  length_ = std::sqrt(1 + u * u + v * v);
  bend_ = (widest_u * widest_u + widest_v * widest_v) / 8;
  slope_ = std::hypot(steepest_u, steepest_v);
  radius_m_ = radius_m;
}

double SmoothTile::deviation_m(double exaggeration) const {
  const Bounds& all = blocks_.back().blocks.front();
  const double most = radius_m_ + exaggeration * static_cast<double>(all.high_m);
  const double least = std::max(radius_m_ + exaggeration * static_cast<double>(all.low_m), 1e-3 * radius_m_);
  const double slope = exaggeration * slope_;
  const double sagitta = bend_ * (most / (length_ * length_) + 2 * slope / length_ + 2 * slope * slope / least);
  return exaggeration * (facet_deviation_m_ + post_shift_m_) + sagitta;
}

std::size_t SmoothTile::bytes() const {
  std::size_t total = sizeof(SmoothTile) + posts_.capacity() * sizeof(float) +
                      border_.capacity() * sizeof(Slopes) +
                      (lines_.u.capacity() + lines_.v.capacity()) * sizeof(double) +
                      (u_weights_.capacity() + v_weights_.capacity()) * sizeof(Weights);
  for (const Level& level : blocks_) total += level.blocks.capacity() * sizeof(Bounds);
  return total;
}

}  // namespace vpe::voxel
