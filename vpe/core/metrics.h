// How far an image is from the exact surface S, measured in pixels: the one library for every test and
// report.
//
// Images are range images of a View's drawn part: float32 metres from the camera along pixel_ray() of the
// pixel centre, infinity = sky. Two measures, because each is blind to what the other sees:
//
//  forward   each drawn surface pixel against S. Its 3-D point P is rebuilt from pose and range; the shift is
//            | |P| - S(P / |P|) | * f / range, f = focal_px(view). Blind to what was not drawn.
//  backward  each surface pixel of a reference image, cast against S exactly, against the drawn image.
//            Take pixel space about the reference hit Q at range t: two axes are the image's, in pixels;
//            the third is f (t / range), so that a length in it is about the displacement in space divided by
//            the size of a pixel at Q. Every drawn pixel is a point there (sky at depth 0), neighbouring
//            pixels (8 ways) are joined by straight edges: planes stay plane, and at a silhouette the edge
//            spans the gap. The shift is the distance from Q to the nearest edge within search_px columns
//            and rows. So it is 0 where the drawn range agrees; e f / t where the drawn surface lies e
//            metres off; the image distance, where the range of Q is found beside it; and large where
//            it is not found at all, as for a missing ridge. (On a height field steeper rays hit nearer ground,
//            so what is displaced by a pixel is found between the pixels above and below.) Edges leave gaps of
//            half a cell: up to 8 % too large on a slope that falls between the eight ways. Where the reference
//            is sky, the shift is the distance to the nearest drawn sky pixel, a whole number of pixels along
//            rows and columns.
//
// Float32 ranges have a relative rounding error of 6e-8: it adds at most 6e-8 f (1 + slope of S) px to
// a forward shift (f = 600: 4e-5 px) and 1.2e-7 f px to a backward one; rounding of P adds 2e-9 m f / range.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "vpe/core/view.h"

namespace vpe::core {

// Radius of S in metres at unit body-fixed directions; spans of equal size. Called from `threads` threads at
// once, with one image row a call.
using SurfaceRadius = std::function<void(std::span<const glm::dvec3> directions, std::span<double> radius_m)>;

struct MetricOptions {
  int search_px = 4;  // backward: how far to look for a reference hit, >= 1
  int threads = 1;    // results do not depend on it
};

// One shift in pixels per drawn pixel, row by row; NaN where there is nothing to measure: for forward_shift
// the sky and invalid ranges (NaN, <= 0), for backward_shift the image's outermost pixels, whose
// neighbours are not all there, and invalid ranges of the reference. An invalid drawn range counts as sky.
// Throw std::invalid_argument when sizes do not fit the view.
std::vector<double> forward_shift_px(const View& view, std::span<const float> range_m,
                                     const SurfaceRadius& surface, const MetricOptions& options = {});
std::vector<double> backward_shift_px(const View& view, std::span<const float> range_m,
                                      std::span<const float> reference_m, const MetricOptions& options = {});

struct ShiftSummary {
  std::int64_t pixels = 0;  // measured; with 0 all else is 0
  // Quantile q: the smallest shift that at least a share q of the measured pixels does not exceed.
  double median_px = 0;
  double p90_px = 0;
  double p99_px = 0;
  double p999_px = 0;
  double max_px = 0;
  double share_over_1px = 0;
  int worst_x = -1;  // column and row of max_px in the drawn part
  int worst_y = -1;
};

// Of the shifts that are not NaN; infinite ones count as largest.
ShiftSummary summarize(std::span<const double> shift_px, int width);

struct ImageErrors {
  ShiftSummary forward;
  ShiftSummary backward;
  std::int64_t sky_for_ground =
      0;                           // drawn sky where the reference is surface in the pixel and its 8 neighbours
  std::int64_t false_surface = 0;  // drawn surface where the reference is sky in all nine
  // Neither is counted in the outermost pixels: an outline may pass within a pixel of them outside the image.
  std::int64_t invalid = 0;  // drawn ranges that are NaN or <= 0: no renderer should make them
};

ImageErrors compare_to_reference(const View& view, std::span<const float> range_m,
                                 std::span<const float> reference_m, const SurfaceRadius& surface,
                                 const MetricOptions& options = {});

// One JSON object, keys as the fields.
std::string to_json(const ImageErrors& errors);

// What an image cannot be, known without a reference: sky where the ray meets the sphere through the lowest
// terrain, surface where it passes above the sphere through the highest. Pixels within 1e-12 rad of a
// sphere's rim count as neither. A camera inside a sphere meets it everywhere.
struct HorizonErrors {
  std::int64_t sky_below = 0;
  std::int64_t surface_above = 0;
};
HorizonErrors check_horizon(const View& view, std::span<const float> range_m, double lowest_radius_m,
                            double highest_radius_m);

}  // namespace vpe::core
