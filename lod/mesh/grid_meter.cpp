#include "lod/mesh/grid_meter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "lod/mesh/grid_kernel.h"
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

// Visits the posts of a finest tile with the coarse facets over them.
class GridOverlay {
 public:
  // `cells` are the coarse cells along each side that the tile has, `step` posts wide.
  GridOverlay(const FineGrid& coarse, const FineGrid& fine, std::size_t step)
      : coarse_(coarse),
        fine_(fine),
        side_(fine.side()),
        step_(step),
        cells_((side_ - 1) / step),
        depth_weight_(std::pow(1.0 + std::max(0.0, fine.highest_m / fine.radius_m), 2)) {
    strip_.resize(cells_ * (step_ + 1));
    depth_.assign(strip_.count, 1);
    length_.assign(strip_.count, 1);
  }

  // Visits the rows of a strip of cells, of which (ci, cj) is the first; the tile's row is j0. Leaves out rows that raise
  // nothing unless all are wanted.
  void add_strip(std::size_t ci, std::size_t cj, std::size_t j0, bool all) {
    ci_ = ci;
    cj_ = cj;
    v0_ = coarse_.v.data()[cj];
    per_v_ = 1.0 / (coarse_.v.data()[cj + 1] - v0_);
    widest_margin_ = 0;
    if (!all) fill_strip();
    for (std::size_t j = j0; j <= j0 + step_; ++j)
      if (all || !leaves_out(j)) add_row(j);
  }

  const Largest& largest() const { return most_; }

 private:
  double margin(std::size_t c) const {
    const double per_u = 1.0 / (coarse_.u.data()[ci_ + c + 1] - coarse_.u.data()[ci_ + c]);
    // Slightly more than half of an edge of S.
    return 0.501 * std::max(fine_.u.widest() * per_u, fine_.v.widest() * per_v_);
  }

  void fill_strip() {
    Facet low;
    Facet high;
    std::size_t at = 0;
    for (std::size_t c = 0; c < cells_; ++c) {
      const double u0 = coarse_.u.data()[ci_ + c];
      const double per_u = 1.0 / (coarse_.u.data()[ci_ + c + 1] - u0);
      widest_margin_ = std::max(widest_margin_, margin(c) + 1e-9);
      facets_of(coarse_, ci_ + c, cj_, low, high);
      for (std::size_t k = 0; k <= step_; ++k, ++at) {
        const double du = fine_.u.data()[c * step_ + k] - u0;
        strip_.x[at] = du * per_u;
        const auto put = [&](const Facet& facet, StripPlanes& planes) {
          planes.depth[at] = facet.depth.at + facet.depth.du * du;
          planes.depth_dv[at] = facet.depth.dv;
          planes.length[at] = facet.length.at + facet.length.du * du;
          planes.length_dv[at] = facet.length.dv;
        };
        put(low, strip_.low);
        put(high, strip_.high);
      }
    }
  }

  // Returns true if no post of the row can raise any of the largest distances. A distance is |D| n R / (W W') with depths
  // W of the post and W' = W - D of the facet, and W is at least n R / (R + h) with the highest post's h; a sagitta is
  // |L| R / (n - L); the height error at most the sum of both.
  bool leaves_out(std::size_t j) {
    constexpr double kRounding = 1e-14;
    const double* depth = fine_.depth.data() + j * side_;
    const double* length = fine_.length.data() + j * side_;
    std::size_t at = 0;
    for (std::size_t c = 0; c < cells_; ++c) {
      const double* from_depth = depth + c * step_;
      const double* from_length = length + c * step_;
      for (std::size_t k = 0; k <= step_; ++k, ++at) {
        depth_[at] = from_depth[k];
        length_[at] = from_length[k];
      }
    }
    const double dv = fine_.v.data()[j] - v0_;
    const StripDifferences found = strip_differences(
        strip_, {depth_.data(), length_.data(), dv, dv * per_v_, widest_margin_}, depth_weight_);
    const double closer = 1.0 - std::max(found.depth * depth_weight_, found.length);
    if (!(closer > 0.5)) return false;
    const double metres = fine_.radius_m / closer * (1 + 1e-9);
    const double rounding_m = kRounding * fine_.radius_m;
    return metres * depth_weight_ * found.depth + rounding_m <= most_.total &&
           metres * found.length + rounding_m <= most_.sagitta &&
           metres * found.both + rounding_m <= most_.height_error;
  }

