#include "panorama/stereo_pieces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace panorama {

namespace {

using mars::kPi;
using mars::kRadiansPerDegree;
using vpe::core::StereoLayout;
using vpe::core::View;

double elevation_rad(const PanoramaMap& map, double y) {
  return map.to_direction(0.5, y).elevation_deg * kRadiansPerDegree;
}

double base_at(const EyePair& eyes, double elevation_rad) {
  return faded_base_m(eyes.base_m, elevation_rad / kRadiansPerDegree);
}

double least_range_m(const EyePair& eyes) {
  return eyes.nearest_m ? *eyes.nearest_m - 0.5 * eyes.base_m : std::numeric_limits<double>::infinity();
}

// Returns whether ground at this range keeps its place in a piece of so many columns.
bool fits(const PanoramaMap& map, double base_m, double range_m, double elevation_rad, int columns) {
  const double angle_rad = kPi * (columns - 1) / map.turn_px;
  const double away_m = base_m * std::sin(0.5 * angle_rad);
  const double sine = std::abs(std::sin(elevation_rad));
  const double cosine = std::cos(elevation_rad);
  const double level_m = range_m * cosine - away_m;
  const double free_m = map.kind == MapKind::kCylinder ? level_m : range_m - away_m;
  if (!(level_m > 0 && free_m > 0)) return false;
  const double rows = map.focal_px * (map.kind == MapKind::kCylinder ? sine / cosine : sine) * away_m / free_m;
  const double side_m = 0.5 * base_m * (1.0 - std::cos(angle_rad));
  return rows <= kStereoRowsOff_px && map.turn_px / (2.0 * kPi) * side_m / level_m <= kStereoSideOff_px;
}

int columns_at(const PanoramaMap& map, const EyePair& eyes, double elevation_rad) {
  if (!eyes.nearest_m) return PlanLimits::kTile_px;
  int columns = PlanLimits::kTile_px;
  while (columns > 1 && !fits(map, base_at(eyes, elevation_rad), least_range_m(eyes), elevation_rad, columns))
    columns /= 2;
  return columns;
}

// Returns the round image as seen from an eye's place.
View eye_view(const View& middle, const PanoramaMap& map, Eye eye, double base_m, double azimuth_deg,
              double steepest) {
  View view = middle;
  const mars::Axes& axes = middle.camera.axes;
  // The view's axes point to the middle of the image.
  const mars::SinCos turn = mars::sin_cos_deg(azimuth_deg - (map.turn_azimuth_deg + 180.0));
  const glm::dvec3 forward = turn.cos * axes.forward + turn.sin * axes.right;
  const glm::dvec3 right = turn.cos * axes.right - turn.sin * axes.forward;
  const double aside_m = (eye == Eye::kRight ? 0.5 : -0.5) * base_m;
  view.camera.position_m += aside_m * right;
  const double height_m = glm::length(middle.camera.position_m);
  if (map.turn_px / (2.0 * kPi) * steepest * std::abs(aside_m) / height_m > kStereoTilt_px) return view;
  // Rotates about the line of sight until up points away from the planet's centre.
  const double length = std::hypot(height_m, aside_m);
  const double cosine = height_m / length;
  const double sine = aside_m / length;
  const auto turned = [&](const glm::dvec3& v) {
    return v * cosine + glm::cross(forward, v) * sine + forward * (glm::dot(forward, v) * (1.0 - cosine));
  };
  view.camera.axes = {turned(axes.right), turned(axes.up), turned(axes.forward)};
  return view;
}

// Rounds to three significant digits, without an exponent, for messages.
std::string three_digits(double number) {
  if (!(number > 0)) return vpe::base::format_number(number);
  const double parts = std::pow(10.0, 2.0 - std::floor(std::log10(number)));
  return vpe::base::format_number(std::round(number * parts) / parts);
}

void shift(std::vector<Piece>& pieces, std::int64_t x, std::int64_t y) {
  for (Piece& piece : pieces) {
    piece.x += x;
    piece.y += y;
  }
}

}  // namespace

std::string check(const EyePair& eyes) {
  using vpe::base::format_number;
  if (!(eyes.base_m > 0 && std::isfinite(eyes.base_m)))
    return "eyes " + format_number(eyes.base_m) + " m apart: must be above 0";
  if (!eyes.nearest_m) return {};
  if (!(*eyes.nearest_m > 0 && std::isfinite(*eyes.nearest_m)))
    return "the nearest ground has no range above 0";
  if (eyes.base_m <= kMostBase * *eyes.nearest_m) return {};
  return "eyes " + three_digits(eyes.base_m) + " m apart with ground " + three_digits(*eyes.nearest_m) +
         " m away: at most " + three_digits(kMostBase * *eyes.nearest_m) + " m lets both look at it; " +
         three_digits(*eyes.nearest_m / vpe::core::kNearestToBase) + " m is comfortable";
}

ImageSize size_of_pair(const PanoramaMap& map, StereoLayout layout) {
  return {map.width_px * (layout == StereoLayout::kSideBySide ? 2 : 1),
          map.height_px * (layout == StereoLayout::kOverUnder ? 2 : 1)};
}

