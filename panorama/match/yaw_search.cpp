#include "panorama/match/yaw_search.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"

namespace panorama {

namespace {

constexpr std::size_t kMostPoints = 160;
constexpr double kLossScale_deg = 0.12;
constexpr int kFitSteps = 6;
constexpr double kFovStep = 1.03;
constexpr double kApartYaw_deg = 2;
constexpr double kApartFov = 1.1;

struct Candidate {
  PhotoPose pose;
  double loss = 1;
};

// A point as seen by a camera of yaw and roll 0.
struct LevelPoint {
  Direction direction;
  double along = 0;   // cosine of the azimuth: change of elevation with pitch
  double across = 0;  // sine of the azimuth: change of elevation with roll to the left
};

std::vector<SkyPoint> thinned(std::span<const SkyPoint> points) {
  const std::size_t step = (points.size() + kMostPoints - 1) / kMostPoints;
  std::vector<SkyPoint> out;
  for (std::size_t n = step / 2; n < points.size(); n += step) out.push_back(points[n]);
  return out;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<LevelPoint> level_points(const PhotoShape& shape, double fov_deg, double pitch_deg,
                                     std::span<const SkyPoint> points) {
  const DirectionFinder finder(shape, {0, pitch_deg, 0, fov_deg});
  std::vector<LevelPoint> out;
  for (const SkyPoint& p : points) {
    const Direction d = finder.at(p.x_px, p.y_px);
    const double a = d.azimuth_deg * mars::kRadiansPerDegree;
    out.push_back({d, std::cos(a), std::sin(a)});
  }
  return out;
}

// Fits pitch and roll at one yaw. `below` is room for the distances of the points from the skyline.
Candidate fit_leaning(const std::vector<LevelPoint>& points, const SkylineProfile& profile,
                      const PhotoPose& start, std::vector<double>& below) {
  below.clear();
  for (const LevelPoint& p : points)
    below.push_back(profile.elevation_deg(p.direction.azimuth_deg + start.yaw_deg) - p.direction.elevation_deg);
  double pitch = median(below);
  double roll = 0;
  double loss = 1;
  for (int step = 0; step < kFitSteps; ++step) {
    // Wide first, so that the first guess need not be near.
    const double scale = kLossScale_deg * (step < 2 ? 16 : step < 4 ? 4 : 1);
    double aa = 1e-9;
    double ac = 0;
    double cc = 1e-9;
    double ar = 0;
    double cr = 0;
    loss = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const LevelPoint& p = points[n];
      const double r = below[n] - pitch * p.along + roll * p.across;
      const double share = scale * scale / (r * r + scale * scale);
      loss += 1 - share;
      const double w = share * share;
      aa += w * p.along * p.along;
      ac -= w * p.along * p.across;
      cc += w * p.across * p.across;
      ar += w * p.along * below[n];
      cr -= w * p.across * below[n];
    }
    if (step + 1 == kFitSteps) break;
    const double determinant = aa * cc - ac * ac;
    if (!(determinant > 1e-12)) break;
    pitch = (ar * cc - cr * ac) / determinant;
    roll = (cr * aa - ar * ac) / determinant;
  }
  return {{start.yaw_deg, start.pitch_deg + pitch, roll, start.fov_deg},
          loss / static_cast<double>(points.size())};
}

void search_field(const FitProblem& problem, std::span<const SkyPoint> points, double fov_deg,
                  const YawSearchOptions& options, std::vector<Candidate>& out) {
  // The skyline lies a little above the horizontal, so its middle tells the pitch.
  std::vector<double> elevations;
  for (const LevelPoint& p : level_points(problem.shape, fov_deg, 0, points))
    elevations.push_back(p.direction.elevation_deg);
  const double pitch = problem.shape.map ? 0 : -median(std::move(elevations));
  const std::vector<LevelPoint> seen = level_points(problem.shape, fov_deg, pitch, points);
  const double pixels = pixels_per_radian(problem.shape, fov_deg) * mars::kRadiansPerDegree;
  const double step_deg = std::clamp(problem.shape.width_px / pixels / 100, 0.1, 0.5);
  const auto steps = static_cast<int>(std::ceil(360 / step_deg));
  std::vector<double> room;
  std::vector<Candidate> circle;
  for (int k = 0; k < steps; ++k)
    circle.push_back(fit_leaning(seen, *problem.profile, {360.0 * k / steps, pitch, 0, fov_deg}, room));
  for (int k = 0; k < steps; ++k) {
    const Candidate& here = circle[static_cast<std::size_t>(k)];
    const Candidate& before = circle[static_cast<std::size_t>((k + steps - 1) % steps)];
    const Candidate& after = circle[static_cast<std::size_t>((k + 1) % steps)];
    if (here.loss > before.loss || here.loss > after.loss) continue;
    if (std::abs(here.pose.pitch_deg) > options.most_pitch_deg) continue;
    if (std::abs(here.pose.roll_deg) > options.most_roll_deg) continue;
    out.push_back(here);
  }
}

bool is_apart(const PhotoPose& a, const PhotoPose& b) {
  const double yaw = std::abs(std::remainder(a.yaw_deg - b.yaw_deg, 360.0));
  const double fov = a.fov_deg > b.fov_deg ? a.fov_deg / b.fov_deg : b.fov_deg / a.fov_deg;
  return yaw > kApartYaw_deg || (b.fov_deg > 0 && fov > kApartFov);
}

}  // namespace

std::vector<PhotoPose> search_yaw(const FitProblem& problem, double fov_deg, const YawSearchOptions& options) {
  if (problem.points.empty()) return {};
  const std::vector<SkyPoint> points = thinned(problem.points);
  std::vector<Candidate> candidates;
  if (problem.fit_fov) {
    for (double fov = options.least_fov_deg; fov <= options.most_fov_deg; fov *= kFovStep)
      search_field(problem, points, fov, options, candidates);
  } else {
    search_field(problem, points, fov_deg, options, candidates);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.loss < b.loss; });
  std::vector<PhotoPose> out;
  for (const Candidate& c : candidates) {
    if (out.size() >= static_cast<std::size_t>(options.starts)) break;
    if (std::all_of(out.begin(), out.end(), [&](const PhotoPose& o) { return is_apart(o, c.pose); }))
      out.push_back(c.pose);
  }
  return out;
}

}  // namespace panorama
