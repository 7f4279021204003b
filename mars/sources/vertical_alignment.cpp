#include "mars/sources/vertical_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "mars/sources/boundary_posts.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"

namespace mars {
namespace {

// Returns east and north on the azimuthal equidistant plane, metres.
glm::dvec2 plane(const LocalFrame& frame, double radius_m, const glm::dvec3& direction) {
  const glm::dvec2 p(glm::dot(direction, frame.east), glm::dot(direction, frame.north));
  const double sine = glm::length(p);
  if (sine < 1e-12) return radius_m * p;
  const double arc = std::atan2(sine, glm::dot(direction, frame.up));
  return p * (radius_m * arc / sine);
}

double rms(const std::vector<BoundaryPost>& posts, const auto& residual) {
  double squares = 0;
  for (const BoundaryPost& post : posts) squares += residual(post) * residual(post);
  return std::sqrt(squares / static_cast<double>(posts.size()));
}

double median(const std::vector<BoundaryPost>& posts, const auto& value) {
  std::vector<double> values;
  values.reserve(posts.size());
  for (const BoundaryPost& post : posts) values.push_back(value(post));
  return vpe::base::median_upper(values);
}

// Fits a plane to the differences. `reach_m` scales the coordinates so that the matrix is well conditioned.
void fit_plane(const std::vector<BoundaryPost>& posts, const LocalFrame& frame, double reach_m,
               VerticalAlignment& alignment) {
  glm::dmat3 normal(0);
  glm::dvec3 right(0);
  for (const BoundaryPost& post : posts) {
    const glm::dvec2 p = plane(frame, alignment.radius_m, post.direction) / reach_m;
    const glm::dvec3 row(1, p.x, p.y);
    normal += glm::outerProduct(row, row);
    right += row * post.off_m;
  }
  normal /= static_cast<double>(posts.size());
  right /= static_cast<double>(posts.size());
  // A boundary along one line determines the offset alone.
  if (std::abs(glm::determinant(normal)) < 1e-6) {
    alignment.offset_m = right.x;
    alignment.tilt_east = alignment.tilt_north = 0;
    return;
  }
  const glm::dvec3 solution = glm::inverse(normal) * right;
  alignment.offset_m = solution.x;
  alignment.tilt_east = solution.y / reach_m;
  alignment.tilt_north = solution.z / reach_m;
}

constexpr std::size_t kFewestPosts = 12;

}  // namespace

std::optional<VerticalAlignment> fit_alignment(const ElevationSource& inset, const ElevationSource& base,
                                               double radius_m, double within_posts, std::size_t max_posts) {
  std::vector<BoundaryPost> posts = boundary_posts(inset, base, within_posts, max_posts);
  if (posts.size() < kFewestPosts) return std::nullopt;
  glm::dvec3 sum(0);
  for (const BoundaryPost& post : posts) sum += post.direction;
  const glm::dvec3 middle = glm::normalize(sum);
  double widest = 0;
  for (const BoundaryPost& post : posts) widest = std::max(widest, angle_between_rad(middle, post.direction));
  if (!std::isfinite(middle.x) || widest > kPi / 6) return std::nullopt;

  VerticalAlignment alignment;
  alignment.centre = lon_lat(middle);
  alignment.radius_m = radius_m;
  const LocalFrame frame = local_frame(alignment.centre);
  const double reach_m = std::max(radius_m * widest, 1e-3);
  const auto before = [](const BoundaryPost& post) { return post.off_m; };
  const auto after = [&](const BoundaryPost& post) {
    return post.off_m - misalignment_m(alignment, post.direction);
  };
  const std::size_t all = posts.size();
  alignment.offset_m = median(posts, before);
  for (int round = 0; round < 3; ++round) {
    // A perfect fit leaves rounding errors, which are no outliers.
    const double limit = std::max(
        kAlignmentOutlier * 1.4826 * median(posts, [&](const BoundaryPost& p) { return std::abs(after(p)); }),
        1e-6);
    std::erase_if(posts, [&](const BoundaryPost& post) { return std::abs(after(post)) > limit; });
    if (posts.size() < kFewestPosts) return std::nullopt;
    fit_plane(posts, frame, reach_m, alignment);
  }
  alignment.posts = static_cast<std::int64_t>(posts.size());
  alignment.left_out = static_cast<std::int64_t>(all - posts.size());
  alignment.rms_before_m = rms(posts, before);
  alignment.rms_after_m = rms(posts, after);
  return alignment;
}

double misalignment_m(const VerticalAlignment& alignment, const glm::dvec3& direction) {
  const glm::dvec2 p = plane(local_frame(alignment.centre), alignment.radius_m, direction);
  return alignment.offset_m + alignment.tilt_east * p.x + alignment.tilt_north * p.y;
}

HeightAdjustment alignment_adjustment(const VerticalAlignment& alignment) {
  return [alignment, frame = local_frame(alignment.centre)](std::span<const glm::dvec3> directions,
                                                            std::span<double> heights_m) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const glm::dvec2 p = plane(frame, alignment.radius_m, directions[i]);
      heights_m[i] -= alignment.offset_m + alignment.tilt_east * p.x + alignment.tilt_north * p.y;
    }
  };
}

std::string to_string(const VerticalAlignment& alignment) {
  using vpe::base::format_shortest;
  return "levelled by " + format_shortest(-alignment.offset_m) + " m at " +
         format_shortest(alignment.centre.lon_deg) + "," + format_shortest(alignment.centre.lat_deg) +
         " and a tilt of " + format_shortest(-1000 * alignment.tilt_east) + " m/km to the east, " +
         format_shortest(-1000 * alignment.tilt_north) + " m/km to the north";
}

}  // namespace mars
