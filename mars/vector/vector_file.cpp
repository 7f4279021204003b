#include "mars/vector/vector_file.h"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/vector/xml_documents.h"

namespace mars {
namespace {

namespace fs = std::filesystem;

struct FormatName {
  std::string_view extension;
  VectorFormat format;
  std::array<const char*, 3> drivers;  // ends with null
};

constexpr std::array kFormats{
    FormatName{".gpkg", VectorFormat::geopackage, {"GPKG", nullptr, nullptr}},
    FormatName{".geojson", VectorFormat::geojson, {"GeoJSON", nullptr, nullptr}},
    FormatName{".json", VectorFormat::geojson, {"GeoJSON", nullptr, nullptr}},
    FormatName{".shp", VectorFormat::shapefile, {"ESRI Shapefile", nullptr, nullptr}},
    FormatName{".kml", VectorFormat::kml, {"LIBKML", "KML", nullptr}},
    FormatName{".kmz", VectorFormat::kml, {"LIBKML", "KML", nullptr}},
    FormatName{".gpx", VectorFormat::gpx, {"GPX", nullptr, nullptr}},
    FormatName{".csv", VectorFormat::csv, {"CSV", nullptr, nullptr}},
    FormatName{".tsv", VectorFormat::csv, {"CSV", nullptr, nullptr}},
};

constexpr const char* kAdvice = "give a .gpkg, .geojson, .shp, .kml, .kmz, .gpx or .csv file";

std::string extension_of(const std::string& path) {
  std::string text = fs::path(path).extension().string();
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Returns null for the extension of another format.
const FormatName* find_format(const std::string& path) {
  const auto* found = std::ranges::find(kFormats, extension_of(path), &FormatName::extension);
  return found == kFormats.end() ? nullptr : found;
}

const FormatName& format_of(const std::string& path) {
  const FormatName* found = find_format(path);
  if (found == nullptr)
    throw source_error(path, "its extension is not one of a format of features", "", kAdvice);
  return *found;
}

// Throws for all but regular files of the local file system.
void check_local(const std::string& path) {
  if (path.starts_with("/vsi") || path.find("://") != std::string::npos) {
    throw source_error(path, "features are not read from servers or from GDAL's virtual file systems", "",
                       "copy the file to this computer and give its path");
  }
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status))
    throw source_error(path, "cannot open", failure ? failure.message() : "No such file or directory",
                       "check the name");
  if (fs::is_directory(status)) throw source_error(path, "cannot open as features", "it is a folder", kAdvice);
  if (!fs::is_regular_file(status))
    throw source_error(path, "cannot open as features", "it is no regular file", kAdvice);
}

void check_size(const std::string& path, std::size_t most_bytes) {
  std::error_code failure;
  const std::uintmax_t size = fs::file_size(path, failure);
  if (failure) throw source_error(path, "cannot open", failure.message(), "check the name and the permissions");
  if (size > most_bytes) {
    throw source_error(
        path,
        std::to_string(size) + " bytes are more than the " + std::to_string(most_bytes) + " that are accepted",
        "", "divide the file, e.g. with ogr2ogr -spat");
  }
}

// Returns what GDAL reads from memory; nothing if it reads the file.
std::vector<std::string> texts_of(const std::string& path, VectorFormat format, std::size_t most_bytes) {
  if (format == VectorFormat::kml || format == VectorFormat::gpx) return xml_documents(path, most_bytes);
  if (format != VectorFormat::csv) return {};
  return {whole_text(path, most_bytes)};
}

}  // namespace

bool has_vector_extension(const std::string& path) { return find_format(path) != nullptr; }

VectorFile::VectorFile(const std::string& path, std::size_t most_bytes) : path_(path) {
  check_local(path);
  const FormatName& format = format_of(path);
  format_ = format.format;
  check_size(path, most_bytes);
  for (std::string& text : texts_of(path, format_, most_bytes)) {
    const std::string stem = fs::path(path).stem().string();
    const std::string extension = format_ == VectorFormat::kml ? ".kml" : std::string(format.extension);
    texts_.push_back(std::make_unique<MemoryText>(std::move(text), stem + extension));
    open(texts_.back()->name(), format.drivers.data());
  }
  // A relative name could be one of GDAL's connection strings.
  if (texts_.empty()) open(fs::absolute(path).string(), format.drivers.data());
}

VectorFile::~VectorFile() = default;

void VectorFile::open(const std::string& name, const char* const* drivers) {
  CPLStringList options;
  if (format_ == VectorFormat::geojson) options.SetNameValue("NATIVE_DATA", "YES");
  if (format_ == VectorFormat::csv) options.SetNameValue("HEADERS", "YES");
  datasets_.emplace_back(static_cast<GDALDataset*>(
                             GDALOpenEx(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                        drivers, options.List(), nullptr)),
                         [](GDALDataset* d) {
                           const GdalScope quiet;
                           GDALClose(d);
                         });
  if (datasets_.back() != nullptr) return;
  std::string words = GdalScope::last_message();
  if (const std::size_t at = words.find(name); at != std::string::npos) words.replace(at, name.size(), path_);
  throw source_error(path_, "cannot open as features", words,
                     "give a file that ogrinfo can show, whose extension is that of its format");
}

std::vector<OGRLayer*> VectorFile::layers() const {
  std::vector<OGRLayer*> all;
  for (const auto& dataset : datasets_) {
    for (OGRLayer* layer : dataset->GetLayers()) all.push_back(layer);
  }
  return all;
}

}  // namespace mars
