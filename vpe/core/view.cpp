#include "vpe/core/view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::core {

namespace {

constexpr double kAxesTolerance = 1e-9;

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_orthonormal(const mars::Axes& axes) {
  const auto is_unit = [](const glm::dvec3& v) { return std::abs(glm::dot(v, v) - 1.0) <= kAxesTolerance; };
  if (!is_unit(axes.right) || !is_unit(axes.up) || !is_unit(axes.forward)) return false;
  return glm::length(glm::cross(axes.right, axes.up) + axes.forward) <= kAxesTolerance;
}

glm::dvec2 principal_point(const View& view) {
  return glm::dvec2(view.width, view.height) * 0.5 + view.principal_offset_px;
}

bool has_part(const View& view) {
  const SubRectangle& p = view.part;
  return p.width != 0 || p.height != 0 || p.x != 0 || p.y != 0;
}

std::string check_part(const View& view) {
  const SubRectangle& p = view.part;
  if (!has_part(view)) return {};
  const bool inside = p.x >= 0 && p.y >= 0 && p.width >= 1 && p.height >= 1 && p.x <= view.width - p.width &&
                      p.y <= view.height - p.height;
  if (inside && (p.width > ViewLimits::kMaxSide_px || p.height > ViewLimits::kMaxSide_px)) {
    return "a part of " + std::to_string(p.width) + "x" + std::to_string(p.height) +
           " pixels: each side must be 1 to " + std::to_string(ViewLimits::kMaxSide_px);
  }
  if (inside) return {};
  return "the part (x " + std::to_string(p.x) + ", y " + std::to_string(p.y) + ", " + std::to_string(p.width) +
         "x" + std::to_string(p.height) + ") does not lie inside the image of " + std::to_string(view.width) +
         "x" + std::to_string(view.height) + " pixels";
}

}  // namespace

std::string check(const View& view) {
  if (!is_finite(view.camera.position_m) ||
      glm::length(view.camera.position_m) > ViewLimits::kMaxCameraDistance_m) {
    return "the camera's position is not finite or farther than " +
           base::format_number(ViewLimits::kMaxCameraDistance_m) + " m from the planet's centre";
  }
  if (!is_orthonormal(view.camera.axes))
    return "the camera's axes are not orthonormal; make them with mars::to_camera";
  const int max_side_px = has_part(view) ? ViewLimits::kMaxFullSide_px : ViewLimits::kMaxSide_px;
  if (view.width < 1 || view.height < 1 || view.width > max_side_px || view.height > max_side_px) {
    return "image size " + std::to_string(view.width) + "x" + std::to_string(view.height) +
           ": each side must be 1 to " + std::to_string(max_side_px) + " pixels";
  }
  const bool is_equirectangular = view.projection == Projection::kEquirectangular;
  const double max_fov_deg = is_equirectangular ? 180.0 : ViewLimits::kMaxFov_deg;
  if (!(view.fov_deg >= ViewLimits::kMinFov_deg && view.fov_deg <= max_fov_deg)) {
    return "field of view " + base::format_number(view.fov_deg) + " degrees: must be " +
           base::format_number(ViewLimits::kMinFov_deg) + " to " + base::format_number(max_fov_deg);
  }
  const glm::dvec2& offset = view.principal_offset_px;
  if (!(std::abs(offset.x) <= ViewLimits::kMaxOffset_px && std::abs(offset.y) <= ViewLimits::kMaxOffset_px)) {
    return "principal-point offset (" + base::format_number(offset.x) + ", " + base::format_number(offset.y) +
           "): each must be at most " + base::format_number(ViewLimits::kMaxOffset_px) + " pixels";
  }
  const double farthest_deg = (0.5 * view.height + std::abs(offset.y)) * view.fov_deg / view.height;
  if (is_equirectangular && farthest_deg > 90.0 + 1e-9) {
    return "an equirectangular image of " + base::format_number(view.fov_deg) + " degrees with an offset of " +
           base::format_number(offset.y) + " rows goes past the zenith or nadir";
  }
  return check_part(view);
}

double focal_px(const View& view) {
  const double fov_rad = view.fov_deg * mars::kRadiansPerDegree;
  if (view.projection == Projection::kEquirectangular) return view.height / fov_rad;
  return 0.5 * view.height / std::tan(0.5 * fov_rad);
}

double corner_stretch(const View& view) {
  if (view.projection != Projection::kPerspective) return 1;
  const SubRectangle part = drawn_part(view);
  const double cx = 0.5 * view.width + view.principal_offset_px.x;
  const double cy = 0.5 * view.height + view.principal_offset_px.y;
  const double x = std::max(std::abs(part.x - cx), std::abs(part.x + part.width - cx));
  const double y = std::max(std::abs(part.y - cy), std::abs(part.y + part.height - cy));
  const double f = focal_px(view);
  return 1 + (x * x + y * y) / (f * f);
}

