#include "vpe/voxel/smooth/border_rule.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace vpe::voxel {

namespace {

using lod::Edge;

bool runs_north(Edge edge) { return edge == Edge::kWest || edge == Edge::kEast; }
bool is_far(Edge edge) { return edge == Edge::kEast || edge == Edge::kNorth; }

// Indices of the post at place k of an edge, `depth` cells inside.
std::pair<int, int> place_of(Edge edge, int k, int depth, int intervals) {
  const int across = is_far(edge) ? intervals - depth : depth;
  return runs_north(edge) ? std::pair(across, k) : std::pair(k, across);
}

// The edge that an edge ends at.
Edge end_edge(Edge edge, int end) {
  if (runs_north(edge)) return end == 0 ? Edge::kSouth : Edge::kNorth;
  return end == 0 ? Edge::kWest : Edge::kEast;
}

bool is_cube_edge(const lod::TileKey& key, Edge edge) {
  const std::int32_t at = runs_north(edge) ? key.i : key.j;
  return at == (is_far(edge) ? (std::int32_t{1} << key.level) - 1 : 0);
}

// The width of the cells along an edge.
double cell_width(const lod::GridLines& lines, Edge edge) {
  const std::vector<double>& across = runs_north(edge) ? lines.u : lines.v;
  return is_far(edge) ? across[across.size() - 1] - across[across.size() - 2] : across[1] - across[0];
}

// The slope in the middle of a parabola of slopes a before and b behind, over widths da and db.
double middle_slope(double a, double da, double b, double db) { return (db * a + da * b) / (da + db); }

}  // namespace

BorderRule::BorderRule(const lod::TileTree& tree, Fetch fetch, core::RayPatch patch)
    : tree_(tree), fetch_(std::move(fetch)), is_bicubic_(patch == core::RayPatch::kBicubic) {}

const paging::SurfaceTile& BorderRule::tile(const lod::TileKey& key) const {
  if (last_ && last_->data.posts.key == key) return *last_;
  for (const auto& held : held_) {
    if (held->data.posts.key == key) {
      last_ = held;
      return *last_;
    }
  }
  last_ = fetch_(key);
  held_.push_back(last_);
  return *last_;
}

double BorderRule::post(lod::TileKey key, int i, int j) const {
  const int n = tree_.shape().intervals();
  for (const lod::TileInfo* info = tree_.find(key); info->has_children; info = tree_.find(key)) {
    const int column = 2 * i >= n ? 1 : 0;
    const int row = 2 * j >= n ? 1 : 0;
    key = lod::child(key, column + 2 * row);
    i = 2 * i - column * n;
    j = 2 * j - row * n;
  }
  return tile(key).data.posts.at(i, j);
}

bool BorderRule::is_finest(const lod::TileKey& key) const {
  const lod::TileInfo* info = tree_.find(key);
  return info != nullptr && !info->has_children;
}

bool BorderRule::coarser(const lod::TileKey& key, Edge edge, Coarser& found) const {
  const lod::Neighbour beside = lod::neighbour(key, edge);
  const lod::TileKey& coarse = tree_.deepest(beside.key).key;
  if (coarse.level >= key.level) return false;
  const int n = tree_.shape().intervals();
  const auto along = [](const lod::TileKey& k, Edge e) { return std::int64_t{runs_north(e) ? k.j : k.i}; };
  const double finer = std::ldexp(1.0, key.level - coarse.level);
  const std::int64_t total = std::int64_t{n} << key.level;
  const std::int64_t start = along(key, edge) * n;
  found.key = coarse;
  found.edge = beside.edge;
  found.reversed = beside.reversed;
  found.first = static_cast<double>(beside.reversed ? total - start : start) / finer -
                static_cast<double>(along(coarse, beside.edge) * n);
  found.step = (beside.reversed ? -1.0 : 1.0) / finer;
  return true;
}

bool BorderRule::is_regular(const lod::TileKey& key, int column, int row) const {
  const Edge a = column == 0 ? Edge::kWest : Edge::kEast;
  const Edge b = row == 0 ? Edge::kSouth : Edge::kNorth;
  if (is_cube_edge(key, a) && is_cube_edge(key, b)) return false;
  const lod::TileKey beside_a = lod::neighbour(key, a).key;
  const lod::TileKey beside_b = lod::neighbour(key, b).key;
  if (!is_finest(beside_a) || !is_finest(beside_b)) return false;
  // From the neighbour on the same face across the other edge.
  return is_finest(is_cube_edge(key, a) ? lod::neighbour(beside_b, a).key : lod::neighbour(beside_a, b).key);
}

