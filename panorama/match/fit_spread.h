// Computes how sure a fit is, from blocks of columns. Private to panorama.
#pragma once

#include <span>

#include "panorama/match/skyline_fit.h"

namespace panorama {

// Returns the standard deviations of a fit by the jackknife: blocks of neighbouring points are left out in turn. It
// holds for residuals that depend on each other over less than a block. The larger one of 8 and of 16 blocks counts.
PhotoPose spread_of(const FitProblem& problem, const SkylineFit& fit);

// Holds the mean of one fit's loss less another's, and the standard deviation of that mean over 16 blocks of points.
struct Lead {
  double mean = 0;
  double sigma = 0;
};
Lead lead_of(std::span<const double> best_px, std::span<const double> other_px, double scale_px);

// Returns how much of a skyline's shape a fit explains, as the logarithm of a likelihood: over octaves of waves (2 to 128
// half periods along the points) the number of waves times the logarithm of the ratio of amplitudes of heights and
// residuals. The lowest waves, as many as parameters fit by themselves, do not count, nor do octaves whose ratio is less
// than 2. Points with residuals beyond outlier_px are replaced by lines between their neighbours.
double shape_likeness(std::span<const double> heights, std::span<const double> residuals, double outlier_px,
                      int parameters);

}  // namespace panorama
