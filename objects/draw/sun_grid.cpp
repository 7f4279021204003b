#include "objects/draw/sun_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "objects/draw/volume_rays.h"

namespace objects {

namespace {

// A disc that covers more cells is looked at for each place.
constexpr std::int64_t kMostCellsOfDisc = 256;
constexpr double kCellDiameters = 2;  // of the median disc
// Cells of a ball beyond which it is not worth looking into them.
constexpr std::int64_t kMostCellsOfBall = 64;

}  // namespace

SunGrid::SunGrid(const ObjectRays& rays, const glm::dvec3& sun) : rays_(&rays), sun_(sun) {
  across_[0] = mars::any_perpendicular(sun);
  across_[1] = glm::cross(sun, across_[0]);
  const Scene& scene = rays.scene();
  origin_m_ = scene.ball().centre_m;
  scene.visit([&](const SceneBall& ball) { return rays.is_drawn(ball); },
              [&](std::uint32_t n) {
                const SceneBall ball = scene.ball(n);
                discs_.push_back(disc_of(ball.centre_m, ball.radius_m, n));
                if (scene.models()[scene.instance(n).model]->volume() == nullptr) return;
                discs_.back().volume = static_cast<std::int32_t>(volumes_.size());
                volumes_.push_back(rays.placed(n));
              });
  if (discs_.empty()) return;
  std::vector<double> radii_m;
  for (const Disc& disc : discs_) radii_m.push_back(disc.radius_m);
  const auto middle = radii_m.begin() + static_cast<std::ptrdiff_t>(radii_m.size() / 2);
  std::nth_element(radii_m.begin(), middle, radii_m.end());
  cell_m_ = 2 * kCellDiameters * *middle;

  std::vector<std::pair<Key, std::uint32_t>> pairs;
  for (std::uint32_t n = 0; n < discs_.size(); ++n) {
    const Disc& d = discs_[n];
    const std::int64_t i0 = cell(d.u_m - d.radius_m);
    const std::int64_t i1 = cell(d.u_m + d.radius_m);
    const std::int64_t j0 = cell(d.v_m - d.radius_m);
    const std::int64_t j1 = cell(d.v_m + d.radius_m);
    if ((i1 - i0 + 1) * (j1 - j0 + 1) > kMostCellsOfDisc) {
      large_.push_back(n);
      continue;
    }
    for (std::int64_t j = j0; j <= j1; ++j) {
      for (std::int64_t i = i0; i <= i1; ++i) pairs.emplace_back(key(i, j), n);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  entries_.reserve(pairs.size());
  for (std::size_t n = 0; n < pairs.size();) {
    Range range{static_cast<std::uint32_t>(n), 0};
    const Key here = pairs[n].first;
    for (; n < pairs.size() && pairs[n].first == here; ++n) entries_.push_back(pairs[n].second);
    range.end = static_cast<std::uint32_t>(n);
    cells_.emplace(here, range);
  }
}

SunGrid::Disc SunGrid::disc_of(const glm::dvec3& centre_m, double radius_m, std::uint32_t instance) const {
  const glm::dvec3 to = centre_m - origin_m_;
  return {glm::dot(to, across_[0]), glm::dot(to, across_[1]), glm::dot(to, sun_), radius_m, instance};
}

std::int64_t SunGrid::cell(double place_m) const {
  return static_cast<std::int64_t>(std::floor(place_m / cell_m_));
}

SunGrid::Key SunGrid::key(std::int64_t i, std::int64_t j) {
  return static_cast<Key>(i) * 0x9e3779b97f4a7c15ULL ^ (static_cast<Key>(j) << 1U);
}

bool SunGrid::hides(const Disc& disc, const Disc& place) const {
  const double reach_m = disc.radius_m + place.radius_m;
  const double du = disc.u_m - place.u_m;
  const double dv = disc.v_m - place.v_m;
  return du * du + dv * dv <= reach_m * reach_m && disc.along_m + reach_m >= place.along_m;
}

bool SunGrid::may_shade(const glm::dvec3& centre_m, double radius_m) const {
  if (discs_.empty()) return false;
  const Disc place = disc_of(centre_m, radius_m, 0);
  const std::int64_t i0 = cell(place.u_m - radius_m);
  const std::int64_t i1 = cell(place.u_m + radius_m);
  const std::int64_t j0 = cell(place.v_m - radius_m);
  const std::int64_t j1 = cell(place.v_m + radius_m);
  const auto side = [](std::int64_t a, std::int64_t b) { return std::min(b - a + 1, kMostCellsOfBall + 1); };
  if (side(i0, i1) * side(j0, j1) > kMostCellsOfBall) return true;
  for (const std::uint32_t n : large_) {
    if (hides(discs_[n], place)) return true;
  }
  for (std::int64_t j = j0; j <= j1; ++j) {
    for (std::int64_t i = i0; i <= i1; ++i) {
      const auto at = cells_.find(key(i, j));
      if (at == cells_.end()) continue;
      for (std::uint32_t e = at->second.begin; e < at->second.end; ++e) {
        if (hides(discs_[entries_[e]], place)) return true;
      }
    }
  }
  return false;
}

void SunGrid::dim(const Disc& disc, const Disc& place, const glm::dvec3& place_m, double& light) const {
  if (light <= 0 || !hides(disc, place)) return;
  if (disc.volume >= 0) {
    light *= volume_through(volumes_[static_cast<std::size_t>(disc.volume)], {place_m, sun_});
    return;
  }
  constexpr std::array<std::uint32_t, 1> kOne{0};
  const PlacedObject object = rays_->placed(disc.instance);
  light *= light_through({&object, 1}, kOne, {place_m, sun_});
}

double SunGrid::light_at(const glm::dvec3& place_m) const {
  double light = 1;
  if (discs_.empty()) return light;
  const Disc place = disc_of(place_m, 0, 0);
  for (const std::uint32_t n : large_) dim(discs_[n], place, place_m, light);
  const auto at = cells_.find(key(cell(place.u_m), cell(place.v_m)));
  if (at == cells_.end()) return light;
  for (std::uint32_t e = at->second.begin; e < at->second.end; ++e)
    dim(discs_[entries_[e]], place, place_m, light);
  return light;
}

}  // namespace objects
