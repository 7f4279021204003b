#include "mars/sources/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "mars/sources/stack_walk.h"

namespace mars {
namespace {

// Compares heights with the base.
class Comparison {
 public:
  Comparison(const ElevationSource& base, double radius_m, const OutlierOptions& options)
      : base_(base), radius_m_(radius_m), options_(options) {}

  // Sets `excess_m` to how much the magnitude of the difference exceeds what is accepted as terrain: positive
  // for outliers, NaN where either is nodata. Sets `base_m` to the heights of the base.
  void excess(std::span<const glm::dvec3> directions, std::span<const double> heights_m,
              std::vector<double>& excess_m, std::vector<double>& base_m) const {
    const std::size_t n = directions.size();
    base_m.resize(n);
    base_.sample(directions, spacing_m_, base_m);
    excess_m.assign(n, std::numeric_limits<double>::quiet_NaN());
    // The surroundings are sampled only for posts that exceed the floor.
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < n; ++i) {
      excess_m[i] = std::abs(heights_m[i] - base_m[i]) - options_.floor_m;
      if (excess_m[i] > 0) open.push_back(i);
    }
    if (open.empty()) return;
    std::vector<glm::dvec3> around;
    around.reserve(open.size() * kAround);
    for (const std::size_t i : open) add_ring(directions[i], around);
    std::vector<double> ring_m(around.size());
    base_.sample(around, spacing_m_, ring_m);
    for (std::size_t k = 0; k < open.size(); ++k) {
      double low = base_m[open[k]];
      double high = low;
      for (std::size_t j = 0; j < kAround; ++j) {
        const double h = ring_m[k * kAround + j];
        if (std::isnan(h)) continue;
        low = std::min(low, h);
        high = std::max(high, h);
      }
      const double terrain_m = std::max({options_.floor_m, options_.relief_share * (high - low),
                                         0.5 * options_.slope * base_spacing_m(directions[open[k]])});
      excess_m[open[k]] = std::abs(heights_m[open[k]] - base_m[open[k]]) - terrain_m;
    }
  }

 private:
  static constexpr std::size_t kAround = 8;

  double base_spacing_m(const glm::dvec3& d) const {
    const double spacing_m = base_.spacing_in({d, 0});
    return std::isfinite(spacing_m) ? spacing_m : 0;
  }

  void add_ring(const glm::dvec3& d, std::vector<glm::dvec3>& out) const {
    const double radius_rad = base_spacing_m(d) / radius_m_;
    const glm::dvec3 u = any_perpendicular(d);
    const glm::dvec3 v = glm::cross(d, u);
    for (std::size_t j = 0; j < kAround; ++j) {
      const double angle_rad = 2 * std::numbers::pi * static_cast<double>(j) / kAround;
      out.push_back(glm::normalize(d + radius_rad * (std::cos(angle_rad) * u + std::sin(angle_rad) * v)));
    }
  }

  const ElevationSource& base_;
  double spacing_m_ = resolution_m(base_);  // of its data: detail that is made up contradicts nothing
  double radius_m_;
  OutlierOptions options_;
};

}  // namespace

OutlierReport find_outliers(const ElevationSource& inset, const ElevationSource& base, double radius_m,
                            const OutlierOptions& options, std::size_t max_posts) {
  const Comparison comparison(base, radius_m, options);
  OutlierReport report;
  std::vector<double> excess_m;
  std::vector<double> base_m;
  inset.visit_posts(max_posts, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    comparison.excess(directions, heights_m, excess_m, base_m);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (std::isnan(excess_m[i])) continue;
      ++report.posts;
      if (excess_m[i] <= 0) continue;
      ++report.implausible;
      const double off = heights_m[i] - base_m[i];
      if (std::abs(off) > std::abs(report.worst_m)) {
        report.worst_m = off;
        report.worst_at = lon_lat(directions[i]);
      }
    }
  });
  return report;
}

PostMask outlier_mask(std::shared_ptr<const ElevationSource> base, double radius_m,
                      const OutlierOptions& options) {
  return [base = std::move(base), radius_m, options](std::span<const glm::dvec3> directions,
                                                     std::span<double> heights_m) {
    std::vector<double> excess_m;
    std::vector<double> base_m;
    Comparison(*base, radius_m, options).excess(directions, heights_m, excess_m, base_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i) {
      if (excess_m[i] > 0) heights_m[i] = std::numeric_limits<double>::quiet_NaN();
    }
  };
}

}  // namespace mars
