#include "panorama/match/fit_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace panorama {

namespace {

constexpr std::size_t kLeadBlocks = 16;

std::array<double, 4> numbers_of(const PhotoPose& p, const PhotoPose& near) {
  return {near.yaw_deg + std::remainder(p.yaw_deg - near.yaw_deg, 360.0), p.pitch_deg, p.roll_deg, p.fov_deg};
}

std::array<double, 4> jackknife(const FitProblem& problem, const SkylineFit& fit, std::size_t blocks) {
  std::vector<std::array<double, 4>> poses;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = problem.points.size() * b / blocks;
    const std::size_t end = problem.points.size() * (b + 1) / blocks;
    std::vector<SkyPoint> rest(problem.points.begin(),
                               problem.points.begin() + static_cast<std::ptrdiff_t>(begin));
    rest.insert(rest.end(), problem.points.begin() + static_cast<std::ptrdiff_t>(end), problem.points.end());
    FitProblem part = problem;
    part.points = rest;
    poses.push_back(numbers_of(fit_skyline(part, fit.pose, fit.scale_px).pose, fit.pose));
  }
  std::array<double, 4> out{};
  const auto count = static_cast<double>(blocks);
  for (std::size_t k = 0; k < out.size(); ++k) {
    double mean = 0;
    for (const auto& p : poses) mean += p[k] / count;
    double squares = 0;
    for (const auto& p : poses) squares += (p[k] - mean) * (p[k] - mean);
    out[k] = std::sqrt((count - 1) / count * squares);
  }
  return out;
}

// Returns the values with those at outliers replaced by a line between their neighbours.
std::vector<double> bridged(std::span<const double> values, std::span<const double> residuals,
                            double outlier_px) {
  std::vector<double> out(values.begin(), values.end());
  const auto is_outlier = [&](std::size_t n) { return std::abs(residuals[n]) > outlier_px; };
  for (std::size_t begin = 0; begin < out.size(); ++begin) {
    if (!is_outlier(begin)) continue;
    std::size_t end = begin;
    while (end < out.size() && is_outlier(end)) ++end;
    const double right = end < out.size() ? out[end] : begin > 0 ? out[begin - 1] : 0;
    const double left = begin > 0 ? out[begin - 1] : right;
    for (std::size_t n = begin; n < end; ++n) {
      const double t = static_cast<double>(n - begin + 1) / static_cast<double>(end - begin + 1);
      out[n] = left + t * (right - left);
    }
    begin = end;
  }
  return out;
}

}  // namespace

PhotoPose spread_of(const FitProblem& problem, const SkylineFit& fit) {
  const auto coarse = jackknife(problem, fit, 8);
  const auto fine = jackknife(problem, fit, 16);
  return {std::max(coarse[0], fine[0]), std::max(coarse[1], fine[1]), std::max(coarse[2], fine[2]),
          std::max(coarse[3], fine[3])};
}

Lead lead_of(std::span<const double> best_px, std::span<const double> other_px, double scale_px) {
  std::vector<double> blocks;
  for (std::size_t b = 0; b < kLeadBlocks; ++b) {
    const std::size_t begin = best_px.size() * b / kLeadBlocks;
    const std::size_t end = best_px.size() * (b + 1) / kLeadBlocks;
    if (begin == end) continue;
    double sum = 0;
    for (std::size_t n = begin; n < end; ++n)
      sum += tukey_loss(other_px[n], scale_px) - tukey_loss(best_px[n], scale_px);
    blocks.push_back(sum / static_cast<double>(end - begin));
  }
  if (blocks.size() < 2) return {};
  const auto count = static_cast<double>(blocks.size());
  const double mean = std::accumulate(blocks.begin(), blocks.end(), 0.0) / count;
  double squares = 0;
  for (const double b : blocks) squares += (b - mean) * (b - mean);
  return {mean, std::sqrt(squares / (count - 1) / count)};
}

double shape_likeness(std::span<const double> heights, std::span<const double> residuals, double outlier_px,
                      int parameters) {
  constexpr double kLeastRatio = 2;
  // Standard deviation of a coefficient, from finding the edge to half a pixel with neighbours that depend on each other.
  constexpr double kEdgeNoise_px = 0.5;
  constexpr std::size_t kMostWaves = 128;
  const std::size_t count = heights.size();
  const std::vector<double> smooth_heights = bridged(heights, residuals, outlier_px);
  const std::vector<double> smooth_residuals = bridged(residuals, residuals, outlier_px);
  double likeness = 0;
  for (std::size_t first = 2; 2 * first <= std::min(count / 2, kMostWaves); first *= 2) {
    double of_heights = 0;
    double of_residuals = 0;
    int waves = 0;
    for (std::size_t k = std::max(first, static_cast<std::size_t>(parameters - 1)); k < 2 * first; ++k) {
      double h = 0;
      double r = 0;
      for (std::size_t n = 0; n < count; ++n) {
        const double wave = std::cos(std::numbers::pi * static_cast<double>(k) *
                                     (static_cast<double>(n) + 0.5) / static_cast<double>(count));
        h += wave * smooth_heights[n];
        r += wave * smooth_residuals[n];
      }
      of_heights += 2 * h * h / static_cast<double>(count);
      of_residuals += 2 * r * r / static_cast<double>(count) + kEdgeNoise_px * kEdgeNoise_px;
      ++waves;
    }
    if (waves == 0) continue;
    const double ratio = std::sqrt(of_heights / of_residuals);
    if (ratio >= kLeastRatio) likeness += waves * std::log(ratio);
  }
  return likeness;
}

}  // namespace panorama
