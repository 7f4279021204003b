#include "mars/raster/gdal_georeference.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/geodesy/angles.h"
#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/gdal_crs.h"
#include "mars/raster/gdal_file.h"
#include "mars/raster/iau_crs.h"

namespace mars {
namespace {

constexpr double kNotOnPlanet = std::numeric_limits<double>::quiet_NaN();

// Makes directions of places in a CRS. Keeps the last latitude, which the pixels of a row share.
class CrsDirections {
 public:
  explicit CrsDirections(double centric_scale) : centric_scale_(centric_scale) {}

  glm::dvec3 operator()(glm::dvec2 p) {
    // Rounding may carry the edge of a map over the pole.
    if (std::abs(p.y) < 90 + 1e-9) p.y = std::clamp(p.y, -90.0, 90.0);
    if (!is_valid({p.x, p.y})) return glm::dvec3(kNotOnPlanet);
    if (p.y != lat_deg_) lat_ = sin_cos_deg(lat_deg_ = p.y);
    const SinCos lon = sin_cos_deg(p.x);
    const glm::dvec3 d(lat_.cos * lon.cos, lat_.cos * lon.sin, lat_.sin);  // direction()
    return centric_scale_ == 1.0 ? d : glm::normalize(glm::dvec3(d.x, d.y, d.z * centric_scale_));
  }

 private:
  double centric_scale_;
  double lat_deg_ = 0;
  SinCos lat_ = sin_cos_deg(0);
};

const char* const kNoGeoreference =
    "give it one, e.g. gdal_translate -a_srs IAU_2015:CODE -a_ullr WEST NORTH EAST SOUTH IN OUT.tif, where CODE is "
    "that of its body: 49900 for Mars, 30100 for the Moon";

}  // namespace

Georeference::Georeference(const std::string& path, GDALDataset& dataset, const LabelGeoreference& label) {
  const GdalScope scope;
  grid_.width = dataset.GetRasterXSize();
  grid_.height = dataset.GetRasterYSize();
  std::array<double, 6> to_map{};
  if (label.to_map) {
    to_map = *label.to_map;
  } else if (dataset.GetGeoTransform(to_map.data()) != CE_None) {
    const std::string sibling = sibling_advice(path);
    throw source_error(path, "has no georeference, no control points and no RPC", "",
                       sibling.empty() ? kNoGeoreference : sibling + ", or " + kNoGeoreference);
  }
  OGRSpatialReference crs;
  if (!label.crs.empty()) {
    if (crs.SetFromUserInput(label.crs.c_str()) != OGRERR_NONE) {
      throw source_error(path, "PROJ does not support the map of its label", scope.message(),
                         "check the label's IMAGE_MAP_PROJECTION");
    }
  } else if (dataset.GetSpatialRef() != nullptr) {
    crs = *dataset.GetSpatialRef();
  }
  if (crs.IsEmpty()) {
    throw source_error(
        path, "has a geotransform but no coordinate system", "",
        "name that of its body with gdal_edit.py -a_srs IAU_2015:CODE FILE: 49900 for Mars, 30100 for "
        "the Moon");
  }
  if (auto restored = restored_iau_crs(crs)) crs = *restored;
  if (!correct_axis_order(crs, to_map, grid_)) {
    const bool lat_first = crs.GetDataAxisToSRSAxisMapping()[0] == 1;
    note_ = std::string("both axes of its map may be latitudes; its columns are taken to run along the ") +
            (lat_first ? "latitude" : "longitude, which counts west") +
            " (gdalwarp -t_srs IAU_2015:CODE of a " + "planetocentric system makes it plain)";
  }
  try {
    transformer_ = std::make_unique<CrsTransformer>(path, crs, to_map, label.lon_shift_deg);
  } catch (const SourceError&) {
    if (!remove_iau_codes(crs)) throw;
    transformer_ = std::make_unique<CrsTransformer>(path, crs, to_map, label.lon_shift_deg);
  }
  centric_scale_ = label.centric_scale.value_or(transformer_->centric_scale());

  const double to_m = crs.IsGeographic() || !crs.IsProjected()
                          ? crs.GetAngularUnits() * transformer_->semi_major_m()
                          : crs.GetLinearUnits();
  resolution_m_ = std::min(std::hypot(to_map[1], to_map[4]), std::hypot(to_map[2], to_map[5])) * to_m;

  if (label.grid) {
    const DegreeGrid& g = *label.grid;
    linear_ = Linear{{-g.west_deg * g.pixels_per_degree - 0.5, g.north_deg * g.pixels_per_degree - 0.5},
                     {g.pixels_per_degree, 0},
                     {0, -g.pixels_per_degree}};
  } else {
    find_linear();
  }
  find_wrap();
  if (linear_ && grid_.period == 0) {
    const Linear& m = *linear_;
    const glm::dvec2 p = glm::dvec2(grid_.width - 1, grid_.height - 1) / 2.0 - m.origin;
    const double area = m.per_lon.x * m.per_lat.y - m.per_lat.x * m.per_lon.y;
    middle_lon_deg_ = (p.x * m.per_lat.y - p.y * m.per_lat.x) / area;
  }
}

Georeference::~Georeference() = default;
Georeference::Georeference(Georeference&&) noexcept = default;

void Georeference::find_linear() {
  const double middle = transformer_->central_lon_deg();
  constexpr double kStep_deg = 64;
  std::vector<glm::dvec2> base{{middle, 0}, {middle + kStep_deg, 0}, {middle, kStep_deg}};
  transformer_->forward(base);
  Linear linear{base[0], (base[1] - base[0]) / kStep_deg, (base[2] - base[0]) / kStep_deg};
  // Rounding of large map coordinates leaves small terms that must not be taken for a rotation.
  for (glm::dvec2* slope : {&linear.per_lon, &linear.per_lat}) {
    for (int i = 0; i < 2; ++i) {
      if (std::abs((*slope)[i]) * 360 < kLinearError_px / 4) (*slope)[i] = 0;
    }
  }
  linear.origin -= linear.per_lon * middle;

  std::vector<glm::dvec2> places;
  for (int lon = -175; lon <= 175; lon += 25) {
    for (int lat = -88; lat <= 88; lat += 22) places.emplace_back(middle + lon, lat);
  }
  std::vector<glm::dvec2> pixels = places;
  transformer_->forward(pixels);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 p = linear.origin + linear.per_lon * places[i].x + linear.per_lat * places[i].y;
    const glm::dvec2 off = glm::abs(p - pixels[i]);
    if (!(off.x <= kLinearError_px && off.y <= kLinearError_px)) return;
  }
  linear_ = linear;
}