glm::dvec3 pixel_ray(const View& view, double x, double y) {
  const mars::Axes& axes = view.camera.axes;
  const glm::dvec2 from_principal = glm::dvec2(x, y) - principal_point(view);
  const auto in_axes = [&axes](double right, double up, double forward) {
    const glm::dvec3 d = axes.right * right + axes.up * up + axes.forward * forward;
    return d / glm::length(d);
  };
  if (view.projection == Projection::kPerspective) {
    return in_axes(from_principal.x, -from_principal.y, focal_px(view));
  }
  // Full circles are removed exactly, before anything is rounded.
  const mars::SinCos azimuth =
      mars::sin_cos_deg(std::remainder(from_principal.x, view.width) * 360.0 / view.width);
  if (view.projection == Projection::kCylinder) {
    return in_axes(azimuth.sin, -from_principal.y / focal_px(view), azimuth.cos);
  }
  const mars::SinCos elevation = mars::sin_cos_deg(-from_principal.y * view.fov_deg / view.height);
  return in_axes(elevation.cos * azimuth.sin, elevation.sin, elevation.cos * azimuth.cos);
}

Projected project(const View& view, const glm::dvec3& point_m) {
  const glm::dvec3 to = point_m - view.camera.position_m;
  const double right = glm::dot(to, view.camera.axes.right);
  const double up = glm::dot(to, view.camera.axes.up);
  const double forward = glm::dot(to, view.camera.axes.forward);
  const glm::dvec2 principal = principal_point(view);
  Projected result;
  result.depth_m = forward;
  if (view.projection == Projection::kPerspective) {
    result.behind = !(forward > 0.0);
    if (!result.behind) result.xy = principal + glm::dvec2(right, -up) * (focal_px(view) / forward);
    return result;
  }
  const double level = std::hypot(right, forward);
  const bool is_cylinder = view.projection == Projection::kCylinder;
  result.behind = is_cylinder ? !(level > 0.0) : !(level > 0.0 || up != 0.0);
  if (result.behind) return result;
  const double circles = std::atan2(right, forward) / (2.0 * mars::kPi);
  double x = std::fmod(principal.x + circles * view.width, view.width);
  if (x < 0.0) x += view.width;
  if (x >= view.width) x = 0.0;
  const double rise = is_cylinder ? up / level : std::atan2(up, level);
  result.xy = {x, principal.y - focal_px(view) * rise};
  return result;
}

SubRectangle drawn_part(const View& view) {
  return view.part.width > 0 ? view.part : SubRectangle{0, 0, view.width, view.height};
}

glm::ivec2 drawn_size(const View& view) {
  const SubRectangle part = drawn_part(view);
  return {part.width, part.height};
}

std::array<Plane, 4> side_planes(const View& view) {
  if (view.projection != Projection::kPerspective) {
    throw std::invalid_argument("side planes exist for perspective views only");
  }
  const mars::Axes& axes = view.camera.axes;
  const SubRectangle part = drawn_part(view);
  const double f = focal_px(view);
  const glm::dvec2 low = glm::dvec2(part.x, part.y) - principal_point(view);
  const glm::dvec2 high = low + glm::dvec2(part.width, part.height);
  const auto plane = [&view](const glm::dvec3& inward) {
    const glm::dvec3 normal = inward / glm::length(inward);
    return Plane{normal, glm::dot(normal, view.camera.position_m)};
  };
  return {plane(axes.right * f - axes.forward * low.x), plane(axes.forward * high.x - axes.right * f),
          plane(axes.up * f + axes.forward * high.y), plane(-axes.up * f - axes.forward * low.y)};
}

bool reaches_horizon(const View& view, double radius_m) {
  const double distance_m = glm::length(view.camera.position_m);
  if (view.projection != Projection::kPerspective || !(distance_m > radius_m)) return true;
  const glm::dvec3 down = -view.camera.position_m / distance_m;
  const double sine = radius_m / distance_m;
  const double least_cosine = std::sqrt((1 - sine) * (1 + sine));
  // The directions below the horizon form a convex cone: the image lies within it if its corners do.
  const SubRectangle part = drawn_part(view);
  for (const int x : {part.x, part.x + part.width}) {
    for (const int y : {part.y, part.y + part.height}) {
      if (glm::dot(pixel_ray(view, x, y), down) <= least_cosine) return true;
    }
  }
  return false;
}

}  // namespace vpe::core
