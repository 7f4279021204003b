#include "panorama/panorama_plan.h"

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace panorama {

namespace {

using mars::kRadiansPerDegree;
using vpe::base::format_number;
using vpe::core::Projection;
using vpe::core::View;
using Limits = PlanLimits;

struct Elevations {
  double lowest_deg = 0;
  double highest_deg = 0;
};

std::string text_of(double number) { return format_number(number); }

Elevations elevations_of(const PlanOptions& options) {
  const bool is_equirectangular = options.kind == MapKind::kEquirectangular;
  const double most_deg = is_equirectangular ? 90.0 : Limits::kMaxFlatElevation_deg;
  const double usual_deg = is_equirectangular ? 90.0 : Limits::kDefaultFlatElevation_deg;
  const Elevations e{options.lowest_deg.value_or(-usual_deg), options.highest_deg.value_or(usual_deg)};
  if (!(e.lowest_deg >= -most_deg && e.highest_deg <= most_deg)) {
    throw PlanError("elevations " + text_of(e.lowest_deg) + " to " + text_of(e.highest_deg) +
                    " degrees: an image of kind " + to_string(options.kind) + " holds -" + text_of(most_deg) +
                    " to " + text_of(most_deg));
  }
  if (!(e.highest_deg - e.lowest_deg >= Limits::kMinSpan_deg)) {
    throw PlanError("elevations " + text_of(e.lowest_deg) + " to " + text_of(e.highest_deg) +
                    " degrees: the second must be at least " + text_of(Limits::kMinSpan_deg) +
                    " degrees above the first");
  }
  return e;
}

struct Azimuths {
  double left_deg = 0;
  double span_deg = 360;
};

Azimuths azimuths_of(const PlanOptions& options) {
  const auto check_yaw = [](double yaw_deg) {
    if (std::abs(yaw_deg) <= Limits::kMaxYaw_deg) return;
    throw PlanError("yaw " + text_of(yaw_deg) + " degrees: must be within +-" + text_of(Limits::kMaxYaw_deg));
  };
  check_yaw(options.yaw_deg);
  if (!options.arc) {
    const bool has_facets = options.kind == MapKind::kFacets;
    return {options.yaw_deg - (has_facets ? 180.0 / options.facets : 0.0), 360.0};
  }
  check_yaw(options.arc->from_deg);
  check_yaw(options.arc->to_deg);
  const double asked_deg = options.arc->to_deg - options.arc->from_deg;
  const double turns = std::ceil(asked_deg / 360.0) - 1.0;
  const double span_deg = asked_deg == 0.0 ? 360.0 : asked_deg - 360.0 * turns;
  if (asked_deg > 360.0 || span_deg < Limits::kMinSpan_deg) {
    throw PlanError("azimuths " + text_of(options.arc->from_deg) + " to " + text_of(options.arc->to_deg) +
                    " degrees: an arc must be " + text_of(Limits::kMinSpan_deg) + " to 360 degrees wide");
  }
  return {options.arc->from_deg, span_deg};
}

void check_facets(const PlanOptions& options) {
  using MapLimits = PanoramaLimits;
  if (options.kind != MapKind::kFacets) return;
  if (options.facets >= MapLimits::kMinFacets && options.facets <= MapLimits::kMaxFacets) return;
  throw PlanError(std::to_string(options.facets) + " facets: must be " + std::to_string(MapLimits::kMinFacets) +
                  " to " + std::to_string(MapLimits::kMaxFacets));
}

// Returns the columns of 360 degrees that the options demand, not yet rounded.
double wanted_turn_px(const PlanOptions& options, double span_deg) {
  if (options.width_px && options.degrees_per_pixel) {
    throw PlanError("both a width and degrees a pixel are given; leave one out");
  }
  const auto most_px = static_cast<double>(kMaxSide_px);
  if (options.degrees_per_pixel) {
    const double scale_deg = *options.degrees_per_pixel;
    if (!(scale_deg >= 360.0 / most_px && scale_deg <= span_deg)) {
      throw PlanError(text_of(scale_deg) + " degrees a pixel: must be " + text_of(360.0 / most_px) + " to " +
                      text_of(span_deg) + " (the image's arc)");
    }
    return 360.0 / scale_deg;
  }
  const std::int64_t width_px = options.width_px.value_or(Limits::kDefaultWidth_px);
  if (width_px < 1 || width_px > kMaxSide_px) {
    throw PlanError("width of " + std::to_string(width_px) + " pixels: must be 1 to " +
                    std::to_string(kMaxSide_px));
  }
  const double turn_px = static_cast<double>(width_px) * 360.0 / span_deg;
  if (turn_px > most_px) {
    throw PlanError("width of " + std::to_string(width_px) + " pixels for " + text_of(span_deg) +
                    " degrees: a full circle would have " + text_of(std::round(turn_px)) +
                    " columns, more than " + text_of(most_px));
  }
  return turn_px;
}

// Returns the number of rows from the horizon up to an elevation.
double rows_to(const PanoramaMap& map, double elevation_deg) {
  const double elevation_rad = elevation_deg * kRadiansPerDegree;
  if (map.kind != MapKind::kEquirectangular) return std::round(map.focal_px * std::tan(elevation_rad));
  constexpr double kRounding = 1e-9;
  const double quarter_px = std::floor(0.25 * map.turn_px * (1.0 + kRounding));
  return std::clamp(std::round(map.focal_px * elevation_rad), -quarter_px, quarter_px);
}

void note(std::vector<std::string>& notes, const char* what, double is, double wanted, const char* unit) {
  constexpr double kSame = 1e-9;
  if (std::abs(is - wanted) <= kSame * std::max(1.0, std::abs(wanted))) return;
  notes.push_back(std::string(what) + " " + text_of(is) + unit + " instead of " + text_of(wanted) + unit);
}

}  // namespace

PanoramaPlan plan_panorama(const PlanOptions& options) {
  check_facets(options);
  const Elevations elevations = elevations_of(options);
  const Azimuths azimuths = azimuths_of(options);
  const double wanted_px = wanted_turn_px(options, azimuths.span_deg);
  PanoramaPlan plan;
  PanoramaMap& map = plan.map;
  if (options.kind == MapKind::kFacets) {
    const auto facet_px = static_cast<std::int64_t>(std::max(1.0, std::round(wanted_px / options.facets)));
    map = faceted_map(options.facets, facet_px, 1, options.yaw_deg, 0.0);
    const double x = map.place({azimuths.left_deg, 0.0}).x;
    // Rounding may make the left edge of the full circle its right one.
    map.crop_left_px = std::fmod(std::round(x), map.turn_px);
    map.width_px =
        static_cast<std::int64_t>(std::max(1.0, std::round(map.turn_px * azimuths.span_deg / 360.0)));
  } else {
    const auto width_px = static_cast<std::int64_t>(
        std::max(1.0, std::round(std::max(1.0, std::round(wanted_px)) * azimuths.span_deg / 360.0)));
    const double turn_px = std::max(1.0, std::round(wanted_px));
    map = options.kind == MapKind::kCylinder
              ? cylinder_map(width_px, 1, turn_px, azimuths.left_deg, 0.0)
              : equirectangular_map(width_px, 1, turn_px, azimuths.left_deg, 0.0);
  }
  map.horizon_px = rows_to(map, elevations.highest_deg);
  map.height_px = static_cast<std::int64_t>(map.horizon_px - rows_to(map, elevations.lowest_deg));
  if (map.height_px < 1) {
    throw PlanError("elevations " + text_of(elevations.lowest_deg) + " to " + text_of(elevations.highest_deg) +
                    " degrees are less than a row; ask for more columns or more elevation");
  }
  if (map.height_px > Limits::kMaxHeight_px) {
    throw PlanError("the image would be " + std::to_string(map.height_px) + " rows high, more than " +
                    std::to_string(Limits::kMaxHeight_px) + "; ask for fewer columns or less elevation");
  }
  if (const std::string problem = check(map); !problem.empty()) throw PlanError(problem);

  if (options.width_px) {
    note(plan.rounded, "width", static_cast<double>(map.width_px), static_cast<double>(*options.width_px),
         " px");
  }
  if (options.degrees_per_pixel) {
    note(plan.rounded, "scale", 360.0 / map.turn_px, *options.degrees_per_pixel, " degrees a pixel");
  }
  note(plan.rounded, "arc", map.azimuth_span_deg(), azimuths.span_deg, " degrees");
  return plan;
}

namespace {

View facet_view(const PanoramaMap& map, const Viewpoint& viewpoint, std::int64_t facet, int margin_px) {
  View view;
  view.camera =
      level_camera(viewpoint, map.turn_azimuth_deg + 360.0 * (static_cast<double>(facet) + 0.5) / map.facets);
  view.width = static_cast<int>(map.facet_px()) + 2 * margin_px;
  view.height = static_cast<int>(map.height_px) + 2 * margin_px;
  view.principal_offset_px.y = map.horizon_px + margin_px - 0.5 * view.height;
  view.fov_deg = 2.0 * std::atan(0.5 * view.height / map.focal_px) / kRadiansPerDegree;
  return view;
}

// Returns the number of columns of a piece with so many rows: whole groups of the ray backend's vectors.
std::int64_t piece_columns(std::int64_t rows) {
  constexpr std::int64_t kGroup_px = 16;
  return std::clamp<std::int64_t>(PlanLimits::kPiecePixels / rows / kGroup_px * kGroup_px, kGroup_px,
                                  PlanLimits::kMaxPieceSide_px);
}

}  // namespace

View round_view(const PanoramaMap& map, const Viewpoint& viewpoint) {
  View view;
  view.camera = level_camera(viewpoint, map.turn_azimuth_deg + 180.0);
  view.width = static_cast<int>(map.turn_px);
  view.height = static_cast<int>(map.height_px);
  view.principal_offset_px.y = map.horizon_px - 0.5 * view.height;
  if (map.kind == MapKind::kCylinder) {
    view.projection = Projection::kCylinder;
    view.fov_deg = 2.0 * std::atan(0.5 * view.height / map.focal_px) / kRadiansPerDegree;
  } else {
    view.projection = Projection::kEquirectangular;
    view.fov_deg = std::min(180.0, view.height * 360.0 / map.turn_px);
  }
  return view;
}

std::vector<Strip> strips_of(const PanoramaMap& map) { return strips_of(map.width_px, map.height_px); }

std::vector<Strip> strips_of(std::int64_t image_width_px, std::int64_t height_px) {
  const std::int64_t tiles =
      std::max<std::int64_t>(1, PlanLimits::kStripPixels / height_px / PlanLimits::kTile_px);
  // Wide and low images have strips of a bounded width, too.
  const std::int64_t width_px =
      std::min<std::int64_t>(tiles * PlanLimits::kTile_px, PlanLimits::kMaxPieceSide_px);
  std::vector<Strip> strips;
  for (std::int64_t x = 0; x < image_width_px; x += width_px) {
    strips.push_back({x, static_cast<int>(std::min(width_px, image_width_px - x))});
  }
  return strips;
}

std::vector<Piece> pieces_of(const PanoramaMap& map, const Viewpoint& viewpoint, const Strip& strip,
                             int margin_px) {
  const bool has_facets = map.kind == MapKind::kFacets;
  const auto crop_px = static_cast<std::int64_t>(map.crop_left_px);
  const auto turn_px = static_cast<std::int64_t>(map.turn_px);
  const std::int64_t unit_px = has_facets ? static_cast<std::int64_t>(map.facet_px()) : turn_px;
  // The ray backend casts whole columns, and its time depends only on the part of them that is drawn.
  const std::int64_t rows = std::min<std::int64_t>(
      map.height_px, has_facets ? PlanLimits::kMaxPieceSide_px : vpe::core::ViewLimits::kMaxSide_px);
  std::vector<Piece> pieces;
  const std::int64_t end = strip.x + strip.width;
  for (std::int64_t x = strip.x; x < end;) {
    const std::int64_t column = (x + crop_px) % turn_px;
    const std::int64_t unit = column / unit_px;
    const std::int64_t in_unit = column - unit * unit_px;
    const std::int64_t width = std::min({end - x, unit_px - in_unit, piece_columns(rows)});
    Piece piece;
    piece.x = x;
    piece.width = static_cast<int>(width);
    piece.margin_px = has_facets ? margin_px : 0;
    piece.view = has_facets ? facet_view(map, viewpoint, unit, margin_px) : round_view(map, viewpoint);
    for (std::int64_t y = 0; y < map.height_px; y += rows) {
      piece.y = y;
      piece.height = static_cast<int>(std::min(rows, map.height_px - y));
      piece.view.part = {static_cast<int>(in_unit), static_cast<int>(y), piece.width + 2 * piece.margin_px,
                         piece.height + 2 * piece.margin_px};
      pieces.push_back(piece);
    }
    x += width;
  }
  return pieces;
}

}  // namespace panorama
