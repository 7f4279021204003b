#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "objects/draw/square_painter.h"

namespace objects {

namespace {

// Volumes whose posts are this far apart have a ray in every second pixel of each axis.
constexpr double kSparsePosts_px = 2;
// Between rays that differ by more, of 255 and of the opacity, each pixel has one.
constexpr double kMostSparseStep = 4;
constexpr double kHalfMargin = 0.03;       // of opacities about a half
constexpr double kMostSparseGround = 0.1;  // difference of the ground's range, of itself

// Pixels of a sparse part that have a ray: every second one, and the last.
bool has_ray(int at, int first, int end) { return (at - first) % 2 == 0 || at + 1 == end; }

}  // namespace

// Returns whether nothing but volumes shows in a part, and these change little from pixel to pixel.
bool SquarePainter::is_sparse(const SubSquare& part) const {
  const LevelRule& rule = image_.rays.rule();
  if (part.volumes.empty() || !part.near_to_far.empty() || !part.posters.empty() || !image_.only.empty())
    return false;
  if (!(rule.tolerance_px > 0)) return false;  // exact
  return std::all_of(part.volumes.begin(), part.volumes.end(), [&](std::uint32_t n) {
    const PlacedObject& o = near_to_far_[n];
    const double post_m = static_cast<double>(o.volume->lattice.spacing_m * o.scale);
    const double middle_m = std::max(o.near_m + o.around.radius_m, 1e-9);
    return post_m * rule.focal_px >= kSparsePosts_px * middle_m;
  });
}

// Returns the mean of the rays beside a pixel, if they are much alike and end alike.
std::optional<ObjectColour> SquarePainter::between(const SubSquare& part, int x, int y) const {
  double reach_m = 0;  // where all volumes end
  for (const std::uint32_t n : part.volumes)
    reach_m = std::max(reach_m, near_to_far_[n].near_m + 2 * near_to_far_[n].around.radius_m);
  const auto ground_m = static_cast<double>(ground_.at(x, y));
  const PixelSquare& s = part.square;
  const int dx = has_ray(x, s.x0, s.x1) ? 0 : 1;
  const int dy = has_ray(y, s.y0, s.y1) ? 0 : 1;
  ObjectColour mean;
  mean.range_m = 0;
  glm::dvec4 low(std::numeric_limits<double>::infinity());
  glm::dvec4 high(0);
  int finite = 0;
  for (const glm::ivec2& d :
       {glm::ivec2(-dx, -dy), glm::ivec2(dx, -dy), glm::ivec2(-dx, dy), glm::ivec2(dx, dy)}) {
    const auto beside_m = static_cast<double>(ground_.at(x + d.x, y + d.y));
    const bool ends_alike = (ground_m >= reach_m && beside_m >= reach_m) ||
                            std::abs(beside_m - ground_m) <= kMostSparseGround * ground_m;
    if (!ends_alike) return std::nullopt;
    const ObjectColour& c = at(x + d.x, y + d.y).object;
    mean.over += c.over / 4.0;
    low = glm::min(low, c.over);
    high = glm::max(high, c.over);
    finite += std::isfinite(c.range_m) ? 1 : 0;
    mean.range_m += c.range_m / 4;
  }
  if (finite != 0 && finite != 4) return std::nullopt;
  // Whether there is a range is decided by a ray of its own.
  if (low.w < 0.5 + kHalfMargin && high.w > 0.5 - kHalfMargin) return std::nullopt;
  const glm::dvec4 step = high - low;
  if (std::max({step.x, step.y, step.z, 255 * step.w}) > kMostSparseStep) return std::nullopt;
  return mean;
}

// A volume is smooth, so most of its rays would say what those beside them say.
void SquarePainter::see_sparsely(const SubSquare& part) {
  const PixelSquare& s = part.square;
  const auto is_cast = [&](int x, int y) { return has_ray(x, s.x0, s.x1) && has_ray(y, s.y0, s.y1); };
  for (int y = s.y0; y < s.y1; ++y) {
    for (int x = s.x0; x < s.x1; ++x) {
      if (is_cast(x, y)) see_pixel(part, x, y);
    }
  }
  for (int y = s.y0; y < s.y1; ++y) {
    for (int x = s.x0; x < s.x1; ++x) {
      if (is_cast(x, y)) continue;
      if (const std::optional<ObjectColour> mean = between(part, x, y)) {
        seen_at(x, y).object = *mean;
        see_light(part, x, y);
      } else {
        see_pixel(part, x, y);
      }
    }
  }
}

}  // namespace objects
