#include "mars/raster/gdal_raster.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <rawdataset.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <type_traits>

#include "mars/raster/gdal_labels.h"
#include "mars/remote/gdal_remote.h"
#include "vpe/base/file.h"

namespace mars {
namespace {

const char* const kWrongFile = "give a raster that gdalinfo can show";

void check_bands(const std::string& path, GDALDataset& dataset) {
  if (dataset.GetRasterCount() == 0) {
    const char* const* parts = dataset.GetMetadata("SUBDATASETS");
    const char* first = CSLFetchNameValue(parts, "SUBDATASET_1_NAME");
    throw source_error(path, "has no raster bands", "",
                       first != nullptr ? std::string("open one of its parts, e.g. ") + first : kWrongFile);
  }
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    if (GDALDataTypeIsComplex(dataset.GetRasterBand(i)->GetRasterDataType())) {
      throw source_error(path, "holds complex numbers", "", "derive a real band first, e.g. with gdal_calc.py");
    }
  }
}

// Returns what the file tells about a window. Where it has no pixels, they have the nodata value, or are zeros,
// which are values, if there is none.
Coverage coverage_of(GDALDataset& dataset, const PixelWindow& w) {
  bool has_data = false;
  bool has_gaps = false;
  for (int i = 1; i <= dataset.GetRasterCount() && !(has_data && has_gaps); ++i) {
    GDALRasterBand* band = dataset.GetRasterBand(i);
    int has_nodata = 0;
    band->GetNoDataValue(&has_nodata);
    if (has_nodata == 0) return Coverage::kAll;
    const int status = band->GetDataCoverageStatus(w.column, w.row, w.columns, w.rows, 0, nullptr);
    if ((status & GDAL_DATA_COVERAGE_STATUS_UNIMPLEMENTED) != 0) return Coverage::kAll;
    has_data = has_data || (status & GDAL_DATA_COVERAGE_STATUS_DATA) != 0;
    has_gaps = has_gaps || (status & GDAL_DATA_COVERAGE_STATUS_EMPTY) != 0;
  }
  return !has_data ? Coverage::kNone : has_gaps ? Coverage::kSome : Coverage::kAll;
}

bool has_map(GDALDataset& dataset, const LabelGeoreference& label) {
  if (label.to_map) return true;
  std::array<double, 6> to_map{};
  if (dataset.GetGeoTransform(to_map.data()) != CE_None) return false;
  const OGRSpatialReference* crs = dataset.GetSpatialRef();
  return !label.crs.empty() || (crs != nullptr && !crs->IsEmpty());
}

// Adds the files that GDAL knows of a raster.
void add_files(GDALDataset& dataset, std::vector<std::string>& files) {
  const CPLStringList known(dataset.GetFileList());
  for (int i = 0; i < known.size(); ++i) {
    if (std::find(files.begin(), files.end(), known[i]) == files.end()) files.emplace_back(known[i]);
  }
}

// Throws if a raw file is too short. GDAL reads zeros beyond the end of some, as if they were sparse.
void check_raw_size(const std::string& path, GDALDataset& dataset) {
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const auto* raw = dynamic_cast<RawRasterBand*>(dataset.GetRasterBand(i));
    if (raw == nullptr || raw->GetFPL() == nullptr) continue;
    const std::int64_t last_row = std::int64_t{raw->GetLineOffset()} * (dataset.GetRasterYSize() - 1);
    const std::int64_t last_column = std::int64_t{raw->GetPixelOffset()} * (dataset.GetRasterXSize() - 1);
    const std::int64_t needed = static_cast<std::int64_t>(raw->GetImgOffset()) +
                                std::max<std::int64_t>(last_row, 0) + std::max<std::int64_t>(last_column, 0) +
                                GDALGetDataTypeSizeBytes(dataset.GetRasterBand(i)->GetRasterDataType());
    VSIFSeekL(raw->GetFPL(), 0, SEEK_END);
    const auto size = static_cast<std::int64_t>(VSIFTellL(raw->GetFPL()));
    if (size < needed) {
      throw source_error(path, "is cut short",
                         std::to_string(size) + " of " + std::to_string(needed) + " bytes", "fetch it again");
    }
  }
}

}  // namespace

