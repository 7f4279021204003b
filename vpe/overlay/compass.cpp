#include "vpe/overlay/compass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/base/nice_ticks.h"
#include "vpe/overlay/number_format.h"

namespace vpe::overlay {

namespace {

using mars::kRadiansPerDegree;

// Describes steps of whole degrees, or of one degree divided by `parts`.
struct Step {
  int degrees;
  int parts;
  int ticks_to_figure;

  double tick_deg() const { return static_cast<double>(degrees) / parts; }
  double figure_deg() const { return static_cast<double>(degrees * ticks_to_figure) / parts; }
};
constexpr std::array<Step, 17> kSteps{{{15, 1, 6},
                                       {15, 1, 3},
                                       {10, 1, 3},
                                       {5, 1, 3},
                                       {2, 1, 5},
                                       {1, 1, 5},
                                       {1, 2, 4},
                                       {1, 5, 5},
                                       {1, 10, 5},
                                       {1, 20, 4},
                                       {1, 50, 5},
                                       {1, 100, 5},
                                       {1, 200, 4},
                                       {1, 500, 5},
                                       {1, 1000, 5},
                                       {1, 2000, 4},
                                       {1, 5000, 5}}};

constexpr double kWind_deg = 45;
constexpr double kSame_deg = 1e-9;
constexpr std::array<const char*, 8> kWinds{"N", "NE", "E", "SE", "S", "SW", "W", "NW"};

double normalized_azimuth(double azimuth_deg) {
  const double rest = azimuth_deg - 360.0 * std::floor(azimuth_deg / 360.0);
  return rest < 360.0 - kSame_deg ? rest : 0.0;
}

// Projects a vector onto the local horizontal plane: east, north.
struct HorizontalProjection {
  const mars::LocalFrame& frame;

  glm::dvec2 operator()(const glm::dvec3& v) const {
    return {glm::dot(v, frame.east), glm::dot(v, frame.north)};
  }
};

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }
double azimuth_of(glm::dvec2 east_north) { return std::atan2(east_north.x, east_north.y) / kRadiansPerDegree; }
glm::dvec2 east_north_of(double azimuth_deg) {
  const mars::SinCos a = mars::sin_cos_deg(azimuth_deg);
  return {a.sin, a.cos};
}

struct Image {
  core::SubRectangle part;
  glm::dvec2 principal;
  double focal_px;

