#include "cull/terrain_horizon.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"

namespace cull {

namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();
constexpr double kBinsInHalf = 0.5 * TerrainHorizon::kBins;
// Two azimuths closer than this, in bins, may be in the wrong order; twice the rounding that kNearest_rad
// leaves.
constexpr double kSame = 1e-8 * TerrainHorizon::kBinsPerSide;

// Computes slopes of rays to points at one ground angle t > 0 with c = cot t > 0. Rise over run to radius r is
// (r cos t - camera) / (r sin t) = (r - camera) / r * sqrt(1 + c^2) - (sqrt(1 + c^2) - c); the last difference
// is computed without cancellation.
struct SlopesAt {
  double per_rise;
  double fall;
  explicit SlopesAt(double c) : per_rise(std::sqrt(1.0 + c * c)), fall(1.0 / (per_rise + c)) {}
  double operator()(double rise) const { return rise * per_rise - fall; }
};
double rise_of(double r, double camera) { return (r - camera) / r; }
double slope_at(double c, double r, double camera) { return SlopesAt(c)(rise_of(r, camera)); }

// Wraps the difference of two azimuths into [-kBins / 2, kBins / 2).
double wrapped(double d) {
  if (d >= kBinsInHalf) return d - TerrainHorizon::kBins;
  if (d < -kBinsInHalf) return d + TerrainHorizon::kBins;
  return d;
}

int bin_of(double azimuth) { return std::clamp(static_cast<int>(azimuth), 0, TerrainHorizon::kBins - 1); }

}  // namespace

TerrainHorizon::TerrainHorizon() {
  boundary_.resize(kBins + 1);
  for (std::size_t n = 0; n <= kBins; ++n) {
    const std::size_t side = n / kBinsPerSide % 4;
    const double t = 2.0 * static_cast<double>(n % kBinsPerSide) / kBinsPerSide - 1.0;
    const std::array<glm::dvec2, 4> along{glm::dvec2(1, t), glm::dvec2(-t, 1), glm::dvec2(-1, -t),
                                          glm::dvec2(t, -1)};
    boundary_[n] = glm::normalize(along[side]);
  }
  slope_.resize(kBins);
  low_.resize(kBins);
  high_.resize(kBins);
  begin({{0, 0, 1}, 1.0});
}

void TerrainHorizon::begin(const Camera& camera, double margin_rad) {
  camera_ = camera;
  margin_rad_ = std::max(margin_rad, kRounding_rad);
  a_ = mars::any_perpendicular(camera.direction);
  b_ = glm::cross(camera.direction, a_);
  std::fill(slope_.begin(), slope_.end(), kNone);
  for (auto* side : {&low_, &high_}) {
    for (BinParts& parts : *side) parts.count = 0;
  }
}

// Sums in body-fixed order, so that a point shared by two tiles or faces has the same bits from both.
double TerrainHorizon::azimuth(const glm::dvec3& p) const {
  const double x = p.x * a_.x + p.y * a_.y + p.z * a_.z;
  const double y = p.x * b_.x + p.y * b_.y + p.z * b_.z;
  double side = 0.0;
  double t = 0.0;
  if (std::abs(x) > std::abs(y)) {
    side = x > 0.0 ? 0.0 : 2.0;
    t = y / x;
  } else {
    side = y > 0.0 ? 1.0 : 3.0;
    t = y != 0.0 ? -x / y : 0.0;
  }
  const double at = kBinsPerSide * (side + 0.5 * (1.0 + t));
  return at < kBins ? at : at - kBins;
}

void TerrainHorizon::raise(int bin, double slope) {
  double& at = slope_[static_cast<std::size_t>(bin)];
  at = std::max(at, slope);
}

