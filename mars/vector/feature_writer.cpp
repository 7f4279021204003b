#include "mars/vector/feature_writer.h"

#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_feature.h>
#include <ogr_geometry.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/placement/memory_file.h"
#include "mars/vector/antimeridian.h"
#include "mars/vector/field_types.h"
#include "mars/vector/iau_names.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace mars {
namespace {

constexpr const char* kStyleColumn = "OGR_STYLE";
// Decimals of degrees: hundredths of a millimetre on the ground.
constexpr const char* kGeoJsonDecimals = "10";

std::string small_letters(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Returns the geographic system of the planet's sphere, longitudes first.
OGRSpatialReference sphere_system(const FeatureFileInfo& info) {
  OGRSpatialReference system;
  const std::string code = iau_sphere_code(info.body, info.radius_m);
  if (code.empty() || system.SetFromUserInput(("IAU_2015:" + code).c_str()) != OGRERR_NONE) {
    const std::string name = (info.body.empty() ? "Planet" : info.body) + " sphere";
    system.SetGeogCS((name + " of " + vpe::base::format_number(info.radius_m) + " m").c_str(), name.c_str(),
                     name.c_str(), info.radius_m, 0, "Reference meridian", 0);
  }
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

// Returns a member "crs" for a system that has no code.
std::string crs_member(const FeatureFileInfo& info) {
  return R"("crs": { "type": "name", "properties": { "name": "+proj=longlat +R=)" +
         vpe::base::format_number(info.radius_m) + " +no_defs +type=crs\" } },\n";
}

std::unique_ptr<OGRGeometry> geometry_of(const Shape& shape) {
  if (shape.kind == ShapeKind::point)
    return std::make_unique<OGRPoint>(shape.rings[0][0].x, shape.rings[0][0].y);
  const auto fill = [](OGRSimpleCurve& curve, const std::vector<glm::dvec2>& ring) {
    curve.setNumPoints(static_cast<int>(ring.size()), FALSE);
    for (std::size_t i = 0; i < ring.size(); ++i) curve.setPoint(static_cast<int>(i), ring[i].x, ring[i].y);
  };
  if (shape.kind == ShapeKind::line) {
    auto line = std::make_unique<OGRLineString>();
    fill(*line, shape.rings[0]);
    return line;
  }
  auto polygon = std::make_unique<OGRPolygon>();
  for (const auto& ring : shape.rings) {
    auto linear = std::make_unique<OGRLinearRing>();
    fill(*linear, ring);
    polygon->addRingDirectly(linear.release());
  }
  return polygon;
}

OGRwkbGeometryType single_type(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::point: return wkbPoint;
    case ShapeKind::line: return wkbLineString;
    case ShapeKind::polygon: return wkbPolygon;
  }
  return wkbUnknown;
}

// Holds the parts of all features, cut at the antimeridian, and the one type that fits them.
struct CutFeatures {
  std::vector<std::vector<Shape>> parts;
  OGRwkbGeometryType type = wkbUnknown;
  bool is_multi = false;
};

CutFeatures cut_features(const FeatureLayer& layer) {
  CutFeatures cut;
  std::set<ShapeKind> kinds;
  for (const Feature& feature : layer.features) {
    std::vector<Shape>& parts = cut.parts.emplace_back();
    for (const Shape& shape : feature.shapes) {
      for (Shape& part : cut_at_antimeridian(shape)) {
        kinds.insert(part.kind);
        parts.push_back(std::move(part));
      }
    }
    cut.is_multi = cut.is_multi || parts.size() > 1;
  }
  if (kinds.size() == 1) {
    cut.type = single_type(*kinds.begin());
    if (cut.is_multi) cut.type = OGR_GT_GetCollection(cut.type);
  }
  return cut;
}

// Returns one geometry of the parts of a feature; null without parts.
std::unique_ptr<OGRGeometry> join(const std::vector<Shape>& parts, OGRwkbGeometryType layer_type) {
  if (parts.empty()) return nullptr;
  const bool is_one = parts.size() == 1 && !OGR_GT_IsSubClassOf(layer_type, wkbGeometryCollection);
  if (is_one) return geometry_of(parts[0]);
  const bool is_uniform = std::ranges::all_of(parts, [&](const Shape& s) { return s.kind == parts[0].kind; });
  const OGRwkbGeometryType type =
      is_uniform ? OGR_GT_GetCollection(single_type(parts[0].kind)) : wkbGeometryCollection;
  std::unique_ptr<OGRGeometry> joined(OGRGeometryFactory::createGeometry(type));
  for (const Shape& part : parts)
    joined->toGeometryCollection()->addGeometryDirectly(geometry_of(part).release());
  return joined;
}

// Returns whether the numbers of the features tell them apart.
bool are_distinct(const FeatureLayer& layer) {
  std::set<std::int64_t> numbers;
  return std::ranges::all_of(
      layer.features, [&](const Feature& f) { return f.number >= 0 && numbers.insert(f.number).second; });
}

// Returns a name for a column that no field has.
std::string free_name(const FeatureLayer& layer, std::string name) {
  while (std::ranges::any_of(layer.fields, [&](const std::string& f) { return small_letters(f) == name; }))
    name += "_";
  return name;
}

// Writes one layer with a driver of GDAL into memory, from there into the file.
class FeatureFileWriter {
 public:
  FeatureFileWriter(const std::filesystem::path& path, const FeatureLayer& layer, const FeatureFileInfo& info)
      : path_(path), layer_(layer), info_(info) {}

