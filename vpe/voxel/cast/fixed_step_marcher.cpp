#include "vpe/voxel/cast/fixed_step_marcher.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/cast/facet_finder.h"

namespace vpe::voxel {

namespace {

// Returns H of a post of a grid in either precision.
double post(const Facets& f, int x, int y) {
  const int line = f.family == LineFamily::kColumns ? x : (f.family == LineFamily::kRows ? y : x - y);
  const int position = f.family == LineFamily::kColumns ? y : x;
  return f.exact_lines != nullptr ? f.exact_lines->line(line)[position]
                                  : static_cast<double>(f.lines->line(line)[position]);
}

struct Sample {
  double rise_m = 0;  // height of the sample above the ground, along the vertical
  double spacing_m = 0;
};

Sample sample(const glm::dvec3& place, FacetFinder& finder, double radius_m) {
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
  const double length = std::sqrt(p.u * p.u + p.v * p.v + 1);
  // The side of a cell, projected to the sphere.
  const double spacing = radius_m * std::sqrt(f.frame.du * f.frame.dv) / std::pow(length, 1.5);
  return {glm::length(place) - length / depth, spacing};
}

// Bisects between a place above the ground and one below it.
double crossing(const glm::dvec3& camera, const glm::dvec3& ray, double above, double below,
                FacetFinder& finder, double radius_m) {
  constexpr double kEnough = 1e-8;
  while (below - above > kEnough * below) {
    const double middle = 0.5 * (above + below);
    (sample(camera + middle * ray, finder, radius_m).rise_m <= 0 ? below : above) = middle;
  }
  return below;
}

}  // namespace

double march(const glm::dvec3& camera, const glm::dvec3& ray, double begin_m, double top_m, FacetFinder& finder,
             double radius_m) {
  const double half = glm::dot(camera, ray);
  const double rest = half * half - glm::dot(camera, camera) + top_m * top_m;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (!(rest >= 0)) return kNone;
  const double end = -half + std::sqrt(rest);
  double t = std::max(begin_m, -half - std::sqrt(rest));
  double last_t = t;
  for (bool first = true; t <= end; first = false) {
    const Sample s = sample(camera + t * ray, finder, radius_m);
    if (s.rise_m <= 0) return first ? t : crossing(camera, ray, last_t, t, finder, radius_m);
    last_t = t;
    t += kReferenceStep * s.spacing_m;
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
