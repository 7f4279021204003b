#include "panorama/match/skyline_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mars/geodesy/sphere.h"

namespace panorama {

namespace {

constexpr std::size_t kMostParameters = 4;
constexpr std::size_t kLeastPoints = 8;
constexpr int kMostSteps = 40;
constexpr double kMadToSigma = 1.4826;
constexpr double kLeastFov_deg = 1;
constexpr double kMostFov_deg = 150;
// Steps of the derivatives: for yaw about that of a profile, so that its corners are averaged.
constexpr std::array<double, kMostParameters> kDifference_deg{0.04, 0.01, 0.01, 0.01};

using Step = std::array<double, kMostParameters>;

PhotoPose moved(const PhotoPose& pose, const Step& by) {
  return {pose.yaw_deg + by[0], pose.pitch_deg + by[1], pose.roll_deg + by[2],
          std::clamp(pose.fov_deg + by[3], kLeastFov_deg, kMostFov_deg)};
}

double tukey_weight(double residual, double scale) {
  const double t = residual / (kTukey * scale);
  return std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
}

double total_loss(const FitProblem& problem, std::span<const double> residuals, double scale) {
  double sum = 0;
  for (std::size_t n = 0; n < residuals.size(); ++n)
    sum += problem.points[n].weight * tukey_loss(residuals[n], scale);
  return sum;
}

// The normal equations of the weighted residuals.
struct Normal {
  std::array<std::array<double, kMostParameters>, kMostParameters> matrix{};
  Step right{};
};

Normal normal_of(const FitProblem& problem, const PhotoPose& pose, std::span<const double> residuals,
                 double scale, std::size_t parameters) {
  std::array<std::vector<double>, kMostParameters> slopes;
  for (std::size_t k = 0; k < parameters; ++k) {
    Step by{};
    by[k] = kDifference_deg[k];
    const std::vector<double> up = residuals_px(problem, moved(pose, by));
    by[k] = -kDifference_deg[k];
    slopes[k] = residuals_px(problem, moved(pose, by));
    for (std::size_t n = 0; n < up.size(); ++n)
      slopes[k][n] = (up[n] - slopes[k][n]) / (2 * kDifference_deg[k]);
  }
  Normal out;
  for (std::size_t n = 0; n < residuals.size(); ++n) {
    const double weight = problem.points[n].weight * tukey_weight(residuals[n], scale);
    if (weight <= 0) continue;
    for (std::size_t i = 0; i < parameters; ++i) {
      out.right[i] -= weight * slopes[i][n] * residuals[n];
      for (std::size_t j = 0; j < parameters; ++j) out.matrix[i][j] += weight * slopes[i][n] * slopes[j][n];
    }
  }
  return out;
}

// Solves the damped equations by elimination; false where they are singular.
bool solve(Normal normal, double damping, std::size_t parameters, Step& out) {
  auto& m = normal.matrix;
  // Directions without any effect stay where they are.
  constexpr double kLeastCurvature = 1e-9;
  for (std::size_t i = 0; i < parameters; ++i) m[i][i] = m[i][i] * (1 + damping) + kLeastCurvature;
  for (std::size_t i = 0; i < parameters; ++i) {
    if (!(m[i][i] > 1e-12)) return false;
    for (std::size_t j = i + 1; j < parameters; ++j) {
      const double factor = m[j][i] / m[i][i];
      for (std::size_t k = i; k < parameters; ++k) m[j][k] -= factor * m[i][k];
      normal.right[j] -= factor * normal.right[i];
    }
  }
  out = {};
  for (std::size_t i = parameters; i-- > 0;) {
    double sum = normal.right[i];
    for (std::size_t k = i + 1; k < parameters; ++k) sum -= m[i][k] * out[k];
    out[i] = sum / m[i][i];
  }
  return true;
}

}  // namespace

std::vector<double> residuals_px(const FitProblem& problem, const PhotoPose& pose) {
  const double pixels = pixels_per_radian(problem.shape, pose.fov_deg);
  const double half_pixel_deg = std::max(problem.profile->step_deg(), 1 / (pixels * mars::kRadiansPerDegree));
  const DirectionFinder direction(problem.shape, pose);
  std::vector<double> out;
  out.reserve(problem.points.size());
  for (const SkyPoint& point : problem.points) {
    const Direction seen = direction.at(point.x_px, point.y_px);
    const double above_deg = seen.elevation_deg - problem.profile->elevation_deg(seen.azimuth_deg);
    const double slope = problem.profile->slope(seen.azimuth_deg, half_pixel_deg);
    out.push_back(above_deg * mars::kRadiansPerDegree * pixels / std::sqrt(1 + slope * slope));
  }
  return out;
}

double robust_scale_px(std::span<const double> residuals) {
  if (residuals.empty()) return kLeastScale_px;
  std::vector<double> sizes(residuals.size());
  std::transform(residuals.begin(), residuals.end(), sizes.begin(), [](double r) { return std::abs(r); });
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(kLeastScale_px, kMadToSigma * *middle);
}

double tukey_loss(double residual_px, double scale_px) {
  const double t = residual_px / (kTukey * scale_px);
  if (!(std::abs(t) < 1)) return 1;
  const double rest = 1 - t * t;
  return 1 - rest * rest * rest;
}

SkylineFit fit_skyline(const FitProblem& problem, const PhotoPose& start, double fixed_scale_px) {
  if (problem.points.size() < kLeastPoints) return {start, std::numeric_limits<double>::infinity()};
  const std::size_t parameters = problem.fit_fov ? 4 : 3;
  PhotoPose pose = start;
  std::vector<double> residuals = residuals_px(problem, pose);
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps; ++step) {
    const double scale = fixed_scale_px > 0 ? fixed_scale_px : robust_scale_px(residuals);
    const double loss = total_loss(problem, residuals, scale);
    const Normal normal = normal_of(problem, pose, residuals, scale, parameters);
    bool better = false;
    double moved_by = 0;
    for (; damping < 1e6 && !better; damping = better ? damping : damping * 10) {
      Step by;
      if (!solve(normal, damping, parameters, by)) continue;
      const PhotoPose next = moved(pose, by);
      std::vector<double> next_residuals = residuals_px(problem, next);
      if (total_loss(problem, next_residuals, scale) >= loss) continue;
      better = true;
      moved_by = std::max({std::abs(by[0]), std::abs(by[1]), std::abs(by[2]), std::abs(by[3])});
      pose = next;
      residuals = std::move(next_residuals);
    }
    constexpr double kEnough_deg = 1e-5;
    if (!better || moved_by < kEnough_deg) break;
    damping = std::max(1e-7, damping * 0.1);
  }
  pose.yaw_deg -= 360 * std::floor(pose.yaw_deg / 360);
  return {pose, robust_scale_px(residuals)};
}

}  // namespace panorama
