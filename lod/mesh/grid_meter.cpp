#include "lod/mesh/grid_meter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lod/mesh/mesh_overlay.h"

namespace lod {

namespace {

// The largest distances at posts so far.
struct Largest {
  double total = 0;
  double sagitta = 0;
  double height_error = 0;
};

}  // namespace

struct GridMeter::Prepared : FineGrid {
  Prepared(const Posts& posts, double radius) : FineGrid(posts, radius) {
    const auto side = static_cast<std::size_t>(u.count());
    for (std::size_t j = 0; j < side; ++j) {
      for (std::size_t i = 0; i < side; ++i) {
        const std::size_t at = j * side + i;
        const auto steepen = [at](const std::vector<double>& f, std::size_t next, double width, double& most) {
          most = std::max(most, std::abs(f[next] - f[at]) / width);
        };
        if (i + 1 < side) {
          const double width = u.data()[i + 1] - u.data()[i];
          steepen(depth, at + 1, width, depth_du);
          steepen(length, at + 1, width, length_du);
        }
        if (j + 1 < side) {
          const double width = v.data()[j + 1] - v.data()[j];
          steepen(depth, at + side, width, depth_dv);
          steepen(length, at + side, width, length_dv);
        }
      }
    }
    least_depth = *std::min_element(depth.begin(), depth.end());
  }

