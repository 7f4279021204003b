// Images of surfaces by the caster of relief, with sunlight and shadows.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "relief/cast/caster.h"
#include "vpe/base/parallel.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace vpe::app {

inline constexpr int kMostSamples = 8;  // on a side of a pixel

struct SurfaceImageOptions {
  glm::dvec3 towards_sun{0, 0, 1};  // unit
  bool has_shadows = true;
  std::string palette;      // of heights above the base; empty: grey
  int samples = 2;          // on a side of a pixel, 1 to kMostSamples. More: smoother edges, square of the time
  double tolerance_px = 0;  // relief::CastOptions::tolerance_px
};

struct SurfaceImage {
  core::RgbImage colours;
  std::size_t rays = 0;
  std::size_t hits = 0;
  double least_range_m = 0;  // of the hits; 0 without any
  double most_range_m = 0;
  double least_height_m = 0;  // above the base
  double most_height_m = 0;
  relief::CastCounts counts;
};

// Draws the full image of a view. The result does not depend on the pool. Light is Lambert's, with a fiftieth of ambient light;
// samples are averaged before the curve of sRGB. Throws what relief::cast() throws, and std::runtime_error for a palette that
// cannot be used.
SurfaceImage draw_surface(const relief::Surface& surface, const core::View& view,
                          const SurfaceImageOptions& options, base::ThreadPool& pool);

// Returns the ranges at the centres of a view's pixels, row by row; infinity where no ground is.
std::vector<float> surface_ranges(const relief::Surface& surface, const core::View& view, double tolerance_px,
                                  base::ThreadPool& pool);

}  // namespace vpe::app
