// Foveated images: a ray for each pixel of the middle, half as many columns and rows elsewhere (rays.fovea).
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RayRenderer draws the two views of a FoveaPlan and merges them
// here. In the middle the image is that without rays.fovea, to the bit. Pure but for the threads that are lent.
//
// Typical usage:
//   const std::optional<FoveaPlan> plan = fovea_plan(request);
//   if (!plan) ...                                        // the image has one density
//   ...                                                   // draw plan->outer, and plan->dense of request.view
//   spread_ranges(*plan, view, outer_m, pool, range_m);   // range_m holds those of plan->dense
//   merge_colours(*plan, view, {outer_colour, dense_colour}, pool, colour);
#pragma once

#include <optional>
#include <span>

#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"

namespace vpe::voxel {

// Pixels of the image along a side of an outer pixel.
inline constexpr int kThinned = 2;

// Largest distance in the image between a pixel outside of the middle and the rays whose colours are mixed in it:
// half a pixel to the nearest ray along each side, one and a half to the next. Its range is that of the nearest.
inline constexpr double kThinnedColour_px = 2.1214;  // 1.5 sqrt(2), rounded up
inline constexpr double kThinnedRange_px = 0.7072;   // sqrt(2) / 2, rounded up

// Returns the bound of what thinning adds to the shift of pixels: the distance of their colours, or the height by
// which the ground rises between a pixel and the ray whose range it has. `steepest_slope` bounds the tangent of its
// slope.
double thinning_px(double steepest_slope);

// Describes the two densities of an image. Rectangles are in pixels of the full image.
struct FoveaPlan {
  core::SubRectangle middle;  // has the colours of dense rays alone; of the full image, whatever part is drawn
  core::SubRectangle dense;   // the middle, a border that fades, and what filters read; of the drawn part
  core::View outer;           // the drawn part, of pixels twice as wide and as tall
};

// Widest field of view that is thinned. In wider ones pixels at the middle outweigh all others.
inline constexpr double kWidestFovea_deg = 170;

// Returns nullopt if the image has one density: without rays.fovea, or where the border leaves nothing to thin. Parts
// of an image have the middle of the whole. Requires a request that why_not() accepts (ray_request.h).
std::optional<FoveaPlan> fovea_plan(const core::DrawRequest& request);

// Writes the ranges of all pixels outside of plan.dense: that of the outer ray nearest to the pixel's own, without
// any mean across steps of depth. `outer_m` holds those of plan.outer, range_m those of the drawn part of `view`.
void spread_ranges(const FoveaPlan& plan, const core::View& view, std::span<const float> outer_m,
                   base::ThreadPool& pool, std::span<float> range_m);

// Writes the colours of the drawn part of `view`: those of plan.dense in the middle, bilinear means of those of
// plan.outer outside of plan.dense, and between them a mixture that changes evenly over kFade_px.
inline constexpr int kFade_px = 8;
struct FoveaColours {
  std::span<const base::Rgb> outer;  // of plan.outer
  std::span<const base::Rgb> dense;  // of plan.dense, row by row
};
void merge_colours(const FoveaPlan& plan, const core::View& view, const FoveaColours& from,
                   base::ThreadPool& pool, std::span<base::Rgb> colour);

}  // namespace vpe::voxel