  void add_row(std::size_t j) {
    Facet low;
    Facet high;
    const double dv = fine_.v.data()[j] - v0_;
    const double y = dv * per_v_;
    const double* depth = fine_.depth.data() + j * side_;
    const double* length = fine_.length.data() + j * side_;
    const double* u = fine_.u.data();
    for (std::size_t c = 0; c < cells_; ++c) {
      const std::size_t i0 = c * step_;
      const double u0 = coarse_.u.data()[ci_ + c];
      const double per_u = 1.0 / (coarse_.u.data()[ci_ + c + 1] - u0);
      const double beside = margin(c);
      facets_of(coarse_, ci_ + c, cj_, low, high);
      const auto add = [&](const Facet& facet, std::size_t from, std::size_t to) {
        const double w_row = facet.depth.at + facet.depth.dv * dv;
        const double n_row = facet.length.at + facet.length.dv * dv;
        double total_most = most_.total;
        double sagitta_most = most_.sagitta;
        double height_error_most = most_.height_error;
        for (std::size_t i = from; i < to; ++i) {
          const double du = fine_.u.data()[i] - u0;
          const double w = w_row + facet.depth.du * du;
          const double l = n_row + facet.length.du * du;
          // The formulas of OverlayPoints::add(); the direction's length is that of S's post.
          const double scale = fine_.radius_m / (w * depth[i] * l);
          const double total = (depth[i] - w) * (l * length[i]) * scale;
          const double sagitta = (length[i] - l) * (w * depth[i]) * scale;
          total_most = std::max(total_most, std::abs(total));
          sagitta_most = std::max(sagitta_most, std::abs(sagitta));
          height_error_most = std::max(height_error_most, std::abs(total - sagitta));
        }
        most_ = {total_most, sagitta_most, height_error_most};
      };
      const auto low_from =
          static_cast<std::size_t>(std::lower_bound(u + i0, u + i0 + step_ + 1, u0 + (y - beside) / per_u) - u);
      const auto high_to =
          static_cast<std::size_t>(std::upper_bound(u + i0, u + i0 + step_ + 1, u0 + (y + beside) / per_u) - u);
      add(high, i0, high_to);
      add(low, low_from, i0 + step_ + 1);
    }
  }

  const FineGrid& coarse_;
  const FineGrid& fine_;
  std::size_t side_;
  std::size_t step_;
  std::size_t cells_;
  double depth_weight_;
  GridStrip strip_;
  std::vector<double> depth_;  // of a row at the strip's columns
  std::vector<double> length_;
  std::size_t ci_ = 0;
  std::size_t cj_ = 0;
  double v0_ = 0;
  double per_v_ = 0;
  double widest_margin_ = 0;
  Largest most_;
};

}  // namespace

ErrorTerms GridMeter::measure(const FinePosts& posts) const { return measure(posts, false); }

ErrorTerms GridMeter::measure_all(const FinePosts& posts) const { return measure(posts, true); }

ErrorTerms GridMeter::measure(const FinePosts& posts, bool all) const {
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

  GridOverlay overlay(coarse, fine, step);
  // Sagittas grow towards the middle of the face: the strips at both ends come first, so that others can be left out.
  const std::size_t last = side - 1 - step;
  for (std::size_t j0 = last; j0 <= last; j0 = j0 == last ? 0 : j0 + step) {
    overlay.add_strip(ci0, cj0 + j0 / step, j0, all);
    if (j0 + step == last || last == 0) break;
  }
  const Largest& most = overlay.largest();

  // The formulas of OverlayPoints::terms().
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
