#include "panorama/match/skyline_match.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "panorama/match/fit_spread.h"

namespace panorama {

namespace {

constexpr std::size_t kLeastMatchPoints = 40;
constexpr double kWithinSigmas = 3;
constexpr double kLeastWithin = 0.5;

template <class... Numbers>
std::string sentence(const char* format, Numbers... numbers) {
  char text[300];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

void require(double value, double low, double high, const char* name) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(sentence("%s must be within %g..%g", name, low, high));
}

void check_options(const MatchOptions& o, const PhotoShape& shape) {
  if (shape.width_px < 1 || shape.height_px < 1) throw std::invalid_argument("the photograph has no pixels");
  if (o.fov_deg != 0) require(o.fov_deg, 1, 150, "fov_deg");
  require(o.least_columns, 0.05, 1, "least_columns");
  require(o.least_relief_px, 0.5, 1000, "least_relief_px");
  require(o.sigmas, 1, 10, "sigmas");
  require(o.yaw_tolerance_deg, 1e-4, 10, "yaw_tolerance_deg");
  require(o.attitude_tolerance_deg, 1e-4, 10, "attitude_tolerance_deg");
  require(o.search.least_fov_deg, 1, 150, "least_fov_deg");
  require(o.search.most_fov_deg, o.search.least_fov_deg, 150, "most_fov_deg");
  require(o.search.most_pitch_deg, 0, 80, "most_pitch_deg");
  require(o.search.most_roll_deg, 0, 80, "most_roll_deg");
  require(o.search.starts, 2, 100, "starts");
}

SkylineMatch failed(SkylineMatch match, MatchFailure failure, std::string reason) {
  match.failure = failure;
  match.reason = std::move(reason);
  return match;
}

// The heights of the points above the straight line, or above the level circle, that fits them best.
std::vector<double> heights_px(std::span<const SkyPoint> points, const PhotoShape& shape) {
  const SkylineProfile flat(std::vector<double>(SkylineProfile::kLeastSamples, 0.0));
  const FitProblem problem{points, shape, &flat, false};
  constexpr double kAnyField_deg = 40;
  // A first guess that is right on average, for the robust fit. Without relief the yaw has no meaning and stays.
  constexpr double kEverything_px = 1e9;
  const SkylineFit mean = fit_skyline(problem, {0, 0, 0, kAnyField_deg}, kEverything_px);
  return residuals_px(problem, fit_skyline(problem, mean.pose).pose);
}

double share_within(const std::vector<double>& residuals, double limit) {
  const auto count =
      std::count_if(residuals.begin(), residuals.end(), [&](double r) { return std::abs(r) <= limit; });
  return static_cast<double>(count) / static_cast<double>(residuals.size());
}

double mean_loss(const std::vector<double>& residuals, double scale) {
  double sum = 0;
  for (const double r : residuals) sum += tukey_loss(r, scale);
  return sum / static_cast<double>(residuals.size());
}

bool is_other(const PhotoPose& a, const PhotoPose& b) {
  constexpr double kSame_deg = 0.5;
  return std::abs(std::remainder(a.yaw_deg - b.yaw_deg, 360.0)) > kSame_deg ||
         std::abs(a.pitch_deg - b.pitch_deg) > kSame_deg || std::abs(a.roll_deg - b.roll_deg) > kSame_deg;
}

bool is_within(const PhotoPose& pose, const MatchOptions& o, bool fit_fov) {
  return std::abs(pose.pitch_deg) <= o.search.most_pitch_deg &&
         std::abs(pose.roll_deg) <= o.search.most_roll_deg &&
         (!fit_fov || (pose.fov_deg >= o.search.least_fov_deg && pose.fov_deg <= o.search.most_fov_deg));
}

// Optima, the best first by its loss at the least of their scales.
std::vector<SkylineFit> sorted_fits(const FitProblem& problem, std::vector<SkylineFit> fits) {
  double scale = std::numeric_limits<double>::infinity();
  for (const SkylineFit& fit : fits) scale = std::min(scale, fit.scale_px);
  std::vector<std::pair<double, SkylineFit>> sorted;
  for (const SkylineFit& fit : fits)
    sorted.emplace_back(mean_loss(residuals_px(problem, fit.pose), scale), fit);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(sorted.begin(), sorted.end(), fits.begin(), [](const auto& s) { return s.second; });
  return fits;
}

std::vector<SkylineFit> fits_from(const FitProblem& problem, std::span<const PhotoPose> starts,
                                  const MatchOptions& o) {
  std::vector<SkylineFit> fits;
  for (const PhotoPose& start : starts) {
    const SkylineFit fit = fit_skyline(problem, start);
    if (is_within(fit.pose, o, problem.fit_fov)) fits.push_back(fit);
  }
  return sorted_fits(problem, std::move(fits));
}

// All starts are fitted to a part of the points, and the best of these to all.
std::vector<SkylineFit> optima(const FitProblem& problem, const MatchOptions& o) {
  constexpr std::size_t kFewPoints = 240;
  constexpr std::size_t kFinalists = 8;
  const std::size_t step = (problem.points.size() + kFewPoints - 1) / kFewPoints;
  std::vector<SkyPoint> few;
  for (std::size_t n = 0; n < problem.points.size(); n += step) few.push_back(problem.points[n]);
  FitProblem part = problem;
  part.points = few;
  std::vector<PhotoPose> finalists;
  for (const SkylineFit& fit : fits_from(part, search_yaw(problem, o.fov_deg, o.search), o)) {
    const bool is_new = std::all_of(finalists.begin(), finalists.end(), [&](const PhotoPose& f) {
      return is_other(f, fit.pose) || std::abs(f.fov_deg - fit.pose.fov_deg) > 1;
    });
    if (is_new && finalists.size() < kFinalists) finalists.push_back(fit.pose);
  }
  return fits_from(problem, finalists, o);
}

}  // namespace

const char* to_string(MatchFailure failure) {
  switch (failure) {
    case MatchFailure::kNone: return "found";
    case MatchFailure::kFewColumns: return "few-columns";
    case MatchFailure::kLittleRelief: return "little-relief";
    case MatchFailure::kNoLikeness: return "no-likeness";
    case MatchFailure::kAmbiguous: return "ambiguous";
    case MatchFailure::kUncertain: return "uncertain";
  }
  return "";
}

SkylineMatch match_skyline(const SkyLine& line, const PhotoShape& shape, const SkylineProfile& profile,
                           const MatchOptions& options) {
  check_options(options, shape);
  const FitProblem problem{line.points, shape, &profile, !shape.map && options.fov_deg == 0};
  SkylineMatch match;
  if (line.points.size() < kLeastMatchPoints ||
      static_cast<double>(line.points.size()) < options.least_columns * line.columns)
    return failed(std::move(match), MatchFailure::kFewColumns,
                  sentence("only %zu of %d columns have a skyline", line.points.size(), line.columns));
  const std::vector<double> heights = heights_px(line.points, shape);
  match.relief_px = robust_scale_px(heights);
  if (match.relief_px < options.least_relief_px)
    return failed(
        std::move(match), MatchFailure::kLittleRelief,
        sentence("the skyline is too straight: it deviates by %.2f pixels from a straight one, and %g are "
                 "needed",
                 match.relief_px, options.least_relief_px));
  const std::vector<SkylineFit> fits = optima(problem, options);
  if (fits.empty())
    return failed(std::move(match), MatchFailure::kNoLikeness,
                  "no attitude within the limits is like the skyline");

  const SkylineFit& best = fits.front();
  match.pose = best.pose;
  match.residuals_px = residuals_px(problem, best.pose);
  match.residual_px = best.scale_px;
  match.residual_deg = best.scale_px / pixels_per_radian(shape, best.pose.fov_deg) / mars::kRadiansPerDegree;
  match.within = share_within(match.residuals_px, kWithinSigmas * best.scale_px);
  constexpr double kYaws = 720;
  constexpr double kFields = 40;
  match.likeness =
      shape_likeness(heights, match.residuals_px, kWithinSigmas * best.scale_px, problem.fit_fov ? 4 : 3) -
      std::log(kYaws * (problem.fit_fov ? kFields : 1));
  match.sigma = spread_of(problem, best);
  Lead lead{1, 0};
  for (const SkylineFit& other : fits) {
    if (!is_other(best.pose, other.pose)) continue;
    const Lead next = lead_of(match.residuals_px, residuals_px(problem, other.pose), best.scale_px);
    if (next.mean - kLeastLeadSigmas * next.sigma >= lead.mean - kLeastLeadSigmas * lead.sigma) continue;
    lead = next;
    match.second_yaw_deg = other.pose.yaw_deg;
  }
  match.lead = lead.mean;

  if (match.likeness < kLeastLikeness || match.within < kLeastWithin)
    return failed(
        std::move(match), MatchFailure::kNoLikeness,
        sentence("no attitude is more like the skyline than chance: the best one leaves %.1f pixels of a "
                 "relief of %.1f",
                 match.residual_px, match.relief_px));
  if (lead.mean < kLeastLead || lead.mean < kLeastLeadSigmas * lead.sigma)
    return failed(
        std::move(match), MatchFailure::kAmbiguous,
        sentence("yaw %.1f is nearly as good as %.1f degrees", match.second_yaw_deg, match.pose.yaw_deg));
  if (options.sigmas * match.sigma.yaw_deg > options.yaw_tolerance_deg ||
      options.sigmas * std::max(match.sigma.pitch_deg, match.sigma.roll_deg) > options.attitude_tolerance_deg)
    return failed(
        std::move(match), MatchFailure::kUncertain,
        sentence("the answer is uncertain: standard deviations of yaw, pitch and roll are %.3f, %.3f and "
                 "%.3f degrees; %g times these must be within %g, %g and %g",
                 match.sigma.yaw_deg, match.sigma.pitch_deg, match.sigma.roll_deg, options.sigmas,
                 options.yaw_tolerance_deg, options.attitude_tolerance_deg, options.attitude_tolerance_deg));
  return match;
}

}  // namespace panorama