double BorderRule::corner_height_m(const lod::TileKey& key, int column, int row) const {
  const int n = tree_.shape().intervals();
  const std::pair<Edge, int> ends[2] = {{column == 0 ? Edge::kWest : Edge::kEast, row},
                                        {row == 0 ? Edge::kSouth : Edge::kNorth, column}};
  for (const auto& [edge, end] : ends) {
    Coarser beside;
    if (!coarser(key, edge, beside)) continue;
    const double at = beside.first + end * n * beside.step;
    if (at <= 0 || at >= n) continue;  // a corner of that tile too
    const std::vector<BorderNode> nodes = own_edge(beside.key, beside.edge);
    const lod::GridLines& lines = tile(beside.key).lines;
    return on_curve(nodes, runs_north(beside.edge) ? lines.v : lines.u, at).height_m;
  }
  return tile(key).data.posts.at(column * n, row * n);
}

double BorderRule::corner_twist(const lod::TileKey& key, int column, int row) const {
  const Edge a = column == 0 ? Edge::kWest : Edge::kEast;
  const Edge b = row == 0 ? Edge::kSouth : Edge::kNorth;
  if (is_cube_edge(key, a) || is_cube_edge(key, b) || !is_regular(key, column, row)) return 0;
  const int n = tree_.shape().intervals();
  const lod::TileKey beside_a = lod::neighbour(key, a).key;
  const lod::TileKey beside_b = lod::neighbour(key, b).key;
  const lod::TileKey opposite = lod::neighbour(beside_a, b).key;
  const int near_i = column == 0 ? 1 : n - 1;
  const int near_j = row == 0 ? 1 : n - 1;
  const double own = post(key, near_i, near_j);
  const double across_a = post(beside_a, n - near_i, near_j);
  const double across_b = post(beside_b, near_i, n - near_j);
  const double far = post(opposite, n - near_i, n - near_j);
  const Edge opposite_a = column == 0 ? Edge::kEast : Edge::kWest;
  const Edge opposite_b = row == 0 ? Edge::kNorth : Edge::kSouth;
  const double du = cell_width(tile(key).lines, a) + cell_width(tile(beside_a).lines, opposite_a);
  const double dv = cell_width(tile(key).lines, b) + cell_width(tile(beside_b).lines, opposite_b);
  const double sign = column == row ? 1 : -1;
  return sign * (own - across_a - across_b + far) / (du * dv);
}

double BorderRule::end_slope(const lod::TileKey& key, Edge edge, int end) const {
  const int n = tree_.shape().intervals();
  const int corner = end * n;
  const int inwards = end == 0 ? 1 : -1;
  const int column = runs_north(edge) ? (is_far(edge) ? 1 : 0) : end;
  const int row = runs_north(edge) ? end : (is_far(edge) ? 1 : 0);
  const double h0 = corner_height_m(key, column, row);
  const auto own = [&](int k) {
    const auto [i, j] = place_of(edge, k, 0, n);
    return tile(key).data.posts.at(i, j);
  };
  const double h1 = own(corner + inwards);
  const Edge across = end_edge(edge, end);
  const double d = cell_width(tile(key).lines, across);
  const double before = (h0 - h1) / d;  // outwards
  double slope = before;
  if (is_regular(key, column, row)) {
    const lod::Neighbour beside = lod::neighbour(key, across);
    const int k = is_far(edge) ? n : 0;  // of the corner, along the edge that is crossed
    const auto [i, j] = place_of(beside.edge, beside.reversed ? n - k : k, 1, n);
    const double d_beyond = cell_width(tile(beside.key).lines, beside.edge);
    double beyond = (post(beside.key, i, j) - h0) / d_beyond;
    if (is_cube_edge(key, across)) {
      const lod::GridLines& lines = tile(key).lines;
      const double t = (runs_north(across) ? lines.v : lines.u)[static_cast<std::size_t>(k)];
      beyond -= t * end_slope(key, across, is_far(edge) ? 1 : 0);
    }
    slope = middle_slope(before, d, beyond, d_beyond);
  } else if (n > 1) {
    const lod::GridLines& lines = tile(key).lines;
    const std::vector<double>& along = runs_north(edge) ? lines.v : lines.u;
    const auto at = [&](int k) { return along[static_cast<std::size_t>(k)]; };
    const double d_next = std::abs(at(corner + 2 * inwards) - at(corner + inwards));
    const double next = (h1 - own(corner + 2 * inwards)) / d_next;
    slope = before + (before - next) * d / (d + d_next);
  }
  return end == 0 ? -slope : slope;
}

