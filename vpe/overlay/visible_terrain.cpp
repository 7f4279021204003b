#include "vpe/overlay/visible_terrain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

namespace vpe::overlay {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr float kSky = std::numeric_limits<float>::infinity();

// Computes atan2(y, x) in degrees of one place after the other: near the last place that had an arc tangent, from the
// series of the angle between both, whose first term that is left out is below 1e-15.
class AngleAlong {
 public:
  double deg(double y, double x) {
    constexpr double kNear = 0.01;
    const double tangent = (x_ * y - y_ * x) / (x_ * x + y_ * y);
    if (!(std::abs(tangent) < kNear && x_ * x + y_ * y > 0)) {
      x_ = x;
      y_ = y;
      angle_ = std::atan2(y, x);
      return angle_ / mars::kRadiansPerDegree;
    }
    const double t2 = tangent * tangent;
    double angle = angle_ + tangent * (1 - t2 * (1.0 / 3 - t2 * (1.0 / 5 - t2 / 7)));
    if (angle > mars::kPi) angle -= 2 * mars::kPi;
    if (angle <= -mars::kPi) angle += 2 * mars::kPi;
    return angle / mars::kRadiansPerDegree;
  }

 private:
  double x_ = 0, y_ = 0, angle_ = 0;
};

}  // namespace

VisibleTerrain::VisibleTerrain(const Scene& scene)
    : scene_(scene),
      part_(core::drawn_part(scene.view)),
      size_(core::drawn_size(scene.view)),
      focal_px_(core::focal_px(scene.view)),
      principal_px_(glm::dvec2(scene.view.width, scene.view.height) * 0.5 + scene.view.principal_offset_px),
      is_flat_(scene.view.projection == core::Projection::kPerspective) {
  if (is_flat_) {
    // Equals core::pixel_ray(), with the terms that all pixels share computed once.
    const mars::Axes& axes = scene.view.camera.axes;
    const glm::dvec2 first = glm::dvec2(part_.x + 0.5, part_.y + 0.5) -
                             glm::dvec2(scene.view.width, scene.view.height) * 0.5 -
                             scene.view.principal_offset_px;
    right_ = axes.right;
    down_ = -axes.up;
    corner_ = axes.forward * core::focal_px(scene.view) + right_ * first.x + down_ * first.y;
  }
  if (scene.range_m.size() == static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y)) {
    const auto nearest = std::min_element(scene.range_m.begin(), scene.range_m.end());
    nearest_m_ = nearest == scene.range_m.end() ? 1 : std::max(static_cast<double>(*nearest), 1e-3);
    return;
  }
  throw std::invalid_argument("the range image has " + std::to_string(scene.range_m.size()) +
                              " pixels, the image " + std::to_string(size_.x) + "x" + std::to_string(size_.y));
}

bool VisibleTerrain::is_ground(std::size_t pixel) const {
  const float range_m = scene_.range_m[pixel];
  return range_m > 0.0F && std::isfinite(range_m);
}

double VisibleTerrain::deviation_m(std::size_t pixel) const {
  return scene_.shift_px * static_cast<double>(scene_.range_m[pixel]) / focal_px_;
}

double VisibleTerrain::noise_m(std::size_t pixel) const {
  // A tenth of the bound in vpe/gl: the usual error, not the largest possible one.
  constexpr double kShare = 5e-8;
  constexpr double kRounding = 1.2e-7;
  const auto range_m = static_cast<double>(scene_.range_m[pixel]);
  return range_m * (kRounding + kShare * range_m / nearest_m_);
}

glm::dvec3 VisibleTerrain::point(int x, int y) const {
  const auto range_m = static_cast<double>(scene_.range_m[index(x, y)]);
  if (is_flat_) {
    const glm::dvec3 along = corner_ + right_ * static_cast<double>(x) + down_ * static_cast<double>(y);
    return scene_.view.camera.position_m + along * (range_m / glm::length(along));
  }
  return scene_.view.camera.position_m +
         core::pixel_ray(scene_.view, part_.x + x + 0.5, part_.y + y + 0.5) * range_m;
}

std::optional<glm::dvec2> VisibleTerrain::to_image(const glm::dvec3& point_m) const {
  if (is_flat_) {
    // Equals core::project(), with the terms that all points share computed once.
    const mars::Axes& axes = scene_.view.camera.axes;
    const glm::dvec3 to = point_m - scene_.view.camera.position_m;
    const double forward = glm::dot(to, axes.forward);
    if (!(forward > 0.0)) return std::nullopt;
    const glm::dvec2 aside(glm::dot(to, axes.right), -glm::dot(to, axes.up));
    return principal_px_ + aside * (focal_px_ / forward) - glm::dvec2(part_.x, part_.y);
  }
  const core::Projected p = core::project(scene_.view, point_m);
  if (p.behind) return std::nullopt;
  return p.xy - glm::dvec2(part_.x, part_.y);
}