void TerrainHorizon::add_part(int bin, bool from_low_end, const BinPart& part) {
  const auto n = static_cast<std::size_t>(bin);
  if (part.slope <= slope_[n]) return;
  const BinParts& others = from_low_end ? high_[n] : low_[n];
  for (std::size_t k = 0; k < others.count; ++k) {
    const BinPart& other = others.entry[k];
    const double overlap = from_low_end ? part.end - other.end : other.end - part.end;
    if (overlap == 0.0 || overlap > kSame) raise(bin, std::min(part.slope, other.slope));
  }
  if (part.slope <= slope_[n]) return;
  BinParts& own = from_low_end ? low_[n] : high_[n];
  const auto covers = [&](const BinPart& x, const BinPart& y) {
    return x.slope >= y.slope && (from_low_end ? x.end >= y.end : x.end <= y.end);
  };
  std::size_t kept = 0;
  for (std::size_t k = 0; k < own.count; ++k) {
    const BinPart& old = own.entry[k];
    if (covers(old, part)) return;
    if (!covers(part, old) && old.slope > slope_[n]) own.entry[kept++] = old;
  }
  if (kept == kParts) {
    auto* lowest = std::min_element(own.entry.begin(), own.entry.end(),
                                    [](const BinPart& x, const BinPart& y) { return x.slope < y.slope; });
    if (lowest->slope < part.slope) *lowest = part;
  } else {
    own.entry[kept++] = part;
  }
  own.count = static_cast<std::uint8_t>(kept);
}

void TerrainHorizon::add(const OccluderSegment& occluder) {
  const std::size_t pieces = occluder.radius_m.size();
  if (pieces == 0 || pieces > OccluderSegment::kMostPieces) return;
  const mars::FaceAxes& face = mars::face_axes(occluder.face);
  // The normal of the line's plane; the camera's direction is at `beside` from the plane.
  const glm::dvec3 normal = (occluder.column ? face.right : face.up) - occluder.line * face.out;
  const double beside = glm::dot(normal, camera_.direction);
  if (std::abs(beside) < kNearest_rad * (1.0 + std::abs(occluder.line))) return;
  // The cotangent of the ground angle along the line is the scalar product of this with the azimuth vector.
  const glm::dvec2 cot(-glm::dot(normal, a_) / beside, -glm::dot(normal, b_) / beside);

  // Azimuths and rises in ascending order of azimuth from `first` on.
  std::array<double, OccluderSegment::kMostPieces + 1> at;
  std::array<double, OccluderSegment::kMostPieces> rise;
  for (std::size_t n = 0; n <= pieces; ++n) {
    at[n] = azimuth(occluder.column ? mars::cube_point(occluder.face, occluder.line, occluder.ends[n])
                                    : mars::cube_point(occluder.face, occluder.ends[n], occluder.line));
  }
  for (std::size_t n = 0; n < pieces; ++n) {
    if (!(occluder.radius_m[n] > 0.0)) return;
    rise[n] = rise_of(occluder.radius_m[n], camera_.radius_m);
  }
  if (wrapped(at[pieces] - at[0]) < 0.0) {
    std::reverse(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(pieces) + 1);
    std::reverse(rise.begin(), rise.begin() + static_cast<std::ptrdiff_t>(pieces));
  }
  const double first = at[0];
  const double end = at[pieces];
  for (std::size_t n = 1; n <= pieces; ++n) {
    if (at[n] < first) at[n] += kBins;
    if (!(at[n] >= at[n - 1])) return;  // points almost straight away from the camera
  }
  const double last = at[pieces];
  if (last - first >= kBinsInHalf) return;
  const int whole_from = static_cast<int>(std::ceil(first + kSame));
  const int whole_to = static_cast<int>(std::floor(last - kSame));
  if (whole_to < whole_from) return;

  const double cot_foot = std::sqrt(cot.x * cot.x + cot.y * cot.y);
  const int foot_bin = bin_of(azimuth(a_ * cot.x + b_ * cot.y));
  const auto cot_at = [&](int boundary) {
    const glm::dvec2& d = boundary_[static_cast<std::size_t>(boundary % kBins)];
    return cot.x * d.x + cot.y * d.y;
  };
  std::size_t piece = 0;
  double c0 = cot_at(whole_from - 1);
  SlopesAt slopes0(c0);
  for (int bin = whole_from - 1; bin <= whole_to; ++bin) {
    const double c1 = cot_at(bin + 1);
    const SlopesAt slopes1(c1);
    while (piece + 1 < pieces && at[piece + 1] < bin) ++piece;
    double lowest = rise[piece];
    for (std::size_t n = piece + 1; n < pieces && at[n] <= bin + 1; ++n) lowest = std::min(lowest, rise[n]);
    // Along an arc the slope has one maximum, and its minima are at the ends: those of the bin, and the point
    // where the arc is nearest to the camera.
    if (c0 > 0.0 && c1 > 0.0) {
      const int index = bin % kBins;
      double slope = std::min(slopes0(lowest), slopes1(lowest));
      if (index == foot_bin) slope = std::min(slope, SlopesAt(cot_foot)(lowest));
      if (bin < whole_from) {
        add_part(index, false, {first, slope});
      } else if (bin == whole_to) {
        add_part(index, true, {end, slope});
      } else {
        raise(index, slope);
      }
    }
    c0 = c1;
    slopes0 = slopes1;
  }
}

