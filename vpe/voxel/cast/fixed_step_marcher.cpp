#include "vpe/voxel/cast/fixed_step_marcher.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/cast/facet_finder.h"
#include "vpe/voxel/columns/grid_ray.h"

namespace vpe::voxel {

namespace {

// Returns H of a post of a grid in either precision.
double post(const Facets& f, int x, int y) {
  return f.exact_lines != nullptr ? post_height(*f.exact_lines, f.family, x, y)
                                  : static_cast<double>(post_height(*f.lines, f.family, x, y));
}

// Returns the height of a place above the ground, along the vertical.
double rise_m(const glm::dvec3& place, FacetFinder& finder, double radius_m) {
  const Facets& f = finder.at(place);
  const mars::ChartPoint p = mars::chart_on(f.face, place);
  const double x = (p.u - f.frame.u0) / f.frame.du;
  const double y = (p.v - f.frame.v0) / f.frame.dv;
  const int last = f.frame.intervals - 1;
  const int i = std::clamp(static_cast<int>(x), 0, last);
  const int j = std::clamp(static_cast<int>(y), 0, last);
  const double s = x - i;
  const double t = y - j;
  const double h00 = post(f, i, j);
  const double h11 = post(f, i + 1, j + 1);
  const double hm = s >= t ? post(f, i + 1, j) : post(f, i, j + 1);
  const double high = std::max(s, t);
  const double low = std::min(s, t);
  const double h = h00 + high * (hm - h00) + low * (h11 - hm);
  const DepthPlane& plane = f.exact_lines != nullptr ? f.exact_lines->reference : f.lines->reference;
  const double depth = plane.w0 + plane.wx * x + plane.wy * y - h / (radius_m * radius_m);
  return glm::length(place) - std::sqrt(p.u * p.u + p.v * p.v + 1) / depth;
}

// Bisects between a place above the ground and one below it.
double crossing(const glm::dvec3& camera, const glm::dvec3& ray, double above, double below,
                FacetFinder& finder, double radius_m) {
  constexpr double kEnough = 1e-8;
  while (below - above > kEnough * below) {
    const double middle = 0.5 * (above + below);
    (rise_m(camera + middle * ray, finder, radius_m) <= 0 ? below : above) = middle;
  }
  return below;
}

// Returns H of post (x, y) of a grid.
template <LineFamily family, typename T>
T post_of(const HeightGridLines<T>& lines, int x, int y) {
  if constexpr (family == LineFamily::kColumns) return lines.posts[x * lines.side + y];
  if constexpr (family == LineFamily::kRows) return lines.posts[y * lines.side + x];
  return lines.line(x - y)[x];
}

struct Steps {
  int count =
      0;  // to the first sample below the ground or, if there is none, out of the grid or beyond the end
  bool is_below = false;
};

// Samples a ray within one grid, step by step from its first place, up to `most_m` from there. At least one sample counts
// as in the grid.
template <LineFamily family, typename T>
Steps step_through(const GridRay& ray, int intervals, const HeightGridLines<T>& lines, double step_m,
                   double most_m) {
  const auto size = static_cast<T>(intervals);
  const int last = intervals - 1;
  // Moving by a step at a time would add up rounding.
  const glm::vec<4, T> at(ray.at());
  const glm::vec<4, T> by(ray.per_m() * step_m);
  const int most = static_cast<int>(std::min(most_m / step_m, 1e9));
  for (int n = 0;; ++n) {
    const T steps = static_cast<T>(n);
    const T inverse = 1 / (at.w + steps * by.w);
    const T x = (at.x + steps * by.x) * inverse;
    const T y = (at.y + steps * by.y) * inverse;
    const bool is_inside = x >= 0 && x <= size && y >= 0 && y <= size;
    if (n > 0 && (!is_inside || n > most)) return {n, false};
    const int i = std::clamp(static_cast<int>(x), 0, last);
    const int j = std::clamp(static_cast<int>(y), 0, last);
    const T s = x - static_cast<T>(i);
    const T t = y - static_cast<T>(j);
    const T h00 = post_of<family>(lines, i, j);
    const T h11 = post_of<family>(lines, i + 1, j + 1);
    const T hm = s >= t ? post_of<family>(lines, i + 1, j) : post_of<family>(lines, i, j + 1);
    const T ground = h00 + std::max(s, t) * (hm - h00) + std::min(s, t) * (h11 - hm);
    if ((at.z + steps * by.z) * inverse <= ground) return {n, true};
  }
}

}  // namespace

double march(const glm::dvec3& camera, const glm::dvec3& ray, double begin_m, double top_m, FacetFinder& finder,
             double radius_m) {
  const double half = glm::dot(camera, ray);
  const double rest = half * half - glm::dot(camera, camera) + top_m * top_m;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (!(rest >= 0)) return kNone;
  const double end_m = -half + std::sqrt(rest);
  const double first_m = std::max(begin_m, -half - std::sqrt(rest));
  double above_m = first_m;  // of the last sample
  for (double t = first_m; t <= end_m;) {
    const Facets& facets = finder.at(camera + t * ray);
    const GridRay grid(camera, ray, t, facets.face, facets.frame,
                       facets.exact_lines != nullptr ? facets.exact_lines->reference : facets.lines->reference,
                       radius_m);
    const double step_m = kReferenceStep * grid.cell_m();
    const int intervals = facets.frame.intervals;
    const auto in_grid = [&](const auto& lines) {
      switch (facets.family) {
        case LineFamily::kColumns:
          return step_through<LineFamily::kColumns>(grid, intervals, lines, step_m, end_m - t);
        case LineFamily::kRows:
          return step_through<LineFamily::kRows>(grid, intervals, lines, step_m, end_m - t);
        case LineFamily::kDiagonals: break;
      }
      return step_through<LineFamily::kDiagonals>(grid, intervals, lines, step_m, end_m - t);
    };
    const Steps steps = facets.exact_lines != nullptr ? in_grid(*facets.exact_lines) : in_grid(*facets.lines);
    const double at_m = t + static_cast<double>(steps.count) * step_m;
    if (steps.is_below) {
      if (steps.count == 0 && t == first_m) return first_m;
      return crossing(camera, ray, steps.count == 0 ? above_m : at_m - step_m, at_m, finder, radius_m);
    }
    above_m = at_m - step_m;
    t = at_m;
  }
  return kNone;
}

void march_fixed_steps(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
                       base::ThreadPool& pool, std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const auto width = static_cast<std::size_t>(part.width);
  pool.run(static_cast<std::size_t>(part.height), [&](std::size_t row) {
    const ScratchPool::Lease scratch = scratches.acquire();
    FacetFinder finder(walk, scratch->tiles);
    for (std::size_t x = 0; x < width; ++x) {
      const glm::dvec3 ray =
          core::pixel_ray(view, part.x + static_cast<double>(x) + 0.5, part.y + static_cast<double>(row) + 0.5);
      range_m[row * width + x] = static_cast<float>(
          march(view.camera.position_m, ray, 0, walk.highest_m(), finder, walk.camera().radius_m));
    }
  });
}

}  // namespace vpe::voxel
