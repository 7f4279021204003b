#include "mars/sources/vertical_alignment.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "mars/sources/boundary_posts.h"

namespace mars {
namespace {

// East and north on the azimuthal equidistant plane, metres.
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
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Plane through the differences; `reach_m` scales the coordinates so that the matrix is well conditioned.
void fit_plane(const std::vector<BoundaryPost>& posts, const LocalFrame& frame, double reach_m,
               VerticalAlignment& level) {
  glm::dmat3 normal(0);
  glm::dvec3 right(0);
  for (const BoundaryPost& post : posts) {
    const glm::dvec2 p = plane(frame, level.radius_m, post.direction) / reach_m;
    const glm::dvec3 row(1, p.x, p.y);
    normal += glm::outerProduct(row, row);
    right += row * post.off_m;
  }
  normal /= static_cast<double>(posts.size());
  right /= static_cast<double>(posts.size());
  // Of a rim along one line only the offset is known.
  if (std::abs(glm::determinant(normal)) < 1e-6) {
    level.offset_m = right.x;
    level.tilt_east = level.tilt_north = 0;
    return;
  }
  const glm::dvec3 solution = glm::inverse(normal) * right;
  level.offset_m = solution.x;
  level.tilt_east = solution.y / reach_m;
  level.tilt_north = solution.z / reach_m;
}

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

constexpr std::size_t kFewest = 12;

}  // namespace

std::optional<VerticalAlignment> fit_alignment(const ElevationSource& inset, const ElevationSource& base,
                                               double radius_m, double within_posts, std::size_t max_posts) {
  std::vector<BoundaryPost> posts = boundary_posts(inset, base, within_posts, max_posts);
  if (posts.size() < kFewest) return std::nullopt;
  glm::dvec3 sum(0);
  for (const BoundaryPost& post : posts) sum += post.direction;
  const glm::dvec3 middle = glm::normalize(sum);
  double widest = 0;
  for (const BoundaryPost& post : posts) widest = std::max(widest, angle_between_rad(middle, post.direction));
  if (!std::isfinite(middle.x) || widest > kPi / 6) return std::nullopt;

  VerticalAlignment level;
  level.centre = lon_lat(middle);
  level.radius_m = radius_m;
  const LocalFrame frame = local_frame(level.centre);
  const double reach_m = std::max(radius_m * widest, 1e-3);
  const auto before = [](const BoundaryPost& post) { return post.off_m; };
  const auto after = [&](const BoundaryPost& post) { return post.off_m - height_m(level, post.direction); };
  const std::size_t all = posts.size();
  level.offset_m = median(posts, before);
  for (int round = 0; round < 3; ++round) {
    // A perfect fit leaves rounding, which is nobody's outlier.
    const double limit = std::max(
        kAlignmentOutlier * 1.4826 * median(posts, [&](const BoundaryPost& p) { return std::abs(after(p)); }),
        1e-6);
    std::erase_if(posts, [&](const BoundaryPost& post) { return std::abs(after(post)) > limit; });
    if (posts.size() < kFewest) return std::nullopt;
    fit_plane(posts, frame, reach_m, level);
  }
  level.posts = static_cast<std::int64_t>(posts.size());
  level.left_out = static_cast<std::int64_t>(all - posts.size());
  level.rms_before_m = rms(posts, before);
  level.rms_after_m = rms(posts, after);
  return level;
}

double height_m(const VerticalAlignment& level, const glm::dvec3& direction) {
  const glm::dvec2 p = plane(local_frame(level.centre), level.radius_m, direction);
  return level.offset_m + level.tilt_east * p.x + level.tilt_north * p.y;
}

Adjust aligning(const VerticalAlignment& level) {
  return [level, frame = local_frame(level.centre)](std::span<const glm::dvec3> directions,
                                                    std::span<double> heights_m) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const glm::dvec2 p = plane(frame, level.radius_m, directions[i]);
      heights_m[i] -= level.offset_m + level.tilt_east * p.x + level.tilt_north * p.y;
    }
  };
}

std::string to_string(const VerticalAlignment& level) {
  return "levelled by " + shortest(-level.offset_m) + " m at " + shortest(level.centre.lon_deg) + "," +
         shortest(level.centre.lat_deg) + " and a tilt of " + shortest(-1000 * level.tilt_east) +
         " m/km to the east, " + shortest(-1000 * level.tilt_north) + " m/km to the north";
}

}  // namespace mars
