#include "panorama/match/place_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "panorama/match/fit_spread.h"

namespace panorama {

namespace {

constexpr double kCoarse_deg = 0.5;
constexpr double kFine_deg = 0.05;
constexpr int kGridSide = 4;  // steps from the middle to the edge
constexpr int kHalvings = 6;
constexpr std::size_t kFinalPlaces = 6;
constexpr double kGridLoss_px = 3;
// Smaller leads say nothing: an error of edges by a fifth of a pixel over a part of the image has this one.
constexpr double kPlaceLead = 0.02;
constexpr double kPlaceLeadSigmas = 2;
constexpr double kExpectedPlaces = 49 + kFinalPlaces + kHalvings * 8;

// A place of the grid.
struct GridPlace {
  glm::dvec2 offset_m;
  PhotoPose pose;
  double loss = 0;
};

// A place and the fit there, on a fine skyline.
struct Tried {
  glm::dvec2 offset_m;
  SkylineFit fit;
  std::vector<double> residuals;
};

// Enough points for a first comparison.
SkyLine thinned_line(const SkyLine& line) {
  constexpr std::size_t kFewPoints = 300;
  const std::size_t step = std::max<std::size_t>(1, line.points.size() / kFewPoints);
  SkyLine out = line;
  out.points.clear();
  for (std::size_t n = 0; n < line.points.size(); n += step) out.points.push_back(line.points[n]);
  out.columns = (line.columns + static_cast<int>(step) - 1) / static_cast<int>(step);
  return out;
}

class PlaceSearch {
 public:
  PlaceSearch(const SkyLine& line, const PhotoShape& shape, double radius_m, const ProfileAt& profile_at,
              const MatchOptions& options, const std::function<void(double)>& tell)
      : line_(line),
        shape_(shape),
        radius_m_(radius_m),
        profile_at_(profile_at),
        options_(options),
        tell_(tell) {}

  PlaceMatch run() {
    PlaceMatch out;
    const std::vector<GridPlace> grid = best_of_grid(out.match);
    out.places = places_;
    if (grid.empty()) return out;
    Tried best = tried_at(grid.front().offset_m, grid.front().pose);
    for (std::size_t n = 1; n < grid.size(); ++n) keep_better(best, tried_at(grid[n].offset_m, grid[n].pose));
    double step = radius_m_ / kGridSide;
    for (int k = 0; k < kHalvings; ++k) {
      step *= 0.5;
      best = best_near(std::move(best), step);
    }
    out.offset_m = best.offset_m;
    out.match = match_skyline(line_, shape_, profile_at_(best.offset_m, kFine_deg), options_);
    out.places = ++places_;
    out.spread_m = step;
    spread(best, out);
    return out;
  }

 private:
  bool is_inside(const glm::dvec2& offset) const { return glm::length(offset) <= radius_m_ * (1 + 1e-9); }

  void count() {
    ++places_;
    if (tell_) tell_(std::min(1.0, places_ / kExpectedPlaces));
  }

  // The best ones, best first. None where the photograph has too little skyline; then `failure` says so.
  std::vector<GridPlace> best_of_grid(SkylineMatch& failure) {
    std::vector<GridPlace> out;
    const SkyLine few = thinned_line(line_);
    for (int j = -kGridSide; j <= kGridSide; ++j) {
      for (int i = -kGridSide; i <= kGridSide; ++i) {
        const glm::dvec2 offset = radius_m_ / kGridSide * glm::dvec2(i, j);
        if (!is_inside(offset)) continue;
        SkylineMatch match = match_skyline(few, shape_, profile_at_(offset, kCoarse_deg), options_);
        count();
        if (match.residuals_px.empty()) {
          failure = std::move(match);
          continue;
        }
        double loss = 0;
        for (const double r : match.residuals_px) loss += r * r / (r * r + kGridLoss_px * kGridLoss_px);
        out.push_back({offset, match.pose, loss});
      }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const GridPlace& a, const GridPlace& b) { return a.loss < b.loss; });
    if (out.size() > kFinalPlaces) out.resize(kFinalPlaces);
    return out;
  }