  explicit Image(const core::View& view)
      : part(core::drawn_part(view)),
        principal(0.5 * view.width + view.principal_offset_px.x,
                  0.5 * view.height + view.principal_offset_px.y),
        focal_px(core::focal_px(view)) {}
};

std::optional<double> level_yaw_deg(const core::View& view, const mars::LocalFrame& frame) {
  constexpr double kLevel = 1e-9;
  if (std::abs(glm::dot(view.camera.axes.right, frame.up)) > kLevel ||
      std::abs(glm::dot(view.camera.axes.forward, frame.up)) > kLevel) {
    return std::nullopt;
  }
  return azimuth_of(HorizontalProjection{frame}(view.camera.axes.forward));
}

// Places marks in a row of a cylindrical or equirectangular view's part.
std::vector<PlacedMark> cylindrical_row(const core::View& view, const mars::LocalFrame& frame, double row_px,
                                        double label_px) {
  const auto yaw_deg = level_yaw_deg(view, frame);
  if (!yaw_deg) return {};
  const Image image(view);
  const double px_per_deg = view.width / 360.0;
  const double left_deg = *yaw_deg + (image.part.x - image.principal.x) / px_per_deg;
  std::vector<PlacedMark> placed;
  for (CompassMark& mark :
       compass_marks(left_deg, image.part.width / px_per_deg, compass_steps(px_per_deg, label_px))) {
    const double x = (mark.azimuth_deg - left_deg) * px_per_deg;
    placed.push_back({std::move(mark), {x, row_px}});
  }
  return placed;
}

// Places marks along the straight line between two positions of a perspective view's full image.
std::vector<PlacedMark> along(const core::View& view, const mars::LocalFrame& frame, glm::dvec2 from,
                              glm::dvec2 to, double label_px) {
  constexpr double kNearZenith = 0.035;  // sine of 2 degrees
  const Image image(view);
  const HorizontalProjection horizontal{frame};
  const mars::Axes& axes = view.camera.axes;
  const auto ray = [&](glm::dvec2 at) {
    return horizontal(axes.right * (at.x - image.principal.x) + axes.up * (image.principal.y - at.y) +
                      axes.forward * image.focal_px);
  };
  // Projected to the horizontal plane, the rays through the line end on a straight line. An azimuth's mark is
  // where its direction crosses that line.
  const double length_px = glm::length(to - from);
  if (!(length_px > 0)) return {};
  const glm::dvec2 start = ray(from);
  const glm::dvec2 step = (ray(to) - start) / length_px;
  const double rotation = cross(step, start);  // > 0: azimuth grows along the line
  const double step_length = glm::length(step);
  if (!(step_length > 0) || std::abs(rotation) / step_length < kNearZenith * image.focal_px) return {};
  const double nearest_px = std::clamp(-glm::dot(start, step) / (step_length * step_length), 0.0, length_px);
  const glm::dvec2 nearest = start + step * nearest_px;
  const double px_per_deg = glm::dot(nearest, nearest) / std::abs(rotation) * kRadiansPerDegree;

  const double first_deg = azimuth_of(start);
  const double last_deg = azimuth_of(start + step * length_px);
  const double span_deg = std::remainder(last_deg - first_deg, 360.0);
  std::vector<PlacedMark> placed;
  for (CompassMark& mark : compass_marks(span_deg < 0 ? first_deg + span_deg : first_deg, std::abs(span_deg),
                                         compass_steps(px_per_deg, label_px))) {
    const glm::dvec2 direction = east_north_of(mark.azimuth_deg);
    const double along_px = std::clamp(-cross(start, direction) / cross(step, direction), 0.0, length_px);
    const glm::dvec2 at = from + (to - from) * (along_px / length_px);
    placed.push_back({std::move(mark), {at.x - image.part.x, at.y - image.part.y}});
  }
  return placed;
}

}  // namespace

CompassSteps compass_steps(double px_per_deg, double label_px) {
  constexpr double kApart = 2;  // distance of figures, in widths of a label
  const Step* best = kSteps.data();
  for (const Step& step : kSteps) {
    if (step.figure_deg() * px_per_deg >= kApart * label_px) best = &step;
  }
  return {best->tick_deg(), best->figure_deg(), label_px / px_per_deg};
}

std::vector<CompassMark> compass_marks(double from_deg, double span_deg, const CompassSteps& steps) {
  const double parts = std::max(1.0, std::round(1.0 / steps.tick_deg));
  const double whole = std::max(1.0, std::round(steps.tick_deg));
  const auto ticks_to_figure = static_cast<std::int64_t>(std::llround(steps.figure_deg / steps.tick_deg));
  const int decimals = base::step_decimals(steps.figure_deg);
  // With figures every 90 degrees there is no room for eight winds.
  const double wind_deg = std::max(kWind_deg, std::min(steps.figure_deg, 90.0));
  const double to_deg = from_deg + span_deg;
  std::vector<CompassMark> marks;
  const auto first = static_cast<std::int64_t>(std::ceil((from_deg - kSame_deg) / steps.tick_deg));
  const auto last = static_cast<std::int64_t>(std::floor((to_deg + kSame_deg) / steps.tick_deg));
  for (std::int64_t n = first; n <= last; ++n) {
    CompassMark mark;
    mark.azimuth_deg = static_cast<double>(n) * whole / parts;
    const double from_wind_deg = std::abs(std::remainder(mark.azimuth_deg, wind_deg));
    if (from_wind_deg < kSame_deg) continue;
    if (n % ticks_to_figure == 0 && from_wind_deg >= steps.room_deg) {
      mark.rank = CompassRank::kFigure;
      mark.label = number_text(normalized_azimuth(mark.azimuth_deg), decimals) + "\u00b0";
    }
    marks.push_back(std::move(mark));
  }
  const auto first_wind = static_cast<std::int64_t>(std::ceil((from_deg - kSame_deg) / wind_deg));
  const auto last_wind = static_cast<std::int64_t>(std::floor((to_deg + kSame_deg) / wind_deg));
  for (std::int64_t n = first_wind; n <= last_wind; ++n) {
    const double azimuth_deg = static_cast<double>(n) * wind_deg;
    const auto wind =
        static_cast<std::size_t>(std::llround(normalized_azimuth(azimuth_deg) / kWind_deg)) % kWinds.size();
    marks.push_back({azimuth_deg, CompassRank::kWind, kWinds[wind]});
  }
  std::sort(marks.begin(), marks.end(),
            [](const CompassMark& a, const CompassMark& b) { return a.azimuth_deg < b.azimuth_deg; });
  return marks;
}