  void write() {
    const std::string extension = small_letters(path_.extension().string());
    const bool is_geopackage = extension == ".gpkg";
    if (!is_geopackage && extension != ".geojson" && extension != ".json")
      throw error("its extension is not one of a format of features", "name it .geojson, .json or .gpkg");
    const MemoryFile memory(is_geopackage ? "gpkg" : "json");
    fill(memory.name(), is_geopackage);
    vsi_l_offset size = 0;
    const GByte* bytes = VSIGetMemFileBuffer(memory.name().c_str(), &size, FALSE);
    if (bytes == nullptr) throw error("GDAL has written nothing", "check the features");
    save({bytes, static_cast<std::size_t>(size)});
  }

 private:
  using Dataset = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;

  void save(std::span<const std::uint8_t> bytes) const {
    constexpr std::string_view kStart = "{\n\"type\": \"FeatureCollection\",\n";
    if (lacks_crs_ && !std::ranges::equal(bytes.first(std::min(bytes.size(), kStart.size())), kStart))
      throw error("GDAL has written an unknown beginning", "write a .gpkg file");
    const std::string crs = lacks_crs_ ? crs_member(info_) : "";
    const std::size_t before = lacks_crs_ ? kStart.size() : 0;
    try {
      vpe::base::OutputFile file(path_);
      file.write(bytes.first(before));
      file.write({reinterpret_cast<const std::uint8_t*>(crs.data()), crs.size()});
      file.write(bytes.subspan(before));
      file.commit();
    } catch (const vpe::base::FileError& failure) {
      throw SourceError(failure.what());
    }
  }

  SourceError error(const std::string& operation, const std::string& advice) const {
    return source_error(path_.string(), operation, GdalScope::last_message(), advice);
  }

  SourceError unwritable(const std::string& operation) const {
    return error(operation, "check names and values of its fields");
  }

  // GDAL reports some failures by messages alone.
  void check(bool done, const std::string& operation) const {
    if (!done || CPLGetLastErrorType() >= CE_Failure) throw unwritable(operation);
  }