  // The steepest slopes of all facets; each facet has an edge along u and one along v.
  double depth_du = 0;
  double depth_dv = 0;
  double length_du = 0;
  double length_dv = 0;
  double least_depth = 0;
};

GridMeter::GridMeter(const Posts& posts, double radius_m)
    : prepared_(std::make_unique<const Prepared>(posts, radius_m)) {}
GridMeter::~GridMeter() = default;
GridMeter::GridMeter(GridMeter&&) noexcept = default;
GridMeter& GridMeter::operator=(GridMeter&&) noexcept = default;

namespace {

// A plane over a cell, of depth or of length: the value at the cell's low corner and the slopes.
struct Plane {
  double at;
  double du;
  double dv;
};

struct Facet {
  Plane depth;
  Plane length;
};

// Computes the facets below and above the diagonal of cell (i, j).
void facets_of(const FineGrid& grid, std::size_t i, std::size_t j, Facet& low, Facet& high) {
  const auto side = static_cast<std::size_t>(grid.u.count());
  const std::size_t at = j * side + i;
  const double per_u = 1.0 / (grid.u.data()[i + 1] - grid.u.data()[i]);
  const double per_v = 1.0 / (grid.v.data()[j + 1] - grid.v.data()[j]);
  const auto planes = [&](const std::vector<double>& f, Plane& below, Plane& above) {
    const double sw = f[at];
    const double se = f[at + 1];
    const double nw = f[at + side];
    const double ne = f[at + side + 1];
    below = {sw, (se - sw) * per_u, (ne - se) * per_v};
    above = {sw, (ne - nw) * per_u, (nw - sw) * per_v};
  };
  planes(grid.depth, low.depth, high.depth);
  planes(grid.length, low.length, high.length);
}

}  // namespace

ErrorTerms GridMeter::measure(const FinePosts& posts) const {
  const Prepared& coarse = *prepared_;
  const FineGrid& fine = posts.grid();
  const int below = fine.key.level - coarse.key.level;
  if (!contains(coarse.key, fine.key) || fine.intervals != coarse.intervals) {
    throw std::invalid_argument("GridMeter: tile " + to_string(fine.key) + " of " +
                                std::to_string(fine.intervals) + " intervals is not below tile " +
                                to_string(coarse.key) + " of " + std::to_string(coarse.intervals));
  }
  if (fine.radius_m != coarse.radius_m)
    throw std::invalid_argument("GridMeter: posts have different planet radii");

  const auto side = static_cast<std::size_t>(fine.u.count());
  const auto n = static_cast<std::int64_t>(fine.intervals);
  // The first coarse cell under the fine tile, and the largest number of fine posts between two coarse lines.
  const auto first = [&](std::int32_t index, std::int32_t coarse_index) {
    return ((index - (std::int64_t{coarse_index} << below)) * n) >> below;
  };
  const auto ci0 = static_cast<std::size_t>(first(fine.key.i, coarse.key.i));
  const auto cj0 = static_cast<std::size_t>(first(fine.key.j, coarse.key.j));
  const std::size_t step =
      below < 30 && (std::int64_t{1} << below) < n ? std::size_t{1} << below : static_cast<std::size_t>(n);
  // The widest edges of S along u and along v.
  const double margin_u = fine.u.widest();
  const double margin_v = fine.v.widest();

  Largest most;
  Facet low;
  Facet high;
  for (std::size_t j0 = 0; j0 + 1 < side; j0 += step) {
    const std::size_t cj = cj0 + j0 / step;
    const double v0 = coarse.v.data()[cj];
    const double per_v = 1.0 / (coarse.v.data()[cj + 1] - v0);
    for (std::size_t i0 = 0; i0 + 1 < side; i0 += step) {
      const std::size_t ci = ci0 + i0 / step;
      const double u0 = coarse.u.data()[ci];
      const double per_u = 1.0 / (coarse.u.data()[ci + 1] - u0);
      // Posts this close to the diagonal, in cells, count with both facets: slightly more than half an edge.
      const double margin = 0.501 * std::max(margin_u * per_u, margin_v * per_v);
      facets_of(coarse, ci, cj, low, high);
      for (std::size_t j = j0; j <= j0 + step; ++j) {
        const double dv = fine.v.data()[j] - v0;
        const double y = dv * per_v;
        const double* depth = fine.depth.data() + j * side;
        const double* length = fine.length.data() + j * side;
        const auto add = [&](const Facet& facet, std::size_t from, std::size_t to) {
          const double w_row = facet.depth.at + facet.depth.dv * dv;
          const double n_row = facet.length.at + facet.length.dv * dv;
          double total_most = most.total;
          double sagitta_most = most.sagitta;
          double height_error_most = most.height_error;
          for (std::size_t i = from; i < to; ++i) {
            const double du = fine.u.data()[i] - u0;
            const double w = w_row + facet.depth.du * du;
            const double l = n_row + facet.length.du * du;
            // The formulas of Overlay::add() in error_meter.cpp; the direction's length is that of S's post.
            const double scale = fine.radius_m / (w * depth[i] * l);
            const double total = (depth[i] - w) * (l * length[i]) * scale;
            const double sagitta = (length[i] - l) * (w * depth[i]) * scale;
            total_most = std::max(total_most, std::abs(total));
            sagitta_most = std::max(sagitta_most, std::abs(sagitta));
            height_error_most = std::max(height_error_most, std::abs(total - sagitta));
          }
          most = {total_most, sagitta_most, height_error_most};
        };
        const double* u = fine.u.data();
        const auto low_from = static_cast<std::size_t>(
            std::lower_bound(u + i0, u + i0 + step + 1, u0 + (y - margin) / per_u) - u);
        const auto high_to = static_cast<std::size_t>(
            std::upper_bound(u + i0, u + i0 + step + 1, u0 + (y + margin) / per_u) - u);
        add(high, i0, high_to);
        add(low, low_from, i0 + step + 1);
      }
    }
  }

  // The formulas of Overlay::terms() in error_meter.cpp.
  const double coarse_depth = (coarse.depth_du * margin_u + coarse.depth_dv * margin_v) / coarse.least_depth;
  const double coarse_length = coarse.length_du * margin_u + coarse.length_dv * margin_v;  // lengths are >= 1
  const double kappa = (1.0 + fine.length_variation) * (1.0 + fine.depth_variation) *
                       (1.0 + std::min(coarse_depth, coarse.depth_variation));
  const double flat = (1.0 + fine.length_variation) * (1.0 + fine.length_variation) * (1.0 + coarse_length);
  ErrorTerms terms;
  terms.height_error_m = most.height_error + (kappa - 1.0) * most.total + (flat - 1.0) * most.sagitta;
  terms.sagitta_m = flat * most.sagitta;
  terms.total_m = std::min(kappa * most.total, terms.height_error_m + terms.sagitta_m);
  return terms;
}

}  // namespace lod