std::vector<PlacedMark> compass_row(const core::View& view, const mars::LocalFrame& frame, double label_px) {
  const core::SubRectangle part = core::drawn_part(view);
  if (view.projection != core::Projection::kPerspective)
    return cylindrical_row(view, frame, 0.5 * part.height, label_px);
  const double row = part.y + 0.5 * part.height;
  return along(view, frame, {part.x, row}, {part.x + part.width, row}, label_px);
}

std::optional<HorizonLine> horizon_line(const core::View& view, const mars::LocalFrame& frame) {
  const Image image(view);
  const glm::dvec2 corner(image.part.x, image.part.y);
  const glm::dvec2 size(image.part.width, image.part.height);
  if (view.projection != core::Projection::kPerspective) {
    const double row = image.principal.y - corner.y;
    if (row < 0 || row > size.y || !level_yaw_deg(view, frame)) return std::nullopt;
    return HorizonLine{{0, row}, {size.x, row}};
  }
  // Rays without a vertical component: normal.x x + normal.y y + offset = 0.
  const mars::Axes& axes = view.camera.axes;
  const glm::dvec2 normal(glm::dot(axes.right, frame.up), -glm::dot(axes.up, frame.up));
  const double offset =
      image.focal_px * glm::dot(axes.forward, frame.up) + glm::dot(normal, corner - image.principal);
  const double squared = glm::dot(normal, normal);
  if (!(squared > 0)) return std::nullopt;
  // Clips the line at the image's edges, in a parametrisation that runs to the right.
  const glm::dvec2 foot = normal * (-offset / squared);
  glm::dvec2 direction = glm::dvec2(-normal.y, normal.x) / std::sqrt(squared);
  if (direction.x < 0) direction = -direction;
  double begin = -std::numeric_limits<double>::infinity();
  double end = -begin;
  for (int axis = 0; axis < 2; ++axis) {
    constexpr double kAlongAnEdge = 1e-12;
    if (std::abs(direction[axis]) < kAlongAnEdge) {
      if (foot[axis] < 0 || foot[axis] > size[axis]) return std::nullopt;
      continue;
    }
    const double a = -foot[axis] / direction[axis];
    const double b = (size[axis] - foot[axis]) / direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(end > begin)) return std::nullopt;
  return HorizonLine{foot + direction * begin, foot + direction * end};
}

std::vector<PlacedMark> compass_horizon(const core::View& view, const mars::LocalFrame& frame,
                                        double label_px) {
  const auto line = horizon_line(view, frame);
  if (!line) return {};
  if (view.projection != core::Projection::kPerspective)
    return cylindrical_row(view, frame, line->left.y, label_px);
  const core::SubRectangle part = core::drawn_part(view);
  const glm::dvec2 corner(part.x, part.y);
  return along(view, frame, corner + line->left, corner + line->right, label_px);
}

}  // namespace vpe::overlay