TerrainHorizon::Span TerrainHorizon::span(const mars::ChartRect& rect) const {
  const double first = azimuth(mars::cube_point(rect.face, rect.u0, rect.v0));
  double low = 0.0;
  double high = 0.0;
  for (const glm::dvec3& p :
       {mars::cube_point(rect.face, rect.u1, rect.v0), mars::cube_point(rect.face, rect.u0, rect.v1),
        mars::cube_point(rect.face, rect.u1, rect.v1)}) {
    const double d = wrapped(azimuth(p) - first);
    low = std::min(low, d);
    high = std::max(high, d);
  }
  // A convex region that excludes the vertical spans less than half the circle.
  if (high - low >= kBinsInHalf) return {0, 0, false};
  low += first;
  high += first;
  return low < 0.0 ? Span{low + kBins, high + kBins, true} : Span{low, high, true};
}

double TerrainHorizon::bins_spanned(const mars::ChartRect& rect) const {
  if (nearest_chord2(rect, camera_.direction) < kNearest_rad * kNearest_rad) return kBins;
  const Span s = span(rect);
  return s.valid ? s.high - s.low : kBins;
}

bool TerrainHorizon::hidden(const BoundingRegion& region) const {
  const double near2 = nearest_chord2(region.rect, camera_.direction);
  const double far2 = farthest_chord2(region.rect, camera_.direction);
  if (near2 < kNearest_rad * kNearest_rad || far2 > 1.99 || !(region.max_radius_m > 0.0)) return false;
  const auto cot = [](double chord2) {
    return (1.0 - 0.5 * chord2) / std::sqrt(chord2 * (1.0 - 0.25 * chord2));
  };
  const double c_near = cot(near2);
  const double c_far = cot(far2);
  const double top = region.max_radius_m;
  double highest = std::max(slope_at(c_near, top, camera_.radius_m), slope_at(c_far, top, camera_.radius_m));
  // Seen from above, a sphere's slope is greatest where rays are tangent to it: cot = top / sqrt(camera^2 -
  // top^2).
  if (camera_.radius_m > top) {
    const double c = top / std::sqrt((camera_.radius_m - top) * (camera_.radius_m + top));
    if (c < c_near && c > c_far) highest = std::max(highest, slope_at(c, top, camera_.radius_m));
  }
  // An angle at slope s changes the azimuth by the angle times sqrt(1 + s^2), and the slope by its tangent.
  const double lowest = region.min_radius_m > 0.0
                            ? std::min(slope_at(c_near, region.min_radius_m, camera_.radius_m),
                                       slope_at(c_far, region.min_radius_m, camera_.radius_m))
                            : kNone;
  const double steep2 = 1.0 + std::max(highest * highest, lowest * lowest);
  const double aside = margin_rad_ * std::sqrt(steep2);
  const double rest = 1.0 - highest * margin_rad_;
  if (!(aside < 0.1) || !(rest > 0.1)) return false;
  const double limit = highest + 1.01 * margin_rad_ * (1.0 + highest * highest) / rest;
  const Span s = span(region.rect);
  if (!s.valid) return false;
  // A radian of azimuth is at most kBinsPerSide bins.
  const double more = 1.1 * aside * kBinsPerSide + kSame;
  const int from = static_cast<int>(std::floor(s.low - more)) + kBins;
  const int to = static_cast<int>(std::floor(s.high + more)) + kBins;
  if (to - from >= kBins) return false;
  for (int bin = from; bin <= to; ++bin) {
    if (!(slope_[static_cast<std::size_t>(bin % kBins)] > limit)) return false;
  }
  return true;
}

double TerrainHorizon::blocked_slope(const glm::dvec3& direction) const {
  return slope_[static_cast<std::size_t>(bin_of(azimuth(direction)))];
}

}  // namespace cull
