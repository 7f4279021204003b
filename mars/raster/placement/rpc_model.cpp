#include "mars/raster/placement/rpc_model.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/bodies.h"
#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/placement/ground_grid.h"
#include "mars/raster/placement/memory_file.h"
#include "mars/sources/source.h"
#include "mars/sources/source_checks.h"
#include "vpe/base/number.h"

namespace mars {
namespace {

constexpr float kNoHeight_m = -1e9F;
constexpr double kDemMargin = 0.1;  // of the box of the raster, on each side
constexpr int kBoxSide = 11;        // places along a side of the raster that give its box

// Names of the values, and how many numbers each has.
constexpr std::array<std::pair<const char*, int>, 14> kRpcValues{{{"LINE_OFF", 1},
                                                                  {"SAMP_OFF", 1},
                                                                  {"LAT_OFF", 1},
                                                                  {"LONG_OFF", 1},
                                                                  {"HEIGHT_OFF", 1},
                                                                  {"LINE_SCALE", 1},
                                                                  {"SAMP_SCALE", 1},
                                                                  {"LAT_SCALE", 1},
                                                                  {"LONG_SCALE", 1},
                                                                  {"HEIGHT_SCALE", 1},
                                                                  {"LINE_NUM_COEFF", 20},
                                                                  {"LINE_DEN_COEFF", 20},
                                                                  {"SAMP_NUM_COEFF", 20},
                                                                  {"SAMP_DEN_COEFF", 20}}};

// Returns the values of the RPC as GDAL's transformer reads them. Units and other keys are left out.
CPLStringList checked_values(const std::string& path, GDALDataset& dataset) {
  CPLStringList checked;
  for (const auto& [key, count] : kRpcValues) {
    const char* text = dataset.GetMetadataItem(key, "RPC");
    const CPLStringList words(CSLTokenizeString2(text != nullptr ? text : "", " ,\t\r\n", 0));
    std::string numbers;
    int found = 0;
    bool is_zero = true;
    for (int i = 0; i < words.size() && found < count; ++i) {
      char* end = nullptr;
      const double value = CPLStrtod(words[i], &end);
      if (end == words[i] || *end != '\0' || !std::isfinite(value)) break;
      numbers += (found++ == 0 ? "" : " ") + vpe::base::format_shortest(value);
      is_zero = is_zero && value == 0;
    }
    const std::string name = key;
    if (found < count || (is_zero && (name.ends_with("_SCALE") || name.ends_with("_DEN_COEFF")))) {
      throw source_error(path, "its RPC has no usable " + name, text != nullptr ? text : "",
                         "check it with gdalinfo; it must have " +
                             (count == 1 ? std::string("one number") : std::to_string(count) + " numbers"));
    }
    checked.SetNameValue(key, numbers.c_str());
  }
  return checked;
}

// Returns k in: tan(planetocentric latitude) = k tan(latitude of the system).
double centric_scale_of(const OGRSpatialReference& crs) {
  const double inverse_flattening = crs.GetInvFlattening();
  for (int i = 0; i < 2; ++i) {
    const char* axis = crs.GetAxis(nullptr, i, nullptr);
    if (axis != nullptr && CPLString(axis).ifind("planetocentric") != std::string::npos) return 1;
  }
  if (inverse_flattening == 0) return 1;
  const double polar = 1 - 1 / inverse_flattening;
  return polar * polar;
}

OGRSpatialReference default_system(const std::string& path, double body_radius_m, RpcModel& model) {
  OGRSpatialReference crs;
  const double radius_m = body_radius_m > 0 ? body_radius_m : kMarsRadius_m;
  const Body* body = find_body(radius_m);
  const bool is_earth = body != nullptr && body->name == "Earth";
  const std::string text =
      is_earth ? "EPSG:4326" : "+proj=longlat +R=" + vpe::base::format_number(radius_m) + " +no_defs";
  if (crs.SetFromUserInput(text.c_str()) != OGRERR_NONE)
    throw source_error(path, "PROJ does not know '" + text + "'", GdalScope::last_message(), "give --rpc-crs");
  if (!is_earth) {
    model.notes.push_back(
        "its RPC names no body; its places are taken for planetocentric degrees on a sphere of " +
        vpe::base::format_number(radius_m) + " m (--rpc-crs names another system)");
  }
  return crs;
}

OGRSpatialReference system_of(const std::string& path, GDALDataset& dataset, const PlacementOptions& options,
                              RpcModel& model) {
  OGRSpatialReference crs;
  const char* const advice =
      "give a geographic one that counts longitudes to the east, such as --rpc-crs IAU_2015:49900";
  const std::string what =
      options.rpc_crs.empty() ? "its coordinate system" : "--rpc-crs '" + options.rpc_crs + "'";
  if (!options.rpc_crs.empty()) {
    if (crs.SetFromUserInput(options.rpc_crs.c_str()) != OGRERR_NONE)
      throw source_error(path, "PROJ does not know " + what, GdalScope::last_message(), advice);
  } else if (const OGRSpatialReference* own = dataset.GetSpatialRef(); own != nullptr && !own->IsEmpty()) {
    crs = *own;
  } else {
    crs = default_system(path, options.body_radius_m, model);
  }
  if (crs.IsGeographic() == 0) throw source_error(path, what + " is not geographic", "", advice);
  for (int i = 0; i < 2; ++i) {
    OGRAxisOrientation orientation = OAO_Other;
    crs.GetAxis(nullptr, i, &orientation);
    if (orientation == OAO_West) throw source_error(path, what + " counts longitudes to the west", "", advice);
  }
  if (std::abs(crs.GetAngularUnits() / kRadiansPerDegree - 1) > 1e-9)
    throw source_error(path, what + " does not count in degrees", "", advice);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

struct DegreeBox {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};
};

// Returns where the raster lies at the heights that its RPC is made for.
DegreeBox box_on_ground(const std::string& path, GDALDataset& dataset) {
  DegreeBox box;
  const double offset_m = CPLAtof(dataset.GetMetadataItem("HEIGHT_OFF", "RPC"));
  const double scale_m = CPLAtof(dataset.GetMetadataItem("HEIGHT_SCALE", "RPC"));
  for (const double height_m : {offset_m - scale_m, offset_m, offset_m + scale_m}) {
    const PixelMapper mapper(path, dataset,
                             {"METHOD=RPC", "RPC_HEIGHT=" + vpe::base::format_shortest(height_m)});
    std::vector<glm::dvec2> places;
    for (int row = 0; row < kBoxSide; ++row) {
      for (int column = 0; column < kBoxSide; ++column)
        places.push_back(glm::dvec2(column, row) / (kBoxSide - 1.0) *
                         glm::dvec2(dataset.GetRasterXSize(), dataset.GetRasterYSize()));
    }
    mapper.to_ground(places);
    for (const glm::dvec2& p : places) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      box.low = glm::min(box.low, p);
      box.high = glm::max(box.high, p);
    }
  }
  if (!(box.low.x < box.high.x && box.low.y < box.high.y)) {
    throw source_error(path, "its RPC places it nowhere", GdalScope::last_message(),
                       "check its coefficients with gdalinfo");
  }
  const glm::dvec2 margin = (box.high - box.low) * kDemMargin;
  return {glm::max(box.low - margin, glm::dvec2(-720, -90)), glm::min(box.high + margin, glm::dvec2(720, 90))};
}

void check_dem(const std::string& path, const SourceInfo& info, const OGRSpatialReference& crs,
               RpcModel& model) {
  check_body(info, crs.GetSemiMajor());
  if (info.datum.kind == DatumKind::kRadius) {
    throw source_error(info.name, "holds radii, but as --rpc-dem of " + path + " it must hold heights", "",
                       "subtract the radius of the RPC's surface first, e.g. with gdal_calc.py");
  }
  if (info.datum.kind == DatumKind::kAreoid) {
    model.notes.push_back(
        "heights of " + info.name +
        " count from the areoid, those of an RPC from its ellipsoid; the ground is displaced where "
        "both differ");
  }
}

// Writes the heights of a DEM over the raster, in degrees of the RPC. GDAL would transform them from WGS 84.
void add_dem(const std::string& path, GDALDataset& dataset, const std::string& dem_path, RpcModel& model) {
  const std::shared_ptr<const ElevationSource> source = open_elevation(dem_path);
  const SourceInfo info = source->infos().front();
  check_dem(path, info, model.crs, model);
  const DegreeBox box = box_on_ground(path, dataset);
  const glm::dvec2 extent = box.high - box.low;
  const GroundUnits units(model.crs, std::array{box.low, box.high});
  const glm::dvec2 metres = units.metres((box.low + box.high) / 2.0);
  const double area_m2 = extent.x * metres.x * extent.y * metres.y;
  const double spacing_m = std::max(info.resolution_m, std::sqrt(area_m2 / kMostRpcPosts));
  const glm::dvec2 size = glm::clamp(glm::ceil(extent * metres / spacing_m), 2.0, kMostRpcPosts);
  const glm::dvec2 step = extent / size;
  const int columns = static_cast<int>(size.x);
  const int rows = static_cast<int>(size.y);

  model.dem = std::make_shared<const MemoryFile>("tif");
  model.dem_name = info.name;
  for (const SourceInfo& each : source->infos())
    for (const FileStamp& file : each.files) model.dem_files.push_back(file.path);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> out(
      driver->Create(model.dem->name().c_str(), columns, rows, 1, GDT_Float32, nullptr));
  const auto cannot = [&] {
    return source_error(dem_path, "cannot keep its heights in memory for " + path, GdalScope::last_message(),
                        "give a coarser one");
  };
  if (!out) throw cannot();
  std::array<double, 6> to_map{box.low.x, step.x, 0, box.high.y, 0, -step.y};
  OGRSpatialReference degrees;
  degrees.importFromEPSG(4326);
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  out->SetGeoTransform(to_map.data());
  out->SetSpatialRef(&degrees);
  out->GetRasterBand(1)->SetNoDataValue(double{kNoHeight_m});

  const double k = centric_scale_of(model.crs);
  std::vector<glm::dvec3> directions(static_cast<std::size_t>(columns));
  std::vector<double> heights_m(directions.size());
  std::vector<float> line(directions.size());
  bool has_height = false;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const glm::dvec3 d = direction({box.low.x + (column + 0.5) * step.x, box.high.y - (row + 0.5) * step.y});
      directions[static_cast<std::size_t>(column)] = glm::normalize(glm::dvec3(d.x, d.y, d.z * k));
    }
    source->sample(directions, spacing_m, heights_m);
    for (std::size_t i = 0; i < line.size(); ++i) {
      const bool is_height = std::isfinite(heights_m[i]);
      line[i] = is_height ? static_cast<float>(heights_m[i]) : kNoHeight_m;
      has_height = has_height || is_height;
    }
    if (out->GetRasterBand(1)->RasterIO(GF_Write, 0, row, columns, 1, line.data(), columns, 1, GDT_Float32, 0,
                                        0, nullptr) != CE_None) {
      throw cannot();
    }
  }
  if (!has_height) {
    throw source_error(dem_path, "as --rpc-dem of " + path + " it has no height where that lies", "",
                       "give one that covers it, or --rpc-height");
  }
}

}  // namespace

