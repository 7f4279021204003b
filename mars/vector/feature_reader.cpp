#include "mars/vector/feature_reader.h"

#include <cpl_error.h>
#include <cpl_json.h>
#include <gdal_priv.h>
#include <ogr_feature.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/vector/csv_columns.h"
#include "mars/vector/layer_crs.h"
#include "mars/vector/offline_scope.h"
#include "mars/vector/ring_longitudes.h"
#include "mars/vector/shape_reader.h"
#include "mars/vector/vector_file.h"

namespace mars {
namespace {

constexpr double kFarthestLon_deg = 3600;
constexpr double kPoleRounding_deg = 1e-9;
constexpr const char* kStyleField = "OGR_STYLE";

FieldValue value_of(const OGRFeature& feature, int field) {
  if (feature.IsFieldSetAndNotNull(field) == 0) return std::monostate();
  switch (feature.GetFieldDefnRef(field)->GetType()) {
    case OFTInteger: return std::int64_t{feature.GetFieldAsInteger(field)};
    case OFTInteger64: return static_cast<std::int64_t>(feature.GetFieldAsInteger64(field));
    case OFTReal: {
      const double value = feature.GetFieldAsDouble(field);
      return std::isfinite(value) ? FieldValue(value) : FieldValue();
    }
    case OFTBinary: return std::monostate();
    default: return std::string(feature.GetFieldAsString(field));
  }
}

// Reads the layers of one file.
class FeatureFileReader {
 public:
  FeatureFileReader(const std::string& path, const FeatureReadOptions& options, double radius_m)
      : path_(path), options_(options), radius_m_(radius_m), file_(path, options.most_bytes) {
    budget_ = {options.most_vertices, options.most_bytes, options.most_vertices, options.most_bytes};
  }

  std::vector<FeatureLayer> read() {
    std::vector<FeatureLayer> layers;
    for (OGRLayer* layer : file_.layers()) {
      if (!is_wanted(*layer)) continue;
      FeatureLayer read = read_layer(*layer);
      if (!options_.layer.empty() || !read.features.empty()) layers.push_back(std::move(read));
    }
    if (layers.empty() && !options_.layer.empty()) throw no_layer();
    return layers;
  }

 private:
  bool is_wanted(OGRLayer& layer) const {
    const std::string name = layer.GetName();
    if (!options_.layer.empty()) return name == options_.layer;
    if (file_.format() == VectorFormat::gpx) return name != "route_points" && name != "track_points";
    return file_.format() == VectorFormat::csv || layer.GetGeomType() != wkbNone;
  }

  SourceError no_layer() const {
    std::string names;
    for (OGRLayer* layer : file_.layers())
      names += (names.empty() ? "'" : ", '") + std::string(layer->GetName()) + "'";
    return source_error(path_, "has no layer '" + options_.layer + "'",
                        names.empty() ? "it has no layers" : "its layers are " + names, "name one of them");
  }

  std::string where(const FeatureLayer& layer) const { return path_ + ": layer '" + layer.name + "'"; }

  FeatureLayer read_layer(OGRLayer& source) {
    FeatureLayer layer;
    layer.name = source.GetName();
    OGRFeatureDefn& definition = *source.GetLayerDefn();
    std::vector<int> fields;
    for (int i = 0; i < definition.GetFieldCount(); ++i) {
      const std::string name = definition.GetFieldDefn(i)->GetNameRef();
      if (name == kStyleField) continue;
      fields.push_back(i);
      layer.fields.push_back(name);
    }
    CPLErrorReset();
    source.ResetReading();
    while (const OGRFeatureUniquePtr feature{source.GetNextFeature()}) {
      check_errors(layer, feature->GetFID());
      layer.features.push_back(read_feature(*feature, fields, layer));
    }
    const std::int64_t last = layer.features.empty() ? -1 : layer.features.back().number;
    check_errors(layer, last);
    if (file_.format() == VectorFormat::csv) read_csv_places(layer);
    to_places(layer, source.GetSpatialRef(), source);
    return layer;
  }

  // GDAL leaves out what it cannot read, and goes on. Places in CSV are not read by GDAL.
  void check_errors(const FeatureLayer& layer, std::int64_t number) const {
    if (CPLGetLastErrorType() < CE_Failure || file_.format() == VectorFormat::csv) return;
    const std::string feature = number < 0 ? "" : " at or after feature " + std::to_string(number);
    throw source_error(where(layer), "cannot be read" + feature, GdalScope::last_message(),
                       "check the file with ogrinfo -al");
  }

  Feature read_feature(const OGRFeature& source, const std::vector<int>& fields, const FeatureLayer& layer) {
    Feature feature;
    feature.number = source.GetFID();
    const FeaturePlace place{path_, layer.name, feature.number};
    const std::size_t before = budget_.vertices;
    const OGRGeometry* geometry = source.GetGeometryRef();
    if (geometry != nullptr && file_.format() != VectorFormat::csv)
      feature.shapes = shapes_of(*geometry, place, budget_);
    if (budget_.vertices == before) budget_.take_vertices(1, place);
    feature.values.reserve(fields.size());
    for (const int field : fields) {
      feature.values.push_back(value_of(source, field));
      const auto* text = std::get_if<std::string>(&feature.values.back());
      budget_.take_bytes(sizeof(FieldValue) + (text == nullptr ? 0 : text->size()), place);
    }
    const char* style = source.GetStyleString();
    if (style != nullptr) feature.style = style;
    budget_.take_bytes(feature.style.size(), place);
    return feature;
  }

