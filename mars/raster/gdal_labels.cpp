#include "mars/raster/gdal_labels.h"

#include <cpl_conv.h>
#include <cpl_json.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/isis_map.h"
#include "mars/raster/pds_image.h"
#include "mars/raster/pds_map.h"

namespace mars {
namespace {

// Describes how a label counts longitudes and latitudes.
struct Counting {
  bool west = false;
  bool graphic = false;
  double centre_lon_deg = 0;   // as counted by the label
  double a = 0, b = 0, c = 0;  // axes of the body, all in one unit
};

std::string driver_of(GDALDataset& dataset) {
  GDALDriver* driver = dataset.GetDriver();
  return driver == nullptr ? "" : GDALGetDriverShortName(driver);
}

std::string first_metadata(GDALDataset& dataset, const char* domain) {
  char** lines = dataset.GetMetadata(domain);
  return lines == nullptr || lines[0] == nullptr ? "" : lines[0];
}

bool same(const std::string& a, const char* b) { return EQUAL(a.c_str(), b); }

double number_of(const CPLJSONObject& object, const char* key) {
  const CPLJSONObject found = object.GetObj(key);
  if (found.GetType() == CPLJSONObject::Type::Object) return found.GetDouble("value", 0);
  if (found.GetType() == CPLJSONObject::Type::String) return CPLAtof(found.ToString().c_str());
  return found.IsValid() ? found.ToDouble(0) : 0;
}

std::optional<IsisMapping> isis3_mapping(GDALDataset& dataset) {
  CPLJSONDocument document;
  if (!document.LoadMemory(first_metadata(dataset, "json:ISIS3"))) return std::nullopt;
  const CPLJSONObject group = document.GetRoot().GetObj("IsisCube/Mapping");
  if (!group.IsValid()) return std::nullopt;
  IsisMapping mapping;
  mapping.projection = group.GetString("ProjectionName");
  mapping.west_positive = same(group.GetString("LongitudeDirection"), "PositiveWest");
  mapping.planetographic = same(group.GetString("LatitudeType"), "Planetographic");
  mapping.equatorial_radius_m = number_of(group, "EquatorialRadius");
  mapping.polar_radius_m = number_of(group, "PolarRadius");
  mapping.centre_lon_deg = number_of(group, "CenterLongitude");
  mapping.centre_lat_deg = number_of(group, "CenterLatitude");
  const auto optional = [&](const char* key) -> std::optional<double> {
    if (!group.GetObj(key).IsValid()) return std::nullopt;
    return number_of(group, key);
  };
  mapping.first_parallel_deg = optional("FirstStandardParallel");
  mapping.second_parallel_deg = optional("SecondStandardParallel");
  mapping.scale_factor = optional("ScaleFactor").value_or(1.0);
  return mapping;
}

Counting vicar_counting(GDALDataset& dataset) {
  Counting counting;
  CPLJSONDocument document;
  if (!document.LoadMemory(first_metadata(dataset, "json:VICAR"))) return counting;
  const CPLJSONObject map = document.GetRoot().GetObj("PROPERTY/MAP");
  if (!map.IsValid()) return counting;
  counting.west = same(map.GetString("POSITIVE_LONGITUDE_DIRECTION"), "WEST");
  counting.graphic = same(map.GetString("COORDINATE_SYSTEM_NAME"), "PLANETOGRAPHIC");
  counting.centre_lon_deg = number_of(map, "CENTER_LONGITUDE");
  counting.a = number_of(map, "A_AXIS_RADIUS");
  counting.b = number_of(map, "B_AXIS_RADIUS");
  counting.c = number_of(map, "C_AXIS_RADIUS");
  return counting;
}

Counting pds4_counting(GDALDataset& dataset) {
  Counting counting;
  const std::string text = first_metadata(dataset, "xml:PDS4");
  CPLXMLNode* root = CPLParseXMLString(text.c_str());
  if (root == nullptr) return counting;
  CPLStripXMLNamespace(root, nullptr, TRUE);
  const auto value = [&](const char* key) -> std::string {
    CPLXMLNode* node = CPLSearchXMLNode(root, (std::string("=") + key).c_str());
    return node == nullptr ? "" : CPLGetXMLValue(node, "", "");
  };
  // GDAL reads longitudes that count west correctly here.
  counting.graphic = same(value("latitude_type"), "Planetographic");
  const auto axis = [&](const char* now, const char* before) {
    const std::string found = value(now);
    return CPLAtof((found.empty() ? value(before) : found).c_str());
  };
  counting.a = axis("a_axis_radius", "semi_major_radius");
  counting.b = axis("b_axis_radius", "semi_minor_radius");
  counting.c = axis("c_axis_radius", "polar_radius");
  CPLDestroyXMLNode(root);
  return counting;
}

Counting isis2_counting(const std::string& path) {
  Counting counting;
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (file == nullptr) return counting;
  std::string text(std::size_t{1} << 16, '\0');
  text.resize(VSIFReadL(text.data(), 1, text.size(), file));
  VSIFCloseL(file);
  const PdsLabel label = parse_pds_label(text);
  const PdsPlacement placement = pds_placement(label);
  const auto number = [&](const char* key) {
    return label.number(std::string("IMAGE_MAP_PROJECTION.") + key).value_or(0.0);
  };
  counting.west = placement.west_positive;
  counting.graphic = placement.planetographic;
  counting.centre_lon_deg = number("CENTER_LONGITUDE");
  counting.a = number("A_AXIS_RADIUS");
  counting.b = number("B_AXIS_RADIUS");
  counting.c = number("C_AXIS_RADIUS");
  return counting;
}

Counting counting_of(const std::string& path, GDALDataset& dataset) {
  const std::string driver = driver_of(dataset);
  if (driver == "ISIS2") return isis2_counting(path);
  if (driver == "VICAR") return vicar_counting(dataset);
  if (driver == "PDS4") return pds4_counting(dataset);
  return {};
}

}  // namespace

bool NodataValues::has(double stored) const {
  return stored <= at_most || stored >= at_least ||
         std::find(values.begin(), values.end(), stored) != values.end();
}

bool stores_signed_bytes(GDALRasterBand& band) {
  const char* type = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  return band.GetRasterDataType() == GDT_Byte && type != nullptr && EQUAL(type, "SIGNEDBYTE");
}

NodataValues nodata_values(GDALDataset& dataset, const std::optional<PdsLabel>& label) {
  NodataValues nodata;
  if (label) nodata.values = pds_nodata(*label);
  const std::string driver = driver_of(dataset);
  if (driver != "ISIS3" && driver != "ISIS2") return nodata;
  switch (dataset.GetRasterBand(1)->GetRasterDataType()) {
    case GDT_Byte: nodata.values = {0, 255}; break;
    case GDT_Int16: nodata.at_most = -32764; break;
    case GDT_UInt16:
      nodata.at_most = 2;
      nodata.at_least = 65534;
      break;
    case GDT_UInt32:
      nodata.at_most = 2;
      nodata.at_least = 4294967294.0;
      break;
    case GDT_Int32: nodata.values = {-8388614, -8388613, -8388612, -8388611, -8388610}; break;
    default: break;  // floating point: recognised by their magnitude
  }
  return nodata;
}

LabelGeoreference label_georeference(const std::string& path, GDALDataset& dataset) {
  LabelGeoreference georeference;
  if (driver_of(dataset) == "ISIS3") {
    const auto mapping = isis3_mapping(dataset);
    if (!mapping) return georeference;
    if (auto by_label = isis_map(*mapping)) return *by_label;
    if (!mapping->west_positive) return georeference;
    if (mapping->projection == "ObliqueCylindrical") {
      throw source_error(path, "its label counts longitudes to the west in an unsupported projection",
                         mapping->projection, "map it to PositiveEast longitudes first, with ISIS");
    }
    georeference.lon_shift_deg = -2 * mapping->centre_lon_deg;
    return georeference;
  }
  const Counting counting = counting_of(path, dataset);
  if (counting.west) georeference.lon_shift_deg = -2 * counting.centre_lon_deg;
  if (!counting.graphic || !(counting.a > 0) || !(counting.c > 0)) return georeference;
  if (counting.b > 0 && counting.a != counting.b) {
    throw source_error(path, "its latitudes are planetographic on a triaxial body", "",
                       "convert it to planetocentric latitudes first, e.g. with ISIS");
  }
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  const bool sphere = crs != nullptr && crs->GetInvFlattening() == 0;
  if (sphere && counting.a != counting.c)
    georeference.centric_scale = squared_axis_ratio(counting.a, counting.c);
  return georeference;
}

}  // namespace mars