  Tried tried_at(const glm::dvec2& offset, const PhotoPose& near) {
    const SkylineProfile profile = profile_at_(offset, kFine_deg);
    const FitProblem problem{line_.points, shape_, &profile, !shape_.map && options_.fov_deg == 0};
    Tried out{offset, fit_skyline(problem, near), {}};
    out.residuals = residuals_px(problem, out.fit.pose);
    all_.push_back(out);
    count();
    return out;
  }

  static void keep_better(Tried& best, Tried next) {
    const double scale = std::min(next.fit.scale_px, best.fit.scale_px);
    if (lead_of(best.residuals, next.residuals, scale).mean < 0) best = std::move(next);
  }

  Tried best_near(Tried best, double step) {
    const glm::dvec2 middle = best.offset_m;
    const PhotoPose near = best.fit.pose;
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const glm::dvec2 offset = middle + step * glm::dvec2(i, j);
        if ((i == 0 && j == 0) || !is_inside(offset)) continue;
        keep_better(best, tried_at(offset, near));
      }
    }
    return best;
  }

  // Places that are as good as the best one say how sure place and attitude are.
  void spread(const Tried& best, PlaceMatch& out) const {
    double yaw = 0;
    double attitude = 0;
    for (const Tried& other : all_) {
      const Lead lead = lead_of(best.residuals, other.residuals, best.fit.scale_px);
      if (lead.mean > std::max(kPlaceLeadSigmas * lead.sigma, kPlaceLead)) continue;
      out.spread_m = std::max(out.spread_m, glm::length(other.offset_m - best.offset_m));
      yaw = std::max(yaw, std::abs(std::remainder(other.fit.pose.yaw_deg - best.fit.pose.yaw_deg, 360.0)));
      attitude = std::max({attitude, std::abs(other.fit.pose.pitch_deg - best.fit.pose.pitch_deg),
                           std::abs(other.fit.pose.roll_deg - best.fit.pose.roll_deg)});
    }
    out.match.sigma.yaw_deg = std::hypot(out.match.sigma.yaw_deg, yaw / options_.sigmas);
    out.match.sigma.pitch_deg = std::hypot(out.match.sigma.pitch_deg, attitude / options_.sigmas);
    out.match.sigma.roll_deg = std::hypot(out.match.sigma.roll_deg, attitude / options_.sigmas);
    if (!out.match.found()) return;
    const bool is_sure = options_.sigmas * out.match.sigma.yaw_deg <= options_.yaw_tolerance_deg &&
                         options_.sigmas * out.match.sigma.pitch_deg <= options_.attitude_tolerance_deg &&
                         options_.sigmas * out.match.sigma.roll_deg <= options_.attitude_tolerance_deg;
    if (is_sure) return;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the place is uncertain: places %.0f metres apart are as good, and their attitudes differ by %.3f "
        "degrees of yaw and %.3f of pitch or roll",
        out.spread_m, yaw, attitude);
    out.match.failure = MatchFailure::kUncertain;
    out.match.reason = text;
  }

  const SkyLine& line_;
  const PhotoShape& shape_;
  double radius_m_;
  const ProfileAt& profile_at_;
  const MatchOptions& options_;
  const std::function<void(double)>& tell_;
  int places_ = 0;
  std::vector<Tried> all_;
};

}  // namespace

PlaceMatch search_place(const SkyLine& line, const PhotoShape& shape, double radius_m,
                        const ProfileAt& profile_at, const MatchOptions& options,
                        const std::function<void(double)>& tell) {
  if (!(radius_m >= kLeastRadius_m) || !(radius_m <= kMostRadius_m))
    throw std::invalid_argument("the radius of the search must be within 1..100000 metres");
  return PlaceSearch(line, shape, radius_m, profile_at, options, tell).run();
}

}  // namespace panorama