  void fill(const std::string& name, bool is_geopackage) {
    OGRSpatialReference system = sphere_system(info_);
    CPLErrorReset();
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(is_geopackage ? "GPKG" : "GeoJSON");
    if (driver == nullptr) throw error("this GDAL has no driver of the format", "install all of GDAL");
    const Dataset dataset(driver->Create(name.c_str(), 0, 0, 0, GDT_Unknown, nullptr), [](GDALDataset* d) {
      const GdalScope quiet;
      GDALClose(d);
    });
    check(dataset != nullptr, "cannot be made");
    const CutFeatures cut = cut_features(layer_);
    const std::string layer_name = layer_.name.empty() ? path_.stem().string() : layer_.name;
    // The GeoJSON driver leaves a system without a code out.
    lacks_crs_ = !is_geopackage && system.GetAuthorityCode(nullptr) == nullptr;
    OGRLayer* layer = dataset->CreateLayer(layer_name.c_str(), &system, cut.type,
                                           (is_geopackage ? geopackage_options() : geojson_options()).List());
    check(layer != nullptr, "cannot make layer '" + layer_name + "'");
    create_fields(*layer);
    const bool keeps_numbers = are_distinct(layer_);
    check(!is_geopackage || dataset->StartTransaction() == OGRERR_NONE, "cannot be written");
    for (std::size_t i = 0; i < layer_.features.size(); ++i)
      write_feature(*layer, layer_.features[i], join(cut.parts[i], cut.type), keeps_numbers);
    check(!is_geopackage || dataset->CommitTransaction() == OGRERR_NONE, "cannot be written");
    dataset->FlushCache(false);
    check(true, "cannot be written");
  }

  CPLStringList geojson_options() const {
    CPLStringList options;
    options.SetNameValue("COORDINATE_PRECISION", kGeoJsonDecimals);
    if (!info_.description.empty()) options.SetNameValue("DESCRIPTION", info_.description.c_str());
    return options;
  }

  CPLStringList geopackage_options() const {
    CPLStringList options;
    options.SetNameValue("FID", free_name(layer_, "fid").c_str());
    options.SetNameValue("GEOMETRY_NAME", free_name(layer_, "geom").c_str());
    if (!info_.description.empty()) options.SetNameValue("DESCRIPTION", info_.description.c_str());
    return options;
  }

  void create_fields(OGRLayer& layer) {
    for (std::size_t i = 0; i < layer_.fields.size(); ++i) {
      types_.push_back(field_type(layer_, i));
      const FieldType type = types_.back();
      OGRFieldDefn field(layer_.fields[i].c_str(), type == FieldType::text     ? OFTString
                                                   : type == FieldType::number ? OFTReal
                                                                               : OFTInteger64);
      check(layer.CreateField(&field) == OGRERR_NONE, "cannot make field '" + layer_.fields[i] + "'");
    }
    has_styles_ = std::ranges::any_of(layer_.features, [](const Feature& f) { return !f.style.empty(); });
    OGRFieldDefn style(kStyleColumn, OFTString);
    check(!has_styles_ || layer.CreateField(&style) == OGRERR_NONE, "cannot make the field of styles");
  }

  void write_feature(OGRLayer& layer, const Feature& source, std::unique_ptr<OGRGeometry> geometry,
                     bool keeps_number) const {
    const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer.GetLayerDefn()));
    if (keeps_number) feature->SetFID(source.number);
    for (std::size_t i = 0; i < std::min(types_.size(), source.values.size()); ++i) {
      const int index = static_cast<int>(i);
      const FieldValue& value = source.values[i];
      if (std::holds_alternative<std::monostate>(value)) {
        feature->SetFieldNull(index);
      } else if (types_[i] == FieldType::text) {
        feature->SetField(index, field_text(value).c_str());
      } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
        feature->SetField(index, static_cast<GIntBig>(*integer));
      } else {
        feature->SetField(index, std::get<double>(value));
      }
    }
    if (has_styles_ && !source.style.empty())
      feature->SetField(static_cast<int>(types_.size()), source.style.c_str());
    if (geometry) feature->SetGeometryDirectly(geometry.release());
    check(layer.CreateFeature(feature.get()) == OGRERR_NONE,
          "cannot write feature " + std::to_string(source.number));
  }

  const std::filesystem::path& path_;
  const FeatureLayer& layer_;
  const FeatureFileInfo& info_;
  std::vector<FieldType> types_;
  bool has_styles_ = false;
  bool lacks_crs_ = false;
};

}  // namespace

void write_features(const std::filesystem::path& path, const FeatureLayer& layer, const FeatureFileInfo& info) {
  const GdalScope scope;
  FeatureFileWriter(path, layer, info).write();
}

}  // namespace mars
