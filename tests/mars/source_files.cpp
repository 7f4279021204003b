#include "tests/mars/source_files.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

namespace source_files {

std::array<double, 6> box(double west, double north, double east, double south, int width, int height) {
  return {west, (east - west) / width, 0, north, 0, (south - north) / height};
}

std::string write(const std::filesystem::path& path, const Raster& raster) {
  GDALAllRegister();
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO");
  CPLStringList options;
  for (const std::string& option : raster.options) options.AddString(option.c_str());
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(raster.driver.c_str());
  auto* dataset =
      driver->Create(path.c_str(), raster.width, raster.height, raster.bands, raster.type, options.List());
  if (dataset == nullptr) throw std::runtime_error("cannot make " + path.string());
  if (!raster.crs.empty()) {
    OGRSpatialReference crs;
    if (crs.SetFromUserInput(raster.crs.c_str()) != OGRERR_NONE)
      throw std::runtime_error("bad CRS " + raster.crs);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    dataset->SetSpatialRef(&crs);
  }
  if (raster.geotransform) {
    auto geotransform = *raster.geotransform;
    dataset->SetGeoTransform(geotransform.data());
  }
  std::vector<double> line(static_cast<std::size_t>(raster.width));
  for (int band = 1; band <= raster.bands; ++band) {
    GDALRasterBand* out = dataset->GetRasterBand(band);
    if (raster.nodata) out->SetNoDataValue(*raster.nodata);
    if (raster.scale) out->SetScale(*raster.scale);
    if (raster.offset) out->SetOffset(*raster.offset);
    if (!raster.unit.empty()) out->SetUnitType(raster.unit.c_str());
    if (!raster.colours.empty()) {
      out->SetColorInterpretation(raster.colours[static_cast<std::size_t>(band - 1)]);
    }
    if (!raster.palette.empty()) {
      GDALColorTable table;
      for (std::size_t i = 0; i < raster.palette.size(); ++i) {
        const auto& c = raster.palette[i];
        const GDALColorEntry entry{c[0], c[1], c[2], c[3]};
        table.SetColorEntry(static_cast<int>(i), &entry);
      }
      out->SetColorTable(&table);
    }
    for (int row = 0; row < raster.height; ++row) {
      for (int column = 0; column < raster.width; ++column) {
        line[static_cast<std::size_t>(column)] = raster.value(band, column, row);
      }
      if (out->RasterIO(GF_Write, 0, row, raster.width, 1, line.data(), raster.width, 1, GDT_Float64, 0, 0,
                        nullptr) != CE_None) {
        throw std::runtime_error("cannot write " + path.string());
      }
    }
  }
  GDALClose(dataset);
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
  return path.string();
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

double height_at(const mars::ElevationSource& source, mars::LonLat place) {
  const glm::dvec3 direction = mars::direction(place);
  double height_m = 0;
  source.sample({&direction, 1}, 1.0, {&height_m, 1});
  return height_m;
}

std::string elevation_error(const std::string& path) {
  try {
    mars::open_elevation(path);
  } catch (const mars::SourceError& error) {
    return error.what();
  }
  return {};
}

Proj::Proj(const std::string& definition)
    : context_(proj_context_create()),
      transformation_(proj_create(static_cast<PJ_CONTEXT*>(context_), definition.c_str())) {
  if (transformation_ == nullptr) throw std::runtime_error("PROJ does not know " + definition);
}

Proj::~Proj() {
  proj_destroy(static_cast<PJ*>(transformation_));
  proj_context_destroy(static_cast<PJ_CONTEXT*>(context_));
}

glm::dvec2 Proj::forward(mars::LonLat place) const {
  const PJ_COORD c = proj_trans(static_cast<PJ*>(transformation_), PJ_FWD,
                                proj_coord(proj_torad(place.lon_deg), proj_torad(place.lat_deg), 0, 0));
  return {c.xy.x, c.xy.y};
}

mars::LonLat Proj::inverse(const glm::dvec2& map) const {
  const PJ_COORD c = proj_trans(static_cast<PJ*>(transformation_), PJ_INV, proj_coord(map.x, map.y, 0, 0));
  return {proj_todeg(c.lp.lam), proj_todeg(c.lp.phi)};
}

}  // namespace source_files
