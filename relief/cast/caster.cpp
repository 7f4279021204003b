#include "relief/cast/caster.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "relief/cast/ray_caster.h"
#include "relief/cast/screen_tree.h"
#include "vpe/base/number.h"

namespace relief {

namespace {

constexpr double kLargestTolerance_px = 1000;

void check_options(const CastOptions& options) {
  using vpe::base::format_number;
  if (!(options.near_m >= 0 && options.near_m < options.far_m && options.far_m <= kFarthest_m))
    throw std::invalid_argument("casting from " + format_number(options.near_m) + " to " +
                                format_number(options.far_m) + " m: ranges must grow, from 0 to at most " +
                                format_number(kFarthest_m) + " m");
  if (!(options.tolerance_px >= 0 && options.tolerance_px <= kLargestTolerance_px))
    throw std::invalid_argument("casting with a tolerance of " + format_number(options.tolerance_px) +
                                " px: it must be 0 to " + format_number(kLargestTolerance_px));
}

void add(CastCounts& total, const CastCounts& part) {
  total.bundles += part.bundles;
  total.steps += part.steps;
  total.patches += part.patches;
}

unsigned all_pieces(const Surface& surface) { return (1U << surface.pieces().size()) - 1U; }

// Items are tiles of a perspective image, and rows of others.
void cast_tiles(const Surface& surface, const vpe::core::View& view, const CastOptions& options,
                vpe::base::ThreadPool& pool, CastResult& result) {
  const ScreenRays rays(surface, view);
  const int columns = (result.width + kTileSide - 1) / kTileSide;
  const int rows = (result.height + kTileSide - 1) / kTileSide;
  std::vector<CastCounts> counts(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  pool.run(counts.size(), [&](std::size_t n) {
    const int x = static_cast<int>(n % static_cast<std::size_t>(columns)) * kTileSide;
    const int y = static_cast<int>(n / static_cast<std::size_t>(columns)) * kTileSide;
    counts[n] = cast_tile(rays, options, x, y, result.range_m);
  });
  for (const CastCounts& part : counts) add(result.counts, part);
}

void cast_rows(const Surface& surface, const vpe::core::View& view, const CastOptions& options,
               vpe::base::ThreadPool& pool, CastResult& result) {
  const RayCaster caster(surface);
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  const RaySpan span{options.near_m, options.far_m, options.tolerance_px / vpe::core::focal_px(view)};
  std::vector<CastCounts> counts(static_cast<std::size_t>(result.height));
  pool.run(counts.size(), [&](std::size_t row) {
    for (int x = 0; x < result.width; ++x) {
      const glm::dvec3 direction =
          vpe::core::pixel_ray(view, part.x + x + 0.5, part.y + static_cast<double>(row) + 0.5);
      result.range_m[row * static_cast<std::size_t>(result.width) + static_cast<std::size_t>(x)] =
          caster.first_hit({view.camera.position_m, direction}, span, all_pieces(surface), counts[row]);
    }
  });
  for (const CastCounts& row : counts) add(result.counts, row);
}

}  // namespace

CastResult cast(const Surface& surface, const vpe::core::View& view, const CastOptions& options,
                vpe::base::ThreadPool& pool) {
  if (const std::string problem = vpe::core::check(view); !problem.empty())
    throw std::invalid_argument(problem);
  check_options(options);
  const glm::ivec2 size = vpe::core::drawn_size(view);
  CastResult result{size.x, size.y, {}, {}};
  result.range_m.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), kNoHit);
  const bool is_perspective = view.projection == vpe::core::Projection::kPerspective;
  (is_perspective ? cast_tiles : cast_rows)(surface, view, options, pool, result);
  return result;
}

double cast_ray(const Surface& surface, const glm::dvec3& origin_m, const glm::dvec3& direction, double near_m,
                double far_m) {
  if (!(std::abs(glm::dot(direction, direction) - 1) <= 1e-9) || !std::isfinite(glm::dot(origin_m, origin_m)))
    throw std::invalid_argument("casting a ray: its origin must be finite and its direction a unit vector");
  check_options({near_m, far_m, 0});
  CastCounts counts;
  return RayCaster(surface).first_hit({origin_m, direction}, {near_m, far_m, 0}, all_pieces(surface), counts);
}

}  // namespace relief
