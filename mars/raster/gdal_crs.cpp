#include "mars/raster/gdal_crs.h"

#include <cpl_string.h>
#include <gdal.h>

#include <cmath>
#include <limits>
#include <memory>

#include "mars/geodesy/sphere.h"

namespace mars {
namespace {

constexpr double kNotProjected = std::numeric_limits<double>::quiet_NaN();

bool contains_ignoring_case(const std::string& text, const char* word) {
  return CPLString(text).ifind(word) != std::string::npos;
}

// Transforms points in place.
void run(GdalPool<OGRCoordinateTransformation>& pool, std::vector<glm::dvec2>& points) {
  const GdalScope scope;
  std::vector<double> x(points.size());
  std::vector<double> y(points.size());
  std::vector<int> good(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    x[i] = points[i].x;
    y[i] = points[i].y;
  }
  const auto transformation = pool.acquire();
  transformation->Transform(static_cast<int>(points.size()), x.data(), y.data(), nullptr, good.data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool usable = good[i] != 0 && std::isfinite(x[i]) && std::isfinite(y[i]);
    points[i] = usable ? glm::dvec2(x[i], y[i]) : glm::dvec2(kNotProjected);
  }
}

}  // namespace

CrsTransformer::CrsTransformer(const std::string& path, const OGRSpatialReference& crs,
                               const std::array<double, 6>& to_map, double lon_shift_deg)
    : target_(crs),
      to_map_(to_map),
      forward_([this] { return make(false); }),
      inverse_([this] { return make(true); }) {
  const GdalScope scope;
  const std::string cannot = "cannot transform its coordinate system '" +
                             (target_.GetName() == nullptr ? "unnamed" : std::string(target_.GetName())) +
                             "' to longitude and latitude";
  const std::string advice =
      "give the file the right one with gdal_edit.py -a_srs, or warp it with gdalwarp -t_srs";
  if (!GDALInvGeoTransform(to_map_.data(), to_pixel_.data())) {
    throw source_error(path, "its geotransform has no inverse", "",
                       "give it one that is not flat, e.g. with gdal_edit.py -a_ullr");
  }
  const std::unique_ptr<OGRSpatialReference> geographic(target_.CloneGeogCS());
  if (!geographic || target_.IsLocal()) throw source_error(path, cannot, scope.message(), advice);
  source_ = *geographic;
  read_axes();
  // PROJ refuses longitudes beyond 10 radians.
  meridian_deg_ += std::remainder(lon_shift_deg, 360.0);
  try {
    forward_.acquire();
    inverse_.acquire();
  } catch (const SourceError& error) {
    throw source_error(path, cannot, error.what(), advice);
  }
}

double CrsTransformer::centric_scale() const {
  const double inverse_flattening = source_.GetInvFlattening();
  if (centric_ || inverse_flattening == 0) return 1;
  const double polar = 1 - 1 / inverse_flattening;
  return polar * polar;
}

double CrsTransformer::central_lon_deg() const {
  for (const char* key : {SRS_PP_CENTRAL_MERIDIAN, SRS_PP_LONGITUDE_OF_CENTER, SRS_PP_LONGITUDE_OF_ORIGIN}) {
    OGRErr error = OGRERR_NONE;
    const double value = target_.GetNormProjParm(key, 0, &error);
    if (error == OGRERR_NONE) return lon_sign_ * value + meridian_deg_;
  }
  return meridian_deg_;
}

void CrsTransformer::forward(std::vector<glm::dvec2>& points) const {
  for (glm::dvec2& p : points) p = {lon_sign_ * (p.x - meridian_deg_) * unit_, p.y * unit_};
  run(forward_, points);
  for (glm::dvec2& p : points) {
    p = {to_pixel_[0] + p.x * to_pixel_[1] + p.y * to_pixel_[2] - 0.5,
         to_pixel_[3] + p.x * to_pixel_[4] + p.y * to_pixel_[5] - 0.5};
  }
}

void CrsTransformer::inverse(std::vector<glm::dvec2>& points) const {
  for (glm::dvec2& p : points) {
    const double column = p.x + 0.5;
    const double row = p.y + 0.5;
    p = {to_map_[0] + column * to_map_[1] + row * to_map_[2],
         to_map_[3] + column * to_map_[4] + row * to_map_[5]};
  }
  run(inverse_, points);
  for (glm::dvec2& p : points) p = {lon_sign_ * p.x / unit_ + meridian_deg_, p.y / unit_};
}

void CrsTransformer::read_axes() {
  // GDAL's traditional axis order does not support axes that point west (planetographic CRSs of the IAU).
  int lon_axis = 2;
  int lat_axis = 1;
  for (int i = 0; i < 2; ++i) {
    OGRAxisOrientation orientation = OAO_Other;
    const char* axis = source_.GetAxis(nullptr, i, &orientation);
    if (orientation == OAO_North || orientation == OAO_South) lat_axis = i + 1;
    if (orientation == OAO_East || orientation == OAO_West) lon_axis = i + 1;
    if (orientation == OAO_West) lon_sign_ = -1;
    if (axis != nullptr && contains_ignoring_case(axis, "planetocentric")) centric_ = true;
  }
  if (lon_axis == lat_axis) return;
  source_.SetDataAxisToSRSAxisMapping({lon_axis, lat_axis});
  unit_ = kRadiansPerDegree / source_.GetAngularUnits();
  if (std::abs(unit_ - 1) < 1e-12) unit_ = 1;
  meridian_deg_ = source_.GetPrimeMeridian();
}

CrsTransformer::Pool::Pointer CrsTransformer::make(bool inverse) const {
  const GdalScope scope;
  Pool::Pointer made(inverse ? OGRCreateCoordinateTransformation(&target_, &source_)
                             : OGRCreateCoordinateTransformation(&source_, &target_),
                     [](OGRCoordinateTransformation* t) {
                       const GdalScope quiet;
                       OGRCoordinateTransformation::DestroyCT(t);
                     });
  if (!made) throw SourceError(scope.message().empty() ? "PROJ has no transformation" : scope.message());
  return made;
}

}  // namespace mars