GdalRaster::GdalRaster(const std::string& path, const PlacementOptions& placement)
    : file_(find_raster(raster_name(path))), opened_(open_raster(file_)), handles_([this] {
        GdalPool<GDALDataset>::Pointer handle = opened_ ? std::move(opened_) : open_raster(file_);
        return placement_ ? placement_->warp(std::move(handle)) : std::move(handle);
      }) {
  const GdalScope scope;
  const RemoteScope remote(file_.path);
  check_bands(file_.path, *opened_);
  check_raw_size(file_.path, *opened_);
  nodata_ = nodata_values(*opened_, file_.label);
  LabelGeoreference label = file_.georeference ? *file_.georeference : label_georeference(file_.path, *opened_);
  if (!has_map(*opened_, label)) {
    placement_ = find_placement(file_.path, *opened_, placement, nodata_.any());
    if (placement_) {
      label = {};
      add_files(*opened_, file_.files);
      file_.files.insert(file_.files.end(), placement_->files().begin(), placement_->files().end());
    }
  }
  const auto dataset = handles_.acquire();
  for (int i = 1; i <= dataset->GetRasterCount(); ++i)
    signed_bytes_.push_back(stores_signed_bytes(*dataset->GetRasterBand(i)));
  georeference_.emplace(file_.path, *dataset, label);
  // Asking a remote file would fetch its whole index.
  windows_ =
      is_remote(file_.path)
          ? std::vector<PixelWindow>{{0, 0, grid().width, grid().height}}
          : data_windows(grid(), [&](const PixelWindow& window) { return coverage_of(*dataset, window); });
  footprint_.emplace(*georeference_, windows_);
  // Without any data the place of the whole raster is checked.
  if (windows_.empty())
    footprint_.emplace(*georeference_, std::vector<PixelWindow>{{0, 0, grid().width, grid().height}});
  if (footprint_->is_empty()) {
    throw source_error(file_.path, "lies nowhere on the planet",
                       "its pixels cannot be transformed to longitude and latitude",
                       "check its coordinate system and geotransform with gdalinfo");
  }
}

SourceInfo GdalRaster::info() const {
  const GdalScope scope;
  const RemoteScope remote(file_.path);
  SourceInfo info;
  info.name = file_.path;
  info.is_remote = is_remote(file_.path);
  info.resolution_m = georeference_->resolution_m();
  if (!georeference_->note().empty()) info.notes.push_back(info.name + ": " + georeference_->note());
  if (placement_) {
    info.treatment = placement_->treatment();
    for (const std::string& note : placement_->notes()) info.notes.push_back(info.name + ": " + note);
  }
  std::vector<std::string> files = file_.files;
  if (files.empty()) add_files(*acquire(), files);
  for (const std::string& each : files) {
    VSIStatBufL stat{};
    if (VSIStatL(each.c_str(), &stat) != 0) continue;
    info.size_bytes += static_cast<std::int64_t>(stat.st_size);
    info.mtime_s = std::max(info.mtime_s, static_cast<std::int64_t>(stat.st_mtime));
    if (auto stamp = file_stamp(each)) info.files.push_back(std::move(*stamp));
  }
  return info;
}

namespace {

template <class T>
constexpr GDALDataType data_type() {
  if constexpr (std::is_same_v<T, float>) return GDT_Float32;
  if constexpr (std::is_same_v<T, double>) return GDT_Float64;
  return GDT_Byte;
}

template <class T>
void read_pixels(const std::string& path, GDALRasterBand* source, const PixelWindow& w, int stride, T* values,
                 const GdalScope& scope) {
  if (source != nullptr && attempt_with_retries(path, [&] {
        return source->RasterIO(GF_Read, w.column, w.row, w.columns, w.rows, values, w.columns, w.rows,
                                data_type<T>(), sizeof(T), static_cast<GSpacing>(sizeof(T)) * stride,
                                nullptr) == CE_None;
      })) {
    return;
  }
  const std::string message = scope.message();
  throw source_error(
      path, "cannot read rows " + std::to_string(w.row) + " to " + std::to_string(w.row + w.rows - 1), message,
      advice_for(path, message, "the file may be cut short or damaged: fetch it again"));
}

GDALRasterBand* band_of(GDALDataset& dataset, int band, int overview) {
  GDALRasterBand* source = dataset.GetRasterBand(band);
  return overview < 0 || source == nullptr ? source : source->GetOverview(overview);
}

}  // namespace

template <class T>
void GdalRaster::read(int band, int overview, const PixelWindow& window, int stride, T* values) const {
  const GdalScope scope;
  const auto dataset = acquire();
  read_pixels(file_.path, band_of(*dataset, band, overview), window, stride, values, scope);
  if constexpr (std::is_floating_point_v<T>) {
    if (!is_signed_byte(band)) return;
    for (int row = 0; row < window.rows; ++row) {
      T* line = values + std::ptrdiff_t{row} * stride;
      for (int column = 0; column < window.columns; ++column) {
        if (line[column] > 127) line[column] -= 256;
      }
    }
  }
}