std::vector<BorderNode> BorderRule::own_edge(const lod::TileKey& key, Edge edge) const {
  const int n = tree_.shape().intervals();
  const auto count = static_cast<std::size_t>(n) + 1;
  std::vector<BorderNode> nodes(count);
  const int side = is_far(edge) ? 1 : 0;
  const auto corner = [&](int end) { return runs_north(edge) ? std::pair(side, end) : std::pair(end, side); };
  for (int k = 0; k <= n; ++k) {
    const auto [i, j] = place_of(edge, k, 0, n);
    nodes[static_cast<std::size_t>(k)].height_m = tile(key).data.posts.at(i, j);
  }
  for (const int end : {0, 1}) {
    const auto [column, row] = corner(end);
    nodes[static_cast<std::size_t>(end * n)].height_m = corner_height_m(key, column, row);
  }
  if (!is_bicubic_) return nodes;

  const std::shared_ptr<const paging::SurfaceTile> own = (tile(key), last_);
  const std::vector<double>& along = runs_north(edge) ? own->lines.v : own->lines.u;
  const lod::Neighbour beside = lod::neighbour(key, edge);
  const double d = cell_width(own->lines, edge);
  const double d_beyond = cell_width(lod::grid_lines(beside.key, n), beside.edge);
  const bool turns = is_cube_edge(key, edge);
  for (int k = 1; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    BorderNode& node = nodes[at];
    const double da = along[at] - along[at - 1];
    const double db = along[at + 1] - along[at];
    node.along = middle_slope((node.height_m - nodes[at - 1].height_m) / da, da,
                              (nodes[at + 1].height_m - node.height_m) / db, db);
    const auto [i, j] = place_of(edge, k, 1, n);
    const double before = (node.height_m - own->data.posts.at(i, j)) / d;
    const auto [bi, bj] = place_of(beside.edge, beside.reversed ? n - k : k, 1, n);
    double beyond = (post(beside.key, bi, bj) - node.height_m) / d_beyond;
    if (turns) beyond -= along[at] * node.along;
    node.across = middle_slope(before, d, beyond, d_beyond);
  }
  for (const int end : {0, 1}) {
    BorderNode& node = nodes[static_cast<std::size_t>(end * n)];
    const auto [column, row] = corner(end);
    node.along = end_slope(key, edge, end);
    // Across one edge is along the other one.
    const double outwards = end_slope(key, end_edge(edge, end), side);
    node.across = is_far(edge) ? outwards : -outwards;
    const double twist = corner_twist(key, column, row);
    node.twist = is_far(edge) ? twist : -twist;
  }
  for (std::size_t at = 1; at + 1 < count; ++at) {
    const double da = along[at] - along[at - 1];
    const double db = along[at + 1] - along[at];
    nodes[at].twist = middle_slope((nodes[at].across - nodes[at - 1].across) / da, da,
                                   (nodes[at + 1].across - nodes[at].across) / db, db);
  }
  return nodes;
}

BorderNode BorderRule::on_curve(const std::vector<BorderNode>& nodes, const std::vector<double>& lines,
                                double at) const {
  const int last = static_cast<int>(nodes.size()) - 2;
  const int cell = std::clamp(static_cast<int>(at), 0, last);
  const double t = at - cell;
  const BorderNode& a = nodes[static_cast<std::size_t>(cell)];
  const BorderNode& b = nodes[static_cast<std::size_t>(cell) + 1];
  BorderNode found;
  if (!is_bicubic_) {
    found.height_m = a.height_m + t * (b.height_m - a.height_m);
    return found;
  }
  const double d = lines[static_cast<std::size_t>(cell) + 1] - lines[static_cast<std::size_t>(cell)];
  // A cubic through values p and q with slopes m and k; its value and slope.
  const auto cubic = [t, d](double p, double m, double q, double k) {
    const double rise = q - p;
    const double c1 = m * d;
    const double c2 = 3 * rise - d * (2 * m + k);
    const double c3 = d * (m + k) - 2 * rise;
    return std::pair(p + t * (c1 + t * (c2 + t * c3)), (c1 + t * (2 * c2 + 3 * t * c3)) / d);
  };
  std::tie(found.height_m, found.along) = cubic(a.height_m, a.along, b.height_m, b.along);
  std::tie(found.across, found.twist) = cubic(a.across, a.twist, b.across, b.twist);
  return found;
}

std::vector<BorderNode> BorderRule::edge(const lod::TileKey& key, Edge edge) const {
  Coarser beside;
  if (!coarser(key, edge, beside)) return own_edge(key, edge);
  const std::vector<BorderNode> curve = own_edge(beside.key, beside.edge);
  const lod::GridLines coarse_lines = tile(beside.key).lines;
  const std::vector<double>& coarse_along = runs_north(beside.edge) ? coarse_lines.v : coarse_lines.u;
  const lod::GridLines lines = tile(key).lines;
  const std::vector<double>& along = runs_north(edge) ? lines.v : lines.u;
  std::vector<BorderNode> nodes(along.size());
  const double turn = beside.reversed ? -1 : 1;
  const bool turns = is_cube_edge(key, edge);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    BorderNode& node = nodes[k];
    node = on_curve(curve, coarse_along, beside.first + static_cast<double>(k) * beside.step);
    node.along *= turn;
    // Outwards of the one is inwards of the other.
    node.across = -node.across - (turns ? along[k] * node.along : 0.0);
    node.twist *= -turn;
  }
  if (!turns || !is_bicubic_) return nodes;
  const std::size_t last = nodes.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const std::size_t a = k == 0 ? 0 : k - 1;
    const std::size_t b = std::min(k + 1, last);
    nodes[k].twist = (nodes[b].across - nodes[a].across) / (along[b] - along[a]);
  }
  return nodes;
}

}  // namespace vpe::voxel
