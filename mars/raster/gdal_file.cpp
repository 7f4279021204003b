#include "mars/raster/gdal_file.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_pam.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "mars/raster/pds_image.h"
#include "mars/raster/pds_map.h"
#include "mars/remote/gdal_remote.h"

namespace mars {
namespace {

using Pointer = GdalPool<GDALDataset>::Pointer;

constexpr std::size_t kLabelBytes = std::size_t{1} << 18;

Pointer try_open(const std::string& name) {
  Pointer dataset(
      static_cast<GDALDataset*>(GDALOpenEx(
          name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr, nullptr, nullptr)),
      [](GDALDataset* d) {
        const GdalScope scope;
        GDALClose(d);
      });
  // Side files (.aux.xml) are read, for their georeference, but never written.
  if (auto* pam = dynamic_cast<GDALPamDataset*>(dataset.get()))
    pam->SetPamFlags(pam->GetPamFlags() | GPF_NOSAVE);
  return dataset;
}

bool exists(const std::string& path) {
  VSIStatBufL stat{};
  return VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG) == 0;
}

// Returns true if the file exists. Retries, because a transient failure of a server must not hide a label. Throws
// SourceError if a remote raster cannot be opened. Must be called inside a GdalScope, like first_bytes().
bool is_there(const std::string& path, const GdalScope& scope) {
  if (!is_remote(path)) return exists(path);
  const RemoteScope remote(path);
  if (exists(path) || attempt_with_retries(path, [&] { return try_open(path) != nullptr; })) return true;
  const std::string message = scope.message();
  throw source_error(path, "cannot open as a raster", message,
                     advice_for(path, message, "give a raster that gdalinfo can show"));
}

std::string first_bytes(const std::string& path, std::size_t size) {
  std::string text;
  // The file exists, so a failed read must not be taken for an absent label.
  attempt_with_retries(path, [&] {
    VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
    if (file == nullptr) return false;
    text.assign(size, '\0');
    text.resize(VSIFReadL(text.data(), 1, size, file));
    VSIFCloseL(file);
    return !text.empty();
  });
  return text;
}

// Returns the PDS label of a file, if it has one.
std::optional<PdsLabel> label_in(const std::string& path) {
  const std::string start = first_bytes(path, 1024);
  bool is_label = false;
  for (const char* word : {"PDS_VERSION_ID", "SFDU_LABEL", "RECORD_TYPE"}) {
    is_label = is_label || start.find(word) != std::string::npos;
  }
  if (!is_label) return std::nullopt;
  return parse_pds_label(first_bytes(path, kLabelBytes));
}

bool is_pds(const GDALDataset& dataset) {
  GDALDriver* driver = const_cast<GDALDataset&>(dataset).GetDriver();
  return driver != nullptr && std::strcmp(GDALGetDriverShortName(driver), "PDS") == 0;
}

// Returns the raster that a label describes, if it is one.
std::optional<RasterFile> by_label(const std::string& path) {
  auto label = label_in(path);
  if (!label) return std::nullopt;
  RasterFile file{path, path, {}, label, std::nullopt};
  const Pointer dataset = try_open(path);
  if (dataset && !is_pds(*dataset)) return std::nullopt;
  if (!dataset && !has_pds_image(*label)) return std::nullopt;
  if (!dataset || gdal_misreads(*label)) {
    const PdsImage image = pds_image(path, *label);
    file.gdal_name = pds_vrt(image);
    file.files = {path};
    if (image.data_path != path) file.files.push_back(image.data_path);
  }
  file.georeference = has_pds_catalog_map(*label) ? pds_catalog_map(path, *label) : pds_map(path, *label);
  if (!file.georeference && dataset && file.gdal_name != path) {
    // The pixels are read by the label, but GDAL's georeference is right.
    std::array<double, 6> to_map{};
    LabelGeoreference georeference;
    if (dataset->GetGeoTransform(to_map.data()) == CE_None) georeference.to_map = to_map;
    if (const OGRSpatialReference* crs = dataset->GetSpatialRef()) {
      char* wkt = nullptr;
      const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
      if (crs->exportToWkt(&wkt, options) == OGRERR_NONE) georeference.crs = wkt;
      CPLFree(wkt);
    }
    file.georeference = georeference;
  }
  return file;
}

// Returns the files beside `path` that have its name with another extension and that a driver of GDAL claims.
std::vector<std::string> siblings(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<std::string> found;
  std::error_code error;
  const fs::path own(path);
  const fs::path folder = own.has_parent_path() ? own.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    if (file.stem() != own.stem() || file.filename() == own.filename()) continue;
    if (GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) == nullptr &&
        !label_in(file.string()))
      continue;
    found.push_back((own.parent_path() / file.filename()).string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::string sibling_advice(const std::string& path) {
  std::string names;
  for (const std::string& name : siblings(path)) names += (names.empty() ? "'" : ", '") + name + "'";
  return names.empty() ? "" : "give the file that describes it: " + names;
}

RasterFile find_raster(const std::string& path) {
  const GdalScope scope;
  if (is_there(path, scope)) {
    if (auto file = by_label(path)) return *file;
    if (!CPLString(CPLGetExtension(path.c_str())).tolower().compare("img") && !try_open(path)) {
      for (const char* extension : {"lbl", "LBL"}) {
        const std::string label = CPLResetExtension(path.c_str(), extension);
        if (!exists(label)) continue;
        if (auto file = by_label(label)) return *file;
        if (try_open(label)) return {label, label, {}, std::nullopt, std::nullopt};
      }
    }
  }
  return {path, path, {}, std::nullopt, std::nullopt};
}

Pointer open_raster(const RasterFile& file) {
  const GdalScope scope;
  Pointer dataset;
  if (attempt_with_retries(file.path, [&] { return (dataset = try_open(file.gdal_name)) != nullptr; }))
    return dataset;
  VSIStatBufL stat{};
  errno = 0;
  if (VSIStatExL(file.path.c_str(), &stat, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) != 0 &&
      file.path.find(':') == std::string::npos) {
    throw source_error(file.path, "cannot open", std::strerror(errno != 0 ? errno : ENOENT), "check the name");
  }
  if (VSI_ISDIR(stat.st_mode)) {
    throw source_error(file.path, "cannot open as a raster", "it is a folder", "give a raster in it");
  }
  const std::string message = scope.message();
  const std::string advice = is_remote(file.path) ? "" : sibling_advice(file.path);
  throw source_error(
      file.path, "cannot open as a raster", message,
      advice_for(file.path, message, advice.empty() ? "give a raster that gdalinfo can show" : advice));
}

}  // namespace mars
