#include "mars/gdal_raster.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_pam.h>
#include <gdal_priv.h>
#include <rawdataset.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <type_traits>

#include "mars/gdal_remote.h"

namespace mars {
namespace {

using Handles = LeasePool<GDALDataset>;

const char* const kWrongFile = "give a raster that gdalinfo can show";

Handles::Pointer try_open(const std::string& path) {
  Handles::Pointer dataset(
      static_cast<GDALDataset*>(GDALOpenEx(
          path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr, nullptr, nullptr)),
      [](GDALDataset* d) {
        const GdalScope scope;
        GDALClose(d);
      });
  // Side files (.aux.xml) are read, for their georeference, but never written.
  if (auto* pam = dynamic_cast<GDALPamDataset*>(dataset.get()))
    pam->SetPamFlags(pam->GetPamFlags() | GPF_NOSAVE);
  return dataset;
}

Handles::Pointer open_handle(const std::string& path) {
  const GdalScope scope;
  Handles::Pointer dataset;
  attempt_with_retries(path, [&] { return (dataset = try_open(path)) != nullptr; });
  if (!dataset) {
    VSIStatBufL stat{};
    errno = 0;
    if (VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG) != 0 && path.find(':') == std::string::npos) {
      throw source_error(path, "cannot open", std::strerror(errno != 0 ? errno : ENOENT), "check the name");
    }
    throw source_error(path, "cannot open as a raster", scope.message(), advice_for(path, kWrongFile));
  }
  return dataset;
}

bool exists(const std::string& path) {
  VSIStatBufL stat{};
  return VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG) == 0;
}

// The file that GDAL understands: `path`, or the label beside a PDS image that has none inside.
std::string readable_path(const std::string& path) {
  const GdalScope scope;
  if (!CPLString(CPLGetExtension(path.c_str())).tolower().compare("img") && exists(path) && !try_open(path)) {
    for (const char* extension : {"lbl", "LBL"}) {
      std::string label = CPLResetExtension(path.c_str(), extension);
      if (exists(label) && try_open(label)) return label;
    }
  }
  return path;
}

std::string first_bytes(const std::string& path, std::size_t size) {
  std::string text(size, '\0');
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (file == nullptr) return {};
  text.resize(VSIFReadL(text.data(), 1, size, file));
  VSIFCloseL(file);
  return text;
}

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

// GDAL reads zeros beyond the end of some raw files, as if they were sparse.
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

GdalRaster::GdalRaster(const std::string& path)
    : path_(readable_path(raster_name(path))), handles_([this] { return open_handle(path_); }) {
  const GdalScope scope;
  const auto dataset = handles_.lend();
  check_bands(path_, *dataset);
  check_raw_size(path_, *dataset);
  PdsPlacement placement;
  const GDALDriver* driver = dataset->GetDriver();
  if (driver != nullptr && std::strcmp(GDALGetDriverShortName(const_cast<GDALDriver*>(driver)), "PDS") == 0) {
    label_ = parse_pds_label(first_bytes(path_, std::size_t{1} << 18));
    placement = place_pds(*label_);
  }
  georeference_.emplace(path_, *dataset, placement);
  footprint_.emplace(*georeference_);
  if (footprint_->is_empty()) {
    throw source_error(path_, "lies nowhere on the planet",
                       "its pixels cannot be transformed to longitude and latitude",
                       "check its coordinate system and geotransform with gdalinfo");
  }
}

SourceInfo GdalRaster::info() const {
  const GdalScope scope;
  SourceInfo info;
  info.name = path_;
  info.resolution_m = georeference_->resolution_m();
  info.datum = "unknown";
  char** files = lend()->GetFileList();
  for (int i = 0; files != nullptr && files[i] != nullptr; ++i) {
    VSIStatBufL stat{};
    if (VSIStatL(files[i], &stat) != 0) continue;
    info.size_bytes += static_cast<std::int64_t>(stat.st_size);
    info.mtime_s = std::max(info.mtime_s, static_cast<std::int64_t>(stat.st_mtime));
  }
  CSLDestroy(files);
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
  throw source_error(path,
                     "cannot read rows " + std::to_string(w.row) + " to " + std::to_string(w.row + w.rows - 1),
                     scope.message(), advice_for(path, "the file may be cut short or damaged: fetch it again"));
}

GDALRasterBand* band_of(GDALDataset& dataset, int band, int overview) {
  GDALRasterBand* source = dataset.GetRasterBand(band);
  return overview < 0 || source == nullptr ? source : source->GetOverview(overview);
}

}  // namespace

template <class T>
void GdalRaster::read(int band, int overview, const PixelWindow& window, int stride, T* values) const {
  const GdalScope scope;
  const auto dataset = lend();
  read_pixels(path_, band_of(*dataset, band, overview), window, stride, values, scope);
}

void GdalRaster::read_mask(int band, int overview, const PixelWindow& window, int stride,
                           unsigned char* values) const {
  const GdalScope scope;
  const auto dataset = lend();
  GDALRasterBand* source = band_of(*dataset, band, overview);
  read_pixels(path_, source == nullptr ? nullptr : source->GetMaskBand(), window, stride, values, scope);
}

template void GdalRaster::read(int, int, const PixelWindow&, int, float*) const;
template void GdalRaster::read(int, int, const PixelWindow&, int, double*) const;
template void GdalRaster::read(int, int, const PixelWindow&, int, unsigned char*) const;

std::string raster_library() { return GDALVersionInfo("--version"); }

}  // namespace mars