glm::dvec2 Georeference::pixel_at(double lon_deg, double lat_deg) const {
  if (linear_) return linear_->origin + linear_->per_lon * lon_deg + linear_->per_lat * lat_deg;
  std::vector<glm::dvec2> p{{lon_deg, lat_deg}};
  transformer_->forward(p);
  return p[0];
}

void Georeference::find_wrap() {
  // True for any cylindrical map in normal aspect: columns are linear in longitude, rows depend on latitude
  // alone.
  const double middle = linear_ ? 0.0 : transformer_->central_lon_deg();
  const double per_degree = (pixel_at(middle + 64, 0).x - pixel_at(middle, 0).x) / 64;
  for (const double lat : {-60.0, 0.0, 60.0}) {
    const glm::dvec2 centre = pixel_at(middle, lat);
    for (const double lon : {-170.0, -50.0, 70.0, 170.0}) {
      const glm::dvec2 off = pixel_at(middle + lon, lat) - centre - glm::dvec2(per_degree * lon, 0);
      if (!(std::abs(off.x) < 1e-4 && std::abs(off.y) < 1e-4)) return;
    }
    if (!(std::abs(centre.x - pixel_at(middle, 0).x) < 1e-4)) return;
  }
  grid_.period = std::abs(per_degree) * 360;
  if (std::abs(grid_.period - std::round(grid_.period)) < 1e-4) grid_.period = std::round(grid_.period);
  grid_.wraps = grid_.period > 0 && grid_.period - (grid_.width - 1) <= 1.5 && grid_.width > 1;
  if (!grid_.wraps) return;

  const double north = pixel_at(middle, 90).y;
  const double south = pixel_at(middle, -90).y;
  const double first = std::min(north, south);
  const double last = std::max(north, south);
  // A raster that ends a whole pixel before a pole does not include it.
  if (first >= -1 && first < grid_.height - 1) grid_.first_pole_row = first;
  if (last <= grid_.height && last > 0 && last > first) grid_.last_pole_row = last;
}

void Georeference::to_pixels(std::span<const glm::dvec3> directions, std::span<glm::dvec2> pixels) const {
  if (!linear_) {
    to_pixels_by_proj(directions, pixels);
    return;
  }
  const Linear m = *linear_;
  lon_lat_deg(directions, centric_scale_, pixels);  // of the kind that the CRS uses
  for (std::size_t i = 0; i < directions.size(); ++i) {
    glm::dvec2 p = pixels[i];
    if (middle_lon_deg_) p.x = *middle_lon_deg_ + std::remainder(p.x - *middle_lon_deg_, 360.0);
    pixels[i] = m.origin + m.per_lon * p.x + m.per_lat * p.y;
  }
}

void Georeference::to_pixels_by_proj(std::span<const glm::dvec3> directions,
                                     std::span<glm::dvec2> pixels) const {
  std::vector<glm::dvec2> points(directions.size());
  lon_lat_deg(directions, centric_scale_, points);
  transformer_->forward(points);
  std::copy(points.begin(), points.end(), pixels.begin());
}

void Georeference::to_directions(std::span<const glm::dvec2> pixels, std::span<glm::dvec3> directions) const {
  CrsDirections crs_direction(centric_scale_);
  if (linear_) {
    const Linear& m = *linear_;
    const double area = m.per_lon.x * m.per_lat.y - m.per_lat.x * m.per_lon.y;
    const bool upright = m.per_lat.x == 0 && m.per_lon.y == 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const glm::dvec2 p = pixels[i] - m.origin;
      const glm::dvec2 place =
          upright
              ? glm::dvec2(p.x / m.per_lon.x, p.y / m.per_lat.y)
              : glm::dvec2(p.x * m.per_lat.y - p.y * m.per_lat.x, p.y * m.per_lon.x - p.x * m.per_lon.y) / area;
      directions[i] = crs_direction(place);
    }
    return;
  }
  std::vector<glm::dvec2> places(pixels.begin(), pixels.end());
  transformer_->inverse(places);
  // PROJ's inverse also returns places for pixels outside the outline of some projections. Only places that map
  // back to their pixels are on the planet.
  std::vector<glm::dvec2> back = places;
  transformer_->forward(back);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const glm::dvec2 off = glm::abs(back[i] - pixels[i]);
    const bool on_planet = off.x < 1e-2 && off.y < 1e-2;
    directions[i] = on_planet ? crs_direction(places[i]) : glm::dvec3(kNotOnPlanet);
  }
}

}  // namespace mars
