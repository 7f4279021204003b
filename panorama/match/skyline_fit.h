// Fits of a photograph's attitude to a skyline, from a start that is near.
//
// Residuals are distances between a point of the photograph's skyline and that of the planet, in pixels across the
// skyline. Tukey's weights (Beaton and Tukey 1974, c = 4.685) let up to about half of the points lie elsewhere: near
// rocks, wrong edges, errors of the terrain. All functions are pure and may be called from any thread.
#pragma once

#include <span>
#include <vector>

#include "panorama/match/photo_camera.h"
#include "panorama/match/sky_line.h"
#include "panorama/match/skyline_profile.h"

namespace panorama {

// Holds the residual, in robust standard deviations, from which on a point is an outlier.
inline constexpr double kTukey = 4.685;
// Bounds the robust standard deviation of residuals from below: what finding an edge is good for.
inline constexpr double kLeastScale_px = 0.5;

// Describes what is fitted: the photograph's skyline, its camera, the skyline of the planet.
struct FitProblem {
  std::span<const SkyPoint> points;
  PhotoShape shape;
  const SkylineProfile* profile = nullptr;  // not null; must live as long
  bool fit_fov = false;                     // else the pose's field of view is kept
};

// Holds a fit. With less than 8 points it is the start, with infinite scale.
struct SkylineFit {
  PhotoPose pose;
  double scale_px = 0;  // standard deviation of the residuals without outliers, at least kLeastScale_px
};

// Returns the residual of each point, in pixels across the skyline, positive: the point is above it.
std::vector<double> residuals_px(const FitProblem& problem, const PhotoPose& pose);

// Returns the robust standard deviation: 1.4826 times the median of the absolute values, at least kLeastScale_px.
double robust_scale_px(std::span<const double> residuals);

// Returns Tukey's loss of a residual, 0 to 1, where 1 is that of an outlier.
double tukey_loss(double residual_px, double scale_px);

// Refines a pose by Levenberg-Marquardt steps with Tukey's weights. The scale is estimated anew in each step, unless
// fixed_scale_px is positive. The start must be right to about the width of the skyline's features.
SkylineFit fit_skyline(const FitProblem& problem, const PhotoPose& start, double fixed_scale_px = 0);

}  // namespace panorama
