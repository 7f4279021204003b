// The shift of pixels: the error of an image against the exact reference surface, measured in pixels. Every
// test and report uses these functions.
//
// Images are range images of a View's drawn part: float32 metres from the camera along pixel_ray() of the pixel
// centre, infinity = sky. There are two measures, because each is blind to errors that the other sees. S is the
// reference surface.
//
//  forward   Compares each drawn surface pixel with S. Its 3-D point P is rebuilt from pose and range; the
//            shift is | |P| - S(P / |P|) | * f / range, f = focal_px(view). Does not see surface that was not
//            drawn.
//  backward  Compares each surface pixel of a reference image, cast against S exactly, with the drawn image.
//            Pixel space about the reference hit Q at range t has two axes in the image, in pixels. The third
//            is f (t / range), so that a length in it is about the displacement in space divided by the size
//            of a pixel at Q. Every drawn pixel is a point there (sky at depth 0), and neighbouring pixels (8
//            directions) are joined by straight edges: planes stay planes, and at a silhouette the edge
//            bridges the jump. The shift is the distance from Q to the nearest edge within search_px columns
//            and rows. It is 0 where the drawn range agrees; e f / t where the drawn surface lies e metres
//            off; the image distance where the range of Q is found beside it; and large where it is not found
//            at all, as for a missing ridge. (On a height field steeper rays hit nearer ground, so a surface
//            that is displaced by a pixel is found between the pixels above and below.) Points between edges
//            are up to half a cell from them: up to 8 % too large on a slope that falls between the eight
//            directions. Where the reference is sky, the shift is the distance to the nearest drawn sky pixel,
//            a whole number of pixels along rows and columns.
//
// Float32 ranges have a relative rounding error of 6e-8. It adds at most 6e-8 f (1 + slope of S) px to a
// forward shift (f = 600: 4e-5 px) and 1.2e-7 f px to a backward one. Rounding of P adds 2e-9 m f / range.
//
// Typical usage:
//   const ImageErrors errors = compare_to_reference(view, result.frame.range_m, reference_m, surface);
//   if (errors.forward.max_px > 1 || errors.sky_for_ground > 0) report(to_json(errors));
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "vpe/core/view.h"

namespace vpe::core {

// Writes the radius of the reference surface in metres at unit body-fixed directions; both spans have the same
// size. It is called from `threads` threads at once, with one image row per call.
using SurfaceRadius = std::function<void(std::span<const glm::dvec3> directions, std::span<double> radius_m)>;

struct MetricOptions {
  // Backward shift: radius of the search for a reference hit, >= 1. Larger: measures larger shifts, slower.
  int search_px = 4;
  int threads = 1;  // results do not depend on it
};

// Return one shift in pixels for each drawn pixel, row by row. A shift is NaN where there is nothing to
// measure: for forward_shift_px() at sky and invalid ranges (NaN, <= 0), for backward_shift_px() at the image's
// outermost pixels, which have too few neighbours, and at invalid ranges of the reference. An invalid drawn
// range counts as sky. Throw std::invalid_argument if the sizes do not fit the view.
std::vector<double> forward_shift_px(const View& view, std::span<const float> range_m,
                                     const SurfaceRadius& surface, const MetricOptions& options = {});
std::vector<double> backward_shift_px(const View& view, std::span<const float> range_m,
                                      std::span<const float> reference_m, const MetricOptions& options = {});

// Summarizes the shifts of an image. Quantiles are by nearest rank (base::sorted_quantile_rank).
struct ShiftSummary {
  std::int64_t pixels = 0;  // measured pixels; if 0, all other fields are 0
  double median_px = 0;
  double p90_px = 0;
  double p99_px = 0;
  double p999_px = 0;
  double max_px = 0;
  double share_over_1px = 0;
  int worst_x = -1;  // column and row of max_px in the drawn part
  int worst_y = -1;
};

// Returns the summary of the shifts that are not NaN. Infinite shifts count as the largest.
ShiftSummary summarize(std::span<const double> shift_px, int width);

struct ImageErrors {
  ShiftSummary forward;
  ShiftSummary backward;
  // The next two are not counted in the outermost pixels: an outline may pass within a pixel of them outside
  // the image.
  // Drawn sky where the reference is surface in the pixel and its 8 neighbours.
  std::int64_t sky_for_ground = 0;
  std::int64_t false_surface = 0;  // drawn surface where the reference is sky in all nine
  std::int64_t invalid = 0;        // drawn ranges that are NaN or <= 0, which no renderer should make
};

// Returns both measures of an image. Throws as forward_shift_px() does.
ImageErrors compare_to_reference(const View& view, std::span<const float> range_m,
                                 std::span<const float> reference_m, const SurfaceRadius& surface,
                                 const MetricOptions& options = {});

// Returns one JSON object.
std::string to_json(const ImageErrors& errors);

// Errors that can be found without a reference: sky where the ray meets the sphere through the lowest terrain,
// and surface where the ray passes above the sphere through the highest.
struct HorizonErrors {
  std::int64_t sky_below = 0;
  std::int64_t surface_above = 0;
};

// Counts these errors. Pixels within 1e-12 rad of a sphere's outline count as neither. A camera inside a sphere
// meets it in every direction.
HorizonErrors check_horizon(const View& view, std::span<const float> range_m, double lowest_radius_m,
                            double highest_radius_m);

}  // namespace vpe::core
