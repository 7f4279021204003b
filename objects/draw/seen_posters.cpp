#include "objects/draw/seen_posters.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "objects/draw/pixel_square.h"

namespace objects {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the axes of a billboard that faces a camera at -to_m from its place.
mars::Axes facing_axes(const glm::dvec3& up, const glm::dvec3& to_m) {
  mars::Axes axes;
  const glm::dvec3 level = to_m - glm::dot(to_m, up) * up;
  const double length = glm::length(level);
  axes.up = up;
  axes.forward = length > 0 ? level / length : mars::any_perpendicular(up);
  axes.right = glm::cross(axes.forward, up);
  return axes;
}

double distance_to_rectangle_m(const glm::dvec3& to_m, const mars::Axes& axes, double width_m, double tall_m) {
  const double x = std::max(0.0, std::abs(glm::dot(to_m, axes.right)) - 0.5 * width_m);
  const double y = std::max(0.0, std::abs(glm::dot(to_m, axes.up)) - 0.5 * tall_m);
  return glm::length(glm::dvec3(x, y, glm::dot(to_m, axes.forward)));
}

}  // namespace

SeenPosters::SeenPosters(std::span<const PlacedPoster> posters, const vpe::core::View& view, double gamma)
    : view_(view), gamma_(gamma), clear_m_(kInfinity) {
  for (const PlacedPoster& placed : posters) {
    Seen seen;
    seen.placed = &placed;
    seen.opacity = placed.opacity;
    seen.axes = placed.axes;
    seen.from_camera_m = placed.middle_m - view.camera.position_m;
    seen.is_dome = placed.form == PosterForm::kDome;
    seen.replaces_ground = placed.replaces_ground;
    double clear_m = 0;
    if (seen.is_dome) {
      const glm::dvec3 level = seen.from_camera_m - glm::dot(seen.from_camera_m, seen.axes.up) * seen.axes.up;
      const double within_m = glm::length(placed.is_cylinder ? level : seen.from_camera_m);
      seen.opacity *=
          within_m < placed.radius_m ? dome_share(glm::length(seen.from_camera_m), placed.fade_m) : 0;
      clear_m = placed.radius_m - within_m;
    } else {
      if (placed.form == PosterForm::kBillboard) {
        seen.axes = facing_axes(placed.axes.up, seen.from_camera_m);
        seen.from_camera_m += 0.5 * placed.tall_m * placed.axes.up;
      }
      seen.radius_m = 0.5 * std::hypot(placed.width_m, placed.tall_m);
      clear_m = distance_to_rectangle_m(seen.from_camera_m, seen.axes, placed.width_m, placed.tall_m);
    }
    if (!(seen.opacity > 0)) continue;
    clear_m_ = std::min(clear_m_, clear_m);
    seen_.push_back(seen);
  }
}

bool SeenPosters::is_see_through() const {
  return std::ranges::any_of(seen_, [](const Seen& seen) { return seen.opacity < 1; });
}

std::vector<std::uint32_t> SeenPosters::in_cone(const glm::dvec3& axis, double cosine, double until_m) const {
  std::vector<std::uint32_t> out;
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  for (std::uint32_t n = 0; n < seen_.size(); ++n) {
    const Seen& seen = seen_[n];
    if (!seen.is_dome) {
      const double distance_m = glm::length(seen.from_camera_m);
      if (distance_m - seen.radius_m > until_m) continue;
      if (distance_m > seen.radius_m) {
        const double reach = std::asin(std::min(1.0, seen.radius_m / distance_m)) + angle + 1e-7;
        if (mars::angle_between_rad(axis, seen.from_camera_m / distance_m) > reach) continue;
      }
    }
    out.push_back(n);
  }
  return out;
}

std::optional<PosterHit> SeenPosters::meet_rectangle(const Seen& seen, const glm::dvec3& direction,
                                                     double until_m) const {
  const PlacedPoster& placed = *seen.placed;
  const double cosine = glm::dot(direction, seen.axes.forward);
  const double range_m = glm::dot(seen.from_camera_m, seen.axes.forward) / cosine;
  if (!(range_m > 0) || !(range_m < until_m)) return std::nullopt;
  const glm::dvec3 from_middle_m = range_m * direction - seen.from_camera_m;
  const double u = 0.5 + glm::dot(from_middle_m, seen.axes.right) / placed.width_m;
  const double v = 0.5 - glm::dot(from_middle_m, seen.axes.up) / placed.tall_m;
  if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return std::nullopt;
  const double pixel_m2 =
      pixel_solid_angle(view_, direction) * range_m * range_m / std::max(kLeastPosterCosine, std::abs(cosine));
  const double texel_m2 = placed.width_m * placed.tall_m / placed.image.width_px / placed.image.height_px;
  return PosterHit{range_m, 0, {u, v}, static_cast<float>(std::sqrt(pixel_m2 / texel_m2))};
}

std::optional<PosterHit> SeenPosters::meet_dome(const Seen& seen, const glm::dvec3& direction,
                                                double until_m) const {
  const PlacedPoster& placed = *seen.placed;
  glm::dvec3 d = direction;
  glm::dvec3 from_m = -seen.from_camera_m;
  if (placed.is_cylinder) {
    d -= glm::dot(d, seen.axes.up) * seen.axes.up;
    from_m -= glm::dot(from_m, seen.axes.up) * seen.axes.up;
  }
  // The camera is within, so that c is negative and the larger root is the one ahead.
  const double a = glm::dot(d, d);
  const double b = glm::dot(from_m, d);
  const double c = glm::dot(from_m, from_m) - placed.radius_m * placed.radius_m;
  const double root = std::sqrt(b * b - a * c);
  const double range_m = b > 0 ? -c / (b + root) : (root - b) / a;
  if (!(range_m > 0) || !std::isfinite(range_m)) return std::nullopt;
  const bool is_nearer = range_m < until_m;
  if (!is_nearer && !seen.replaces_ground) return std::nullopt;
  const glm::dvec3 from_middle_m = range_m * direction - seen.from_camera_m;
  const double distance_m = glm::length(from_middle_m);
  const glm::dvec3 out = from_middle_m / distance_m;
  const std::optional<PanoramaPlace> place = placed.image.lookup(
      {glm::dot(out, seen.axes.right), glm::dot(out, seen.axes.forward), glm::dot(out, seen.axes.up)});
  if (!place) return std::nullopt;
  const double pixel_sr = pixel_solid_angle(view_, direction) * range_m * range_m /
                          (distance_m * distance_m * std::max(kLeastPosterCosine, glm::dot(direction, out)));
  return PosterHit{is_nearer ? range_m : until_m, 0, place->uv,
                   static_cast<float>(std::sqrt(pixel_sr / place->texel_sr))};
}

std::optional<PosterHit> SeenPosters::meet(std::uint32_t poster, const glm::dvec3& direction,
                                           double until_m) const {
  const Seen& seen = seen_[poster];
  std::optional<PosterHit> hit =
      seen.is_dome ? meet_dome(seen, direction, until_m) : meet_rectangle(seen, direction, until_m);
  if (hit) hit->poster = poster;
  return hit;
}

glm::dvec4 SeenPosters::colour(std::uint32_t poster, const glm::vec2& uv, float texels) const {
  const Seen& seen = seen_[poster];
  const PosterImage& image = seen.placed->image;
  glm::dvec3 colour(image.texture->sample_within(uv, texels, image.is_full_circle));
  if (gamma_ != 1) colour = 255.0 * glm::pow(colour / 255.0, glm::dvec3(gamma_));
  return {colour, 255 * seen.opacity};
}

}  // namespace objects