void GdalRaster::read_mask(int band, int overview, const PixelWindow& window, int stride,
                           unsigned char* values) const {
  const GdalScope scope;
  const auto dataset = acquire();
  GDALRasterBand* source = band_of(*dataset, band, overview);
  read_pixels(file_.path, source == nullptr ? nullptr : source->GetMaskBand(), window, stride, values, scope);
}

template void GdalRaster::read(int, int, const PixelWindow&, int, float*) const;
template void GdalRaster::read(int, int, const PixelWindow&, int, double*) const;
template void GdalRaster::read(int, int, const PixelWindow&, int, unsigned char*) const;

namespace {

constexpr int kMaxVirtualDepth = 16;

// Collects the state of files, each once.
class StateOfFiles {
 public:
  void add(const std::string& name) {
    if (!seen_.insert(name).second) return;
    if (name.starts_with("/vsi")) {
      add_virtual(name);
    } else if (!add_local(name)) {
      // Parts of a mosaic may be absent; a name with a colon may be no file's, so that no file was looked at.
      add_line(name, "absent");
      state_.is_certain = state_.is_certain && name.find(':') == std::string::npos;
    }
  }

  // Adds all files of a raster; those of virtual rasters have parts of their own.
  void add_all(const RasterFile& file, GDALDataset& dataset, int depth) {
    for (const std::string& name : file.files) add(name);
    const CPLStringList names(dataset.GetFileList());
    for (int n = 0; n < names.size(); ++n) {
      const std::string name = names[n];
      const bool is_new = !seen_.contains(name);
      add(name);
      if (!is_new || depth == kMaxVirtualDepth || name == file.path || !is_virtual(name)) continue;
      const RasterFile part{name, name, {}, std::nullopt, std::nullopt};
      add_all(part, *open_raster(part), depth + 1);
    }
  }

  RasterState take() { return std::move(state_); }

 private:
  static bool is_virtual(const std::string& name) {
    GDALDriverH driver = GDALIdentifyDriver(name.c_str(), nullptr);
    return driver != nullptr && EQUAL(GDALGetDriverShortName(driver), "VRT");
  }

  void add_line(const std::string& name, const std::string& what) { state_.text += name + '\n' + what + '\n'; }

  bool add_local(const std::string& name) {
    const auto stamp = vpe::base::file_stamp(name);
    if (!stamp) return false;
    std::error_code none;
    add_line(std::filesystem::weakly_canonical(name, none).string(),
             std::to_string(stamp->size_bytes) + ' ' + std::to_string(stamp->modified_ns));
    return true;
  }

  // Adds a file of one of GDAL's file systems, and the local archive that it lies in.
  void add_virtual(const std::string& name) {
    VSIStatBufL stat{};
    const bool is_there = VSIStatL(name.c_str(), &stat) == 0;
    add_line(name, is_there ? std::to_string(stat.st_size) + ' ' + std::to_string(stat.st_mtime) : "absent");
    std::string rest = name;
    while (rest.starts_with("/vsi")) rest.erase(0, std::min(rest.find('/', 1), rest.size() - 1) + 1);
    std::erase_if(rest, [](char c) { return c == '{' || c == '}'; });
    for (std::size_t end = rest.find('/', 1);; end = rest.find('/', end + 1)) {
      const std::string prefix = rest.substr(0, end);
      std::error_code none;
      if (std::filesystem::is_regular_file(prefix, none) && add_local(prefix)) return;
      if (end == std::string::npos) break;
    }
    const bool is_in_remote_archive = name.find("/vsi", 1) != std::string::npos;
    state_.is_certain = state_.is_certain && is_there && stat.st_mtime > 0 && !is_in_remote_archive;
  }

  RasterState state_;
  std::set<std::string> seen_;
};

}  // namespace

RasterState raster_state(const std::string& path) {
  const GdalScope scope;
  const RasterFile file = find_raster(raster_name(path));
  const RemoteScope remote(file.path);
  StateOfFiles state;
  if (file.path.starts_with("/vsi") || vpe::base::file_stamp(file.path)) state.add(file.path);
  state.add_all(file, *open_raster(file), 0);
  return state.take();
}

std::string raster_library() { return GDALVersionInfo("--version"); }

}  // namespace mars