  void read_csv_places(FeatureLayer& layer) {
    const PlaceColumns columns = find_place_columns(layer, path_, options_.lon_column, options_.lat_column);
    for (Feature& row : layer.features)
      row.shapes = row_shapes(row, layer, columns, {path_, layer.name, row.number}, budget_);
    convert_columns(layer);
  }

  void to_places(FeatureLayer& layer, const OGRSpatialReference* crs, OGRLayer& source) const {
    const std::optional<OGRSpatialReference> named = named_crs(layer, source, crs);
    const LayerCrs system(where(layer), named ? &*named : crs, radius_m_, range_of(layer), options_.axis_order);
    for (Feature& feature : layer.features) {
      const FeaturePlace place{path_, layer.name, feature.number};
      for (Shape& shape : feature.shapes) {
        for (std::vector<glm::dvec2>& ring : shape.rings) {
          system.to_places(ring);
          for (glm::dvec2& p : ring) check(p, place);
        }
        unwrap_longitudes(shape);
      }
    }
  }

  // Returns the system that a GeoJSON file names, with its own axes; GDAL takes one that it does not know for WGS 84.
  std::optional<OGRSpatialReference> named_crs(const FeatureLayer& layer, OGRLayer& source,
                                               const OGRSpatialReference* crs) const {
    if (file_.format() == VectorFormat::shapefile && crs == nullptr) check_prj(layer);
    if (file_.format() != VectorFormat::geojson) return std::nullopt;
    const char* native = source.GetMetadataItem("NATIVE_DATA", "NATIVE_DATA");
    CPLJSONDocument document;
    if (native == nullptr || !document.LoadMemory(std::string(native))) return std::nullopt;
    const CPLJSONObject member = document.GetRoot().GetObj("crs");
    if (!member.IsValid() || member.GetType() != CPLJSONObject::Type::Object) return std::nullopt;
    const std::string name = member.GetString("properties/name");
    OGRSpatialReference system;
    if (name.empty() ||
        system.SetFromUserInput(name.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
            OGRERR_NONE) {
      throw source_error(
          where(layer), "its member 'crs' names no coordinate system that PROJ knows: '" + name + "'",
          GdalScope::last_message(), "name one, as urn:ogc:def:crs:IAU_2015::49900; links are not followed");
    }
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return system;
  }

  void check_prj(const FeatureLayer& layer) const {
    for (const char* extension : {".prj", ".PRJ"}) {
      const std::filesystem::path prj = std::filesystem::path(path_).replace_extension(extension);
      std::error_code none;
      if (std::filesystem::exists(prj, none)) {
        throw source_error(where(layer),
                           "GDAL does not understand its coordinate system in '" + prj.string() + "'", "",
                           "correct that file, or remove it if coordinates are degrees");
      }
    }
  }

  static CoordinateRange range_of(const FeatureLayer& layer) {
    constexpr double kHuge = std::numeric_limits<double>::max();
    CoordinateRange range{glm::dvec2(kHuge), glm::dvec2(-kHuge)};
    for (const Feature& feature : layer.features) {
      for (const Shape& shape : feature.shapes) {
        for (const auto& ring : shape.rings) {
          for (const glm::dvec2 p : ring) {
            range.low = {std::min(range.low.x, p.x), std::min(range.low.y, p.y)};
            range.high = {std::max(range.high.x, p.x), std::max(range.high.y, p.y)};
          }
        }
      }
    }
    return range;
  }

  static void check(glm::dvec2& p, const FeaturePlace& place) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y))
      throw place.error("a vertex is off the map of its coordinate system", "remove the feature or correct it");
    // Rounding may carry the edge of a map over the pole.
    if (std::abs(p.y) <= 90 + kPoleRounding_deg) p.y = std::clamp(p.y, -90.0, 90.0);
    if (std::abs(p.y) <= 90 && std::abs(p.x) <= kFarthestLon_deg) return;
    throw place.error(
        "longitude " + std::to_string(p.x) + ", latitude " + std::to_string(p.y) + " is no place",
        "expected degrees; if these are metres, name their coordinate system with ogr2ogr -a_srs");
  }

  std::string path_;
  const FeatureReadOptions& options_;
  double radius_m_;
  VectorFile file_;
  ReadBudget budget_;
};

}  // namespace

std::vector<FeatureLayer> read_features(const std::string& path, const FeatureReadOptions& options,
                                        double radius_m) {
  const OfflineScope scope;
  FeatureFileReader reader(path, options, radius_m);
  return reader.read();
}

}  // namespace mars
