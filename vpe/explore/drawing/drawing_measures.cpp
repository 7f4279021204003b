#include "vpe/explore/drawing/drawing_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "paging/surface/section.h"
#include "vpe/base/number.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {

namespace {

constexpr double kStopStep_rad = 0.01;  // after which a section asks whether it is to stop
constexpr int kAreaDigits = 5;

std::string crossing_text(const std::vector<glm::dvec3>& polygon) {
  const auto crossing = crossing_edges(polygon);
  if (!crossing) return "";
  return "the outline crosses itself: edges " + std::to_string(crossing->first + 1) + " and " +
         std::to_string(crossing->second + 1);
}

// Adds the section between two directions. Returns false if it was asked to stop.
bool add_section(const paging::Surface& surface, const glm::dvec3& a, const glm::dvec3& b, GroundMeasures& out,
                 const std::stop_token& stop) {
  const int steps = std::max(1, static_cast<int>(std::ceil(mars::angle_between_rad(a, b) / kStopStep_rad)));
  glm::dvec3 from = a;
  for (int n = 1; n <= steps; ++n) {
    if (stop.stop_requested()) return false;
    const glm::dvec3 to = n == steps ? b : mars::slerp(a, b, static_cast<double>(n) / steps);
    const paging::SectionFigures figures = paging::section_figures(surface, from, to);
    out.length_m += figures.length_m;
    out.lowest_m = std::min(out.lowest_m, figures.lowest_m);
    out.highest_m = std::max(out.highest_m, figures.highest_m);
    from = to;
  }
  return true;
}

}  // namespace

SphereMeasures sphere_measures(const Drawing& drawing, double radius_m) {
  SphereMeasures out;
  const std::vector<glm::dvec3> directions = directions_of(drawing.vertices);
  if (drawing.kind != DrawingKind::kPolygon) {
    out.length_m = line_length_rad(directions) * radius_m;
    return out;
  }
  out.length_m = outline_length_rad(directions) * radius_m;
  out.no_area = crossing_text(directions);
  if (out.no_area.empty()) out.area_m2 = std::abs(signed_sphere_area(directions)) * radius_m * radius_m;
  return out;
}

std::optional<GroundMeasures> ground_measures(const paging::Surface& surface, const Drawing& drawing,
                                              const GroundAreaOptions& options, const std::stop_token& stop) {
  GroundMeasures out;
  const std::vector<glm::dvec3> directions = directions_of(drawing.vertices);
  out.lowest_m = out.highest_m = surface.at(directions.front()).height_m;
  for (std::size_t n = 1; n < directions.size(); ++n)
    if (!add_section(surface, directions[n - 1], directions[n], out, stop)) return std::nullopt;
  if (drawing.kind != DrawingKind::kPolygon) return out;
  if (!add_section(surface, directions.back(), directions.front(), out, stop)) return std::nullopt;
  if (!crossing_text(directions).empty()) return out;
  GroundAreaOptions of_area = options;
  GroundStatisticsOptions of_statistics;
  of_statistics.most_cells = options.most_cells;
  // Statistics go over the facets twice.
  if (options.progress) {
    of_area.progress = [&](double share) { options.progress(share / 3); };
    of_statistics.progress = [&](double share) { options.progress((1 + 2 * share) / 3); };
  }
  out.area = ground_area(surface, directions, of_area, stop);
  if (!out.area) return std::nullopt;
  if (!why_no_statistics(directions).empty()) return out;
  out.statistics = ground_statistics(surface, directions, of_statistics, stop);
  if (!out.statistics) return std::nullopt;
  return out;
}

std::string measured_area_text(double area_m2) {
  if (area_m2 >= 1e4) return base::format_significant(area_m2 / 1e6, kAreaDigits) + " km²";
  return base::format_significant(area_m2, kAreaDigits) + " m²";
}

std::string measured_volume_text(double volume_m3) {
  if (volume_m3 >= 1e7) return base::format_significant(volume_m3 / 1e9, kAreaDigits) + " km³";
  return base::format_significant(volume_m3, kAreaDigits) + " m³";
}

}  // namespace vpe::explore
