#include "mars/raster/output/map_crs.h"

#include <cpl_conv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_crs.h"
#include "mars/raster/iau_crs.h"
#include "vpe/base/number.h"

namespace mars {
namespace {

constexpr double kBodyTolerance = 0.01;

const char* const kCrsAdvice =
    "name one of PROJ for this body, such as IAU_2015:49910, or give a PROJ string: "
    "\"+proj=stere +lat_0=90 +R=3396190\"";

SourceError crs_error(const std::string& text, const std::string& operation, const std::string& words) {
  return source_error("coordinate system '" + text + "'", operation, words, kCrsAdvice);
}

OGRSpatialReference parse_crs(const std::string& text, double radius_m) {
  const GdalScope scope;
  OGRSpatialReference crs;
  // A web address would be fetched.
  const OGRErr parsed =
      crs.SetFromUserInput(text.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get());
  if (parsed != OGRERR_NONE) throw crs_error(text, "PROJ does not know it", scope.message());
  if (!crs.IsGeographic() && !crs.IsProjected())
    throw crs_error(text, "is neither geographic nor projected, so it has no places on a planet", "");
  const double semi_major_m = crs.GetSemiMajor();
  if (!(std::abs(semi_major_m - radius_m) <= kBodyTolerance * radius_m)) {
    throw crs_error(text,
                    "belongs to a body with a radius of " + vpe::base::format_number(semi_major_m) +
                        " m, the planet has " + vpe::base::format_number(radius_m) + " m",
                    "");
  }
  for (int i = 0; i < 2 && crs.IsGeographic(); ++i) {
    OGRAxisOrientation orientation = OAO_Other;
    crs.GetAxis(nullptr, i, &orientation);
    if (orientation == OAO_West)
      throw crs_error(text, "counts longitudes to the west, so its maps are mirrored", "");
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

}  // namespace

struct MapCrs::Parts {
  OGRSpatialReference crs;
  std::unique_ptr<CrsTransformer> transformer;
  double centric_scale = 1;
  double period = 0;     // of x, where it is the same at every latitude; else 0
  double tolerance = 0;  // of coordinates that are the same place of the map

  // Returns whether `back`, the map coordinates of the place at `p`, are `p`, up to turns around the planet.
  bool same_place(glm::dvec2 p, glm::dvec2 back) const {
    double x = back.x - p.x;
    if (period > 0) x = std::remainder(x, period);
    return std::abs(x) <= tolerance && std::abs(back.y - p.y) <= tolerance;
  }
};

namespace {

// Returns the length of a turn around the planet along x, if it is the same at two latitudes; else 0.
double find_period(const CrsTransformer& transformer, double unit_m, double radius_m) {
  constexpr double kAlmostHalf_deg = 170;
  const double middle = transformer.central_lon_deg();
  std::vector<glm::dvec2> ends;
  for (const double lat : {0.0, 50.0}) {
    for (const double lon : {-kAlmostHalf_deg, kAlmostHalf_deg}) ends.emplace_back(middle + lon, lat);
  }
  transformer.forward(ends);
  const double low = ends[1].x - ends[0].x;
  const double high = ends[3].x - ends[2].x;
  const double period = low * 180 / kAlmostHalf_deg;
  const bool steady = std::abs(low - high) <= 1e-9 * std::abs(low) && ends[0].y == ends[1].y;
  return steady && period * unit_m > radius_m ? period : 0;
}

}  // namespace

MapCrs::MapCrs(const std::string& text, double radius_m) : parts_(std::make_unique<Parts>()) {
  parts_->crs = parse_crs(text, radius_m);
  constexpr std::array<double, 6> kMapItself{0, 1, 0, 0, 0, 1};
  const std::string name = "coordinate system '" + text + "'";
  try {
    parts_->transformer = std::make_unique<CrsTransformer>(name, parts_->crs, kMapItself, 0.0);
  } catch (const SourceError&) {
    const GdalScope scope;
    OGRSpatialReference without = parts_->crs;
    if (!remove_iau_codes(without)) throw;
    parts_->transformer = std::make_unique<CrsTransformer>(name, without, kMapItself, 0.0);
  }
  parts_->centric_scale = parts_->transformer->centric_scale();
  parts_->period = find_period(*parts_->transformer, unit_m(), radius_m);
  constexpr double kTolerance_m = 0.001;
  parts_->tolerance = kTolerance_m / unit_m();
}

MapCrs::~MapCrs() = default;

void MapCrs::to_map(std::vector<glm::dvec2>& points) const {
  const double scale = parts_->centric_scale;
  if (scale != 1) {
    for (glm::dvec2& p : points) {
      if (std::abs(p.y) < 90) p.y = std::atan(std::tan(p.y * kRadiansPerDegree) / scale) / kRadiansPerDegree;
    }
  }
  parts_->transformer->forward(points);
  for (glm::dvec2& p : points) p += 0.5;
}

void MapCrs::to_place(std::vector<glm::dvec2>& points) const {
  const std::vector<glm::dvec2> asked = points;
  for (glm::dvec2& p : points) p -= 0.5;
  parts_->transformer->inverse(points);
  // PROJ finds places for coordinates beyond the rim of many maps, too.
  std::vector<glm::dvec2> back = points;
  parts_->transformer->forward(back);
  const double scale = parts_->centric_scale;
  for (std::size_t i = 0; i < points.size(); ++i) {
    glm::dvec2& p = points[i];
    if (std::abs(p.y) < 90 + 1e-9) p.y = std::clamp(p.y, -90.0, 90.0);
    if (!is_valid({p.x, p.y}) || !parts_->same_place(asked[i], back[i] + 0.5)) {
      p = glm::dvec2(std::nan(""));
    } else if (scale != 1 && std::abs(p.y) < 90) {
      p.y = std::atan(std::tan(p.y * kRadiansPerDegree) * scale) / kRadiansPerDegree;
    }
  }
}

bool MapCrs::geographic() const { return parts_->crs.IsGeographic() != 0; }

double MapCrs::unit_m() const {
  return geographic() ? parts_->crs.GetAngularUnits() * parts_->crs.GetSemiMajor()
                      : parts_->crs.GetLinearUnits();
}

double MapCrs::period() const { return parts_->period; }

std::string MapCrs::wkt() const {
  const GdalScope scope;
  char* text = nullptr;
  constexpr const char* const kOptions[] = {"FORMAT=WKT2_2019", nullptr};
  parts_->crs.exportToWkt(&text, kOptions);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

}  // namespace mars