std::vector<StereoBand> stereo_bands(const PanoramaMap& map, const EyePair& eyes) {
  struct Row {
    double base_m;
    double cosine;
    int columns;
  };
  const auto row_at = [&](std::int64_t y) {
    const double e = elevation_rad(map, static_cast<double>(y) + 0.5);
    return Row{base_at(eyes, e), std::cos(e), columns_at(map, eyes, e)};
  };
  const double pixels_per_radian = map.turn_px / (2.0 * kPi);
  std::vector<StereoBand> bands;
  for (std::int64_t y = 0; y < map.height_px;) {
    Row row = row_at(y);
    StereoBand band{y, 1, row.columns, row.base_m};
    double least_m = row.base_m;
    double most_m = row.base_m;
    double cosine = row.cosine;
    for (++y; y < map.height_px; ++y, ++band.height) {
      row = row_at(y);
      const bool is_faded = least_m < eyes.base_m || row.base_m < eyes.base_m;
      // Faded bands are low, and their number of columns hardly changes.
      if (!is_faded && row.columns != band.columns) break;
      if (std::int64_t{band.height + 1} * std::min(band.columns, row.columns) > PlanLimits::kPiecePixels) break;
      const double least = std::min(least_m, row.base_m);
      const double most = std::max(most_m, row.base_m);
      const double least_cosine = std::min(cosine, row.cosine);
      // Each end differs from the band's base by half of the range, and an eye is half a base from the middle.
      if (pixels_per_radian * 0.25 * (most - least) / (least_range_m(eyes) * least_cosine) > kStereoFadeOff_px)
        break;
      least_m = least;
      most_m = most;
      cosine = least_cosine;
      band.columns = std::min(band.columns, row.columns);
    }
    band.base_m = 0.5 * (least_m + most_m);
    bands.push_back(band);
  }
  return bands;
}

std::vector<Piece> eye_pieces_of(const PanoramaMap& map, const Viewpoint& viewpoint,
                                 const std::vector<StereoBand>& bands, Eye eye, const Strip& strip) {
  const View middle = round_view(map, viewpoint);
  const auto crop_px = static_cast<std::int64_t>(map.crop_left_px);
  const auto turn_px = static_cast<std::int64_t>(map.turn_px);
  const std::int64_t end = strip.x + strip.width;
  std::vector<Piece> pieces;
  for (const StereoBand& band : bands) {
    const double steepest =
        std::max(std::abs(std::tan(elevation_rad(map, static_cast<double>(band.y) + 0.5))),
                 std::abs(std::tan(elevation_rad(map, static_cast<double>(band.y + band.height) - 0.5))));
    for (std::int64_t x = strip.x; x < end;) {
      const std::int64_t column = (x + crop_px) % turn_px;
      // The cell, counted from the image's edge or from t = 0, decides the eye; the strip may have a
      // part of it.
      const std::int64_t cell = x - std::min(x % band.columns, column);
      const std::int64_t cell_end =
          std::min({x - x % band.columns + band.columns, x + turn_px - column, map.width_px});
      const std::int64_t width = std::min(end, cell_end) - x;
      const double middle_px = static_cast<double>(column) + 0.5 * static_cast<double>(cell + cell_end - 2 * x);
      const double azimuth_deg = map.turn_azimuth_deg + 360.0 * middle_px / map.turn_px;
      Piece piece;
      piece.x = x;
      piece.y = band.y;
      piece.width = static_cast<int>(width);
      piece.height = band.height;
      piece.view = eye_view(middle, map, eye, band.base_m, azimuth_deg, steepest);
      piece.view.part = {static_cast<int>(column), static_cast<int>(band.y), piece.width, piece.height};
      pieces.push_back(piece);
      x += width;
    }
  }
  return pieces;
}

std::vector<Piece> pair_pieces_of(const PanoramaMap& map, const Viewpoint& viewpoint, const EyePair& eyes,
                                  const Strip& strip) {
  const std::vector<StereoBand> bands = stereo_bands(map, eyes);
  std::vector<Piece> pieces;
  for (const Eye eye : {Eye::kLeft, Eye::kRight}) {
    const bool is_right = eye == Eye::kRight;
    const std::int64_t right = is_right && eyes.layout == StereoLayout::kSideBySide ? map.width_px : 0;
    const std::int64_t down = is_right && eyes.layout == StereoLayout::kOverUnder ? map.height_px : 0;
    const std::int64_t begin = std::max<std::int64_t>(0, strip.x - right);
    const std::int64_t end = std::min(map.width_px, strip.x + strip.width - right);
    if (begin >= end) continue;
    std::vector<Piece> of_eye =
        eye_pieces_of(map, viewpoint, bands, eye, {begin, static_cast<int>(end - begin)});
    shift(of_eye, right, down);
    pieces.insert(pieces.end(), of_eye.begin(), of_eye.end());
  }
  return pieces;
}

}  // namespace panorama