// Returns true if terrain ends between a pixel and the next one, to the right (side = width) or below. The
// reciprocal of the range is nearly linear along a plane of any tilt, so a step much larger than its neighbours
// is an edge.
bool VisibleTerrain::breaks(std::size_t pixel, int x, int side, std::size_t step) const {
  constexpr double kTimesTheNeighbours = 4;
  constexpr double kUnnoticed = 0.003;
  constexpr double kAlone = 0.1;
  const auto near_at = [this](std::size_t p) { return 1.0 / static_cast<double>(scene_.range_m[p]); };
  const double a = near_at(pixel);
  const double b = near_at(pixel + step);
  const double here = std::abs(b - a);
  double beside = -1;
  if (x > 0 && is_ground(pixel - step)) beside = std::abs(a - near_at(pixel - step));
  if (x + 2 < side && is_ground(pixel + 2 * step)) {
    beside = std::max(beside, std::abs(b - near_at(pixel + 2 * step)));
  }
  const double most = std::max(a, b);
  if (beside < 0) return here > kAlone * most;
  return here > kTimesTheNeighbours * beside + kUnnoticed * most;
}

bool VisibleTerrain::is_whole(int x, int y) const {
  const std::size_t p = index(x, y);
  const std::size_t below = p + static_cast<std::size_t>(size_.x);
  if (!is_ground(p) || !is_ground(p + 1) || !is_ground(below) || !is_ground(below + 1)) return false;
  const auto down = static_cast<std::size_t>(size_.x);
  return !breaks(p, x, size_.x, 1) && !breaks(below, x, size_.x, 1) && !breaks(p, y, size_.y, down) &&
         !breaks(p + 1, y, size_.y, down);
}

template <class Value>
std::vector<double> VisibleTerrain::values(Value value) const {
  std::vector<double> out(scene_.range_m.size(), kNaN);
  for (int y = 0; y < size_.y; ++y) {
    for (int x = 0; x < size_.x; ++x) {
      const std::size_t p = index(x, y);
      if (is_ground(p)) out[p] = value(point(x, y));
    }
  }
  return out;
}

std::vector<double> VisibleTerrain::longitudes_deg() const {
  return values([along = AngleAlong()](const glm::dvec3& p) mutable { return along.deg(p.y, p.x); });
}

std::vector<double> VisibleTerrain::latitudes_deg() const {
  return values([along = AngleAlong()](const glm::dvec3& p) mutable {
    return along.deg(p.z, std::sqrt(p.x * p.x + p.y * p.y));
  });
}

std::vector<double> VisibleTerrain::elevations_m() const {
  const double radius_m = scene_.radius_m;
  const double factor = 1.0 / scene_.appearance.exaggeration;
  return values([=](const glm::dvec3& p) { return (glm::length(p) - radius_m) * factor; });
}

std::vector<float> ranges_of_same_ground(const VisibleTerrain& image, const FinerRanges& finer) {
  constexpr double kFarthestShift_px = 4;
  const Scene& scene = image.scene();
  if (finer.range_m.size() != scene.range_m.size())
    throw std::invalid_argument("finer ranges of another size than the image");
  // A pixel at least: a silhouette may fall on either side of a pixel's centre. Bounds are of the middle.
  const double shift_px = (scene.shift_px + finer.shift_px) * core::corner_stretch(scene.view);
  const int reach = static_cast<int>(std::ceil(std::clamp(shift_px, 1.0, kFarthestShift_px)));
  std::vector<float> out(finer.range_m.begin(), finer.range_m.end());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      float& range_m = out[image.index(x, y)];
      if (!std::isfinite(range_m)) continue;
      float nearest_m = kSky;
      float farthest_m = 0;
      for (int v = std::max(0, y - reach); v <= std::min(image.height() - 1, y + reach); ++v) {
        for (int u = std::max(0, x - reach); u <= std::min(image.width() - 1, x + reach); ++u) {
          const float beside_m = scene.range_m[image.index(u, v)];
          nearest_m = std::min(nearest_m, beside_m);
          farthest_m = std::max(farthest_m, beside_m);
        }
      }
      const auto here_m = static_cast<double>(range_m);
      const bool is_same = here_m >= static_cast<double>(nearest_m) * (1 - kHiddenShare) &&
                           here_m <= static_cast<double>(farthest_m) * (1 + kHiddenShare);
      if (!is_same) range_m = kSky;
    }
  }
  return out;
}

std::optional<CentralRange> central_range(const std::vector<double>& values, double period) {
  constexpr std::size_t kSamples = 20000;
  constexpr double kLeftOut = 0.05;
  std::vector<double> some;
  const std::size_t stride = std::max<std::size_t>(1, values.size() / kSamples);
  for (std::size_t n = 0; n < values.size(); n += stride) {
    if (!std::isnan(values[n])) some.push_back(values[n]);
  }
  if (some.empty()) return std::nullopt;
  double middle = 0;
  if (period > 0) {
    glm::dvec2 sum{0, 0};
    const double radians = 2 * mars::kPi / period;  // of one unit
    for (const double v : some) sum += glm::dvec2(std::cos(v * radians), std::sin(v * radians));
    middle = std::atan2(sum.y, sum.x) / radians;
    for (double& v : some) v = middle + std::remainder(v - middle, period);
  }
  const auto left_out = static_cast<std::size_t>(kLeftOut * static_cast<double>(some.size()));
  std::sort(some.begin(), some.end());
  return CentralRange{some[left_out], some[some.size() - 1 - left_out]};
}

}  // namespace vpe::overlay
