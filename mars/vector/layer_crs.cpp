#include "mars/vector/layer_crs.h"

#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mars/geodesy/bodies.h"
#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_crs.h"
#include "mars/raster/iau_crs.h"
#include "mars/vector/iau_names.h"
#include "vpe/base/number.h"

namespace mars {
namespace {

constexpr double kRadiusTolerance = 0.01;
constexpr std::size_t kBatch = 1 << 16;

std::string body_text(double radius_m) {
  const Body* body = find_body(radius_m);
  return (body == nullptr ? "a body" : std::string(body->name)) + " (radius " +
         vpe::base::format_rounded(radius_m / 1000, 3) + " km)";
}

bool is_near(double radius_m, double other_m) {
  return std::abs(radius_m - other_m) <= kRadiusTolerance * other_m;
}

// Returns whether the system is WGS 84 in degrees.
bool is_wgs84(const OGRSpatialReference& crs) {
  return crs.IsGeographic() != 0 && std::abs(crs.GetSemiMajor() - SRS_WGS84_SEMIMAJOR) < 0.5 &&
         std::abs(crs.GetInvFlattening() - SRS_WGS84_INVFLATTENING) < 1e-6;
}

struct DegreeAxes {
  int lon = 0;  // from 1; 0: none
  int lat = 0;
  bool counts_west = false;
};

DegreeAxes axes_of(const OGRSpatialReference& crs) {
  DegreeAxes axes;
  for (int i = 0; i < 2; ++i) {
    OGRAxisOrientation orientation = OAO_Other;
    crs.GetAxis(nullptr, i, &orientation);
    if (orientation == OAO_North || orientation == OAO_South) axes.lat = i + 1;
    if (orientation == OAO_East || orientation == OAO_West) axes.lon = i + 1;
    if (orientation == OAO_West) axes.counts_west = true;
  }
  return axes;
}

// Planetocentric systems of an ellipsoid are not geographic to GDAL, but have the axes.
bool has_places(const OGRSpatialReference& crs) {
  if (crs.IsLocal() != 0 || crs.IsGeocentric() != 0) return false;
  const DegreeAxes axes = axes_of(crs);
  return crs.IsProjected() != 0 || (axes.lon != 0 && axes.lat != 0);
}

bool are_latitudes(double low, double high, double quarter) {
  return low >= -quarter * (1 + 1e-9) && high <= quarter * (1 + 1e-9);
}

// Returns whether the first coordinate is the latitude.
bool is_lat_first(const std::string& where, const OGRSpatialReference& crs, const CoordinateRange& range,
                  AxisOrder order) {
  if (order != AxisOrder::by_contents) return order == AxisOrder::lat_first;
  const double quarter = kPi / 2 / crs.GetAngularUnits();
  const bool x = are_latitudes(range.low.x, range.high.x, quarter);
  const bool y = are_latitudes(range.low.y, range.high.y, quarter);
  if (x == y) {
    throw source_error(
        where,
        x ? "its coordinate system counts longitudes to the west, and both of its coordinates may be "
            "latitudes"
          : "neither of its coordinates is a latitude",
        "", "convert it with ogr2ogr -t_srs to a system that counts to the east, such as IAU_2015:49900");
  }
  return x;
}

std::unique_ptr<CrsTransformer> make_transformer(const std::string& where, OGRSpatialReference crs) {
  // Of pixels whose coordinates are those of the map.
  constexpr std::array<double, 6> kMapItself{-0.5, 1, 0, -0.5, 0, 1};
  try {
    return std::make_unique<CrsTransformer>(where, crs, kMapItself, 0.0);
  } catch (const SourceError&) {
    const GdalScope scope;
    if (!remove_iau_codes(crs)) throw;
    return std::make_unique<CrsTransformer>(where, crs, kMapItself, 0.0);
  }
}

}  // namespace

LayerCrs::LayerCrs(const std::string& where, const OGRSpatialReference* crs, double radius_m,
                   const CoordinateRange& range, AxisOrder order) {
  const GdalScope scope;
  if (crs == nullptr || crs->IsEmpty()) return;
  const double semi_major_m = crs->GetSemiMajor();
  const bool is_planets = is_near(semi_major_m, radius_m);
  if (!is_planets && is_wgs84(*crs)) return;
  const char* own = crs->GetName();
  const std::string name = own == nullptr ? "unnamed" : own;
  if (!has_places(*crs)) {
    throw source_error(where, "its coordinate system '" + name + "' has no places on a planet", "",
                       "give it a geographic or projected one with ogr2ogr -a_srs");
  }
  if (!is_planets) {
    throw source_error(where,
                       "its coordinate system '" + name + "' is one of " + body_text(semi_major_m) +
                           ", the planet is " + body_text(radius_m),
                       "", "give a file of this planet, or name its coordinate system with ogr2ogr -a_srs");
  }
  OGRSpatialReference system = with_iau_axes(*crs).value_or(*crs);
  const DegreeAxes axes = axes_of(system);
  if (system.IsProjected() != 0) {
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  } else if (axes.counts_west) {
    const bool lat_first = is_lat_first(where, system, range, order);
    system.SetDataAxisToSRSAxisMapping(lat_first ? std::vector{axes.lat, axes.lon}
                                                 : std::vector{axes.lon, axes.lat});
  } else {
    system.SetDataAxisToSRSAxisMapping({axes.lon, axes.lat});
  }
  transformer_ = make_transformer(where, system);
  centric_scale_ = transformer_->centric_scale();
}

LayerCrs::~LayerCrs() = default;
LayerCrs::LayerCrs(LayerCrs&&) noexcept = default;

void LayerCrs::to_places(std::span<glm::dvec2> points) const {
  if (!transformer_) return;
  std::vector<glm::dvec2> batch;
  for (std::size_t start = 0; start < points.size(); start += kBatch) {
    const auto part = points.subspan(start, std::min(kBatch, points.size() - start));
    batch.assign(part.begin(), part.end());
    transformer_->inverse(batch);
    std::ranges::copy(batch, part.begin());
  }
  if (centric_scale_ == 1) return;
  for (glm::dvec2& p : points) {
    if (std::abs(p.y) < 90)
      p.y = std::atan(std::tan(p.y * kRadiansPerDegree) * centric_scale_) / kRadiansPerDegree;
  }
}

}  // namespace mars