std::vector<std::string> RpcModel::transformer_options() const {
  if (dem) return {"METHOD=RPC", "RPC_DEM=" + dem->name()};
  return {"METHOD=RPC", "RPC_HEIGHT=" + vpe::base::format_shortest(height_m)};
}

std::string RpcModel::treatment() const {
  if (dem) return "placed by its RPC on the heights of " + std::filesystem::path(dem_name).filename().string();
  return "placed by its RPC at a height of " + vpe::base::format_shortest(height_m) + " m";
}

RpcModel rpc_model(const std::string& path, GDALDataset& dataset, const PlacementOptions& options) {
  RpcModel model;
  const CPLStringList values = checked_values(path, dataset);
  for (int i = 0; i < values.size(); ++i) model.metadata.emplace_back(values[i]);
  model.crs = system_of(path, dataset, options, model);
  if (options.rpc_height_m && !options.rpc_dem.empty()) {
    throw source_error(path, "has both --rpc-height and --rpc-dem", "", "give one of them");
  }
  const double own_m = CPLAtof(values.FetchNameValue("HEIGHT_OFF"));
  model.height_m = options.rpc_height_m.value_or(own_m);
  if (!options.rpc_dem.empty()) {
    add_dem(path, dataset, options.rpc_dem, model);
    model.notes.insert(model.notes.begin(), "placed by its RPC on the heights of " + model.dem_name);
    return model;
  }
  model.notes.insert(model.notes.begin(),
                     "placed by its RPC at a height of " + vpe::base::format_general(model.height_m, 6) + " m" +
                         (options.rpc_height_m ? "" : ", its own mean height (--rpc-height, --rpc-dem)"));
  return model;
}

}  // namespace mars
