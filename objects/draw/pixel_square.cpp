#include "objects/draw/pixel_square.h"

#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>

namespace objects {

using vpe::core::Projection;

ViewRays::ViewRays(const vpe::core::View& view)
    : view_(view), is_perspective_(view.projection == Projection::kPerspective) {
  if (!is_perspective_) return;
  const mars::Axes& axes = view.camera.axes;
  right_ = axes.right;
  down_ = -axes.up;
  const glm::dvec2 principal = 0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px;
  corner_ = vpe::core::focal_px(view) * axes.forward - principal.x * right_ - principal.y * down_;
}

ViewCone cone_of(const vpe::core::View& view, const ViewRays& rays, const PixelSquare& s, double margin_px) {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  const double left = part.x + s.x0 - margin_px;
  const double right = part.x + s.x1 + margin_px;
  const double top = part.y + s.y0 - margin_px;
  const double bottom = part.y + s.y1 + margin_px;
  ViewCone cone;
  cone.axis = rays.at(0.5 * (left + right), 0.5 * (top + bottom));
  cone.cosine = 1;
  // Sides of round images are no great circles, so their middles count too.
  const bool is_round = view.projection != Projection::kPerspective;
  const int steps = is_round ? 8 : 1;
  for (int n = 0; n <= steps; ++n) {
    const double x = left + (right - left) * n / steps;
    for (const double y : {top, bottom, 0.5 * (top + bottom)})
      cone.cosine = std::min(cone.cosine, glm::dot(cone.axis, rays.at(x, y)));
  }
  double angle = std::acos(std::clamp(cone.cosine, -1.0, 1.0));
  angle = std::min(glm::pi<double>(), angle * (is_round ? 1.1 : 1.0) + 1e-7);
  cone.cosine = std::cos(angle);
  cone.sine = std::max(0.0, std::sin(angle));
  return cone;
}

// Round images may show all directions.
ViewCone cone_of_view(const vpe::core::View& view, const ViewRays& rays) {
  if (view.projection != Projection::kPerspective) return {view.camera.axes.forward, -1, 0};
  const glm::ivec2 size = vpe::core::drawn_size(view);
  return cone_of(view, rays, {0, 0, size.x, size.y}, 1);
}

double pixel_solid_angle(const vpe::core::View& view, const glm::dvec3& direction) {
  const double f = vpe::core::focal_px(view);
  if (view.projection == Projection::kPerspective) {
    const double cosine = std::max(1e-6, glm::dot(direction, view.camera.axes.forward));
    return cosine * cosine * cosine / (f * f);
  }
  const double column = 2 * glm::pi<double>() / view.width;
  const double sine = glm::dot(direction, view.camera.axes.up);
  const double cosine = std::sqrt(std::max(1e-12, 1 - sine * sine));
  if (view.projection == Projection::kEquirectangular) return column * cosine / f;
  return column * cosine * cosine * cosine / f;
}

GroundRanges::GroundRanges(const vpe::core::Frame& frame, const PixelSquare& s)
    : square_(s), side_(s.x1 - s.x0 + 2) {
  const int rows = s.y1 - s.y0 + 2;
  has_sky_ = frame.range_m.empty();
  range_m_.resize(stride() * static_cast<std::size_t>(rows + kPad_px) + kPad_px,
                  has_sky_ ? vpe::core::kSkyRange : 0);
  if (has_sky_) return;
  const auto width = static_cast<std::size_t>(frame.width);
  for (int y = s.y0 - 1; y <= s.y1; ++y) {
    const float* const from =
        frame.range_m.data() + static_cast<std::size_t>(std::clamp(y, 0, frame.height - 1)) * width;
    float* const to = range_m_.data() + static_cast<std::size_t>(y - s.y0 + 1) * stride();
    to[0] = from[std::max(0, s.x0 - 1)];
    std::copy(from + s.x0, from + s.x1, to + 1);
    to[s.x1 - s.x0 + 1] = from[std::min(s.x1, frame.width - 1)];
    if (y < s.y0 || y >= s.y1) continue;
    int sky = 0;
    for (int x = s.x0; x < s.x1; ++x) sky += std::isinf(from[x]) ? 1 : 0;
    has_sky_ = has_sky_ || sky > 0;
    if (sky == s.x1 - s.x0) continue;
    for (int x = s.x0; x < s.x1; ++x) {
      if (std::isinf(from[x])) continue;
      nearest_m_ = std::min(nearest_m_, static_cast<double>(from[x]));
      farthest_ground_m_ = std::max(farthest_ground_m_, static_cast<double>(from[x]));
    }
  }
}

double GroundRanges::beside(int x, int y, const glm::dvec2& offset) const {
  const auto inverse = [&](int i, int j) { return 1 / static_cast<double>(at(i, j)); };
  const double here = inverse(x, y);
  if (!(here > 0)) return std::numeric_limits<double>::infinity();
  // Returns the change for a pixel, 0 where one surface ends: there the two sides differ by far.
  const auto slope = [&](double before, double after) {
    const double a = here - before;
    const double b = after - here;
    const double least = std::min(std::abs(a), std::abs(b));
    return a * b > 0 && std::max(std::abs(a), std::abs(b)) < 2 * least ? 0.5 * (a + b) : 0.0;
  };
  const double moved = here + offset.x * slope(inverse(x - 1, y), inverse(x + 1, y)) +
                       offset.y * slope(inverse(x, y - 1), inverse(x, y + 1));
  return moved > 0 ? 1 / moved : 1 / here;
}

}  // namespace objects
