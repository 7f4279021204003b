#include "mars/raster/placement/placement.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gdalwarper.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mars/raster/placement/memory_file.h"

namespace mars {
namespace {

// Error of GDAL's linear approximation along a row, which it checks in the middle. Not used on a DEM, whose relief it
// would not see.
constexpr double kApproximation_px = 0.02;

using WarpOptions = std::unique_ptr<GDALWarpOptions, void (*)(GDALWarpOptions*)>;

void close_dataset(GDALDataset* dataset) {
  const GdalScope scope;
  GDALClose(dataset);
}

// What the bands of a raster are.
struct Bands {
  std::vector<int> values;  // numbers of those that are no alpha band
  int alpha = 0;            // 0: none
  bool keep_type = true;    // bytes and words
  bool is_palette = false;
  bool is_double = false;  // a float cannot hold the values
};

Bands bands_of(GDALDataset& dataset) {
  Bands bands;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    GDALRasterBand* band = dataset.GetRasterBand(i);
    if (band->GetColorInterpretation() == GCI_AlphaBand) {
      bands.alpha = i;
      continue;
    }
    bands.values.push_back(i);
    const GDALDataType type = band->GetRasterDataType();
    bands.keep_type = bands.keep_type && (type == GDT_Byte || type == GDT_UInt16);
    bands.is_palette = bands.is_palette || band->GetColorTable() != nullptr;
    bands.is_double =
        bands.is_double || (type != GDT_Byte && type != GDT_UInt16 && type != GDT_Int16 && type != GDT_Float32);
  }
  return bands;
}

// Returns the nodata values of the bands: NaN for those without one, or nothing if bytes and words have none in some
// band, as a pixel has data if any band has.
std::vector<double> nodata_of(GDALDataset& dataset, const Bands& bands) {
  std::vector<double> values;
  for (const int i : bands.values) {
    int has_nodata = 0;
    const double value = dataset.GetRasterBand(i)->GetNoDataValue(&has_nodata);
    if (has_nodata == 0 && bands.keep_type) return {};
    values.push_back(has_nodata != 0 ? value : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

template <class T>
T* gdal_array(const std::vector<T>& values) {
  auto* array = static_cast<T*>(CPLMalloc(sizeof(T) * values.size()));
  std::copy(values.begin(), values.end(), array);
  return array;
}

void set_option(GDALWarpOptions& options, const char* name, const char* value) {
  options.papszWarpOptions = CSLSetNameValue(options.papszWarpOptions, name, value);
}

void set_bands(GDALWarpOptions& options, GDALDataset& dataset, const Bands& bands) {
  const auto count = static_cast<int>(bands.values.size());
  std::vector<int> targets;
  for (int i = 1; i <= count; ++i) targets.push_back(i);
  options.nBandCount = count;
  options.panSrcBands = gdal_array(bands.values);
  options.panDstBands = gdal_array(targets);
  options.nSrcAlphaBand = bands.alpha;
  const std::vector<double> nodata = nodata_of(dataset, bands);
  if (!nodata.empty()) options.padfSrcNoDataReal = gdal_array(nodata);
  if (bands.keep_type) {
    options.nDstAlphaBand = count + 1;
    set_option(options, "INIT_DEST", "0");
    set_option(options, "UNIFIED_SRC_NODATA", "YES");
  } else {
    options.padfDstNoDataReal = gdal_array(
        std::vector<double>(static_cast<std::size_t>(count), std::numeric_limits<double>::quiet_NaN()));
    set_option(options, "INIT_DEST", "NO_DATA");
    set_option(options, "UNIFIED_SRC_NODATA", "NO");
  }
  // Pixels of the grid are as large as those of the raster. GDAL would estimate that for each block anew, and where it
  // finds them larger it takes a wider kernel, which moves values by up to a tenth of a pixel.
  set_option(options, "XSCALE", "1");
  set_option(options, "YSCALE", "1");
  // Relief inside a block may reach beyond what its sides need.
  set_option(options, "SAMPLE_GRID", "YES");
}

// Gives the warped bands what the raster's own say of their values.
void describe_bands(GDALDataset& warped, GDALDataset& dataset, const Bands& bands) {
  for (std::size_t i = 0; i < bands.values.size(); ++i) {
    GDALRasterBand* to = warped.GetRasterBand(static_cast<int>(i) + 1);
    GDALRasterBand* from = dataset.GetRasterBand(bands.values[i]);
    to->SetScale(from->GetScale());
    to->SetOffset(from->GetOffset());
    to->SetUnitType(from->GetUnitType());
    to->SetDescription(from->GetDescription());
    to->SetColorInterpretation(from->GetColorInterpretation());
    if (bands.keep_type) {
      to->DeleteNoDataValue();
    } else {
      to->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
    }
  }
}

}  // namespace

Placement::Placement(const std::string& path, GDALDataset& dataset, const PlacementOptions& options,
                     bool has_special_values)
    : path_(path) {
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const char* type = dataset.GetRasterBand(i)->GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
    if (dataset.GetRasterBand(i)->GetRasterDataType() != GDT_Byte || type == nullptr ||
        !EQUAL(type, "SIGNEDBYTE"))
      continue;
    throw source_error(path, "holds signed bytes, which GDAL cannot warp", "",
                       "convert it with gdal_translate -ot Int16 first");
  }
  const char* const* rpc = dataset.GetMetadata("RPC");
  const bool has_rpc = rpc != nullptr && rpc[0] != nullptr;
  const OGRSpatialReference* crs = nullptr;
  std::string advice;
  if (has_rpc && (options.gcp_method == GcpMethod::kByCount || dataset.GetGCPCount() == 0)) {
    rpc_ = rpc_model(path, dataset, options);
    options_ = rpc_->transformer_options();
    files_ = rpc_->dem_files;
    treatment_ = rpc_->treatment();
    notes_ = rpc_->notes;
    if (dataset.GetGCPCount() > 0)
      notes_.front() +=
          "; its " + std::to_string(dataset.GetGCPCount()) + " control points count with --gcp-method";
    crs = &rpc_->crs;
    advice = rpc_->dem ? "give a DEM that covers it, or --rpc-height" : "check its RPC and the height";
  } else {
    points_ = control_points(path, dataset, options.gcp_method);
    options_ = points_->is_spline ? std::vector<std::string>{"METHOD=GCP_TPS"}
                                  : std::vector<std::string>{"METHOD=GCP_POLYNOMIAL",
                                                             "MAX_GCP_ORDER=" + std::to_string(points_->order)};
    treatment_ = points_->treatment();
    crs = &points_->crs;
    advice = "use a lower order, such as --gcp-method polynomial1, or add control points near its corners";
  }
  is_nearest_ = has_special_values || bands_of(dataset).is_palette;
  const Pointer described = with_points(dataset);
  grid_ = choose_grid(path, PixelMapper(path, *described, options_), dataset.GetRasterXSize(),
                      dataset.GetRasterYSize(), *crs, advice);
  if (points_) notes_.push_back(points_->note(grid_.pixel_m));
}

// Returns a virtual copy of the raster with values of the wanted type and the points that count.
Placement::Pointer Placement::with_points(GDALDataset& source) const {
  const Bands bands = bands_of(source);
  CPLStringList words;
  words.AddString("-of");
  words.AddString("VRT");
  if (!bands.keep_type) {
    words.AddString("-ot");
    words.AddString(bands.is_double ? "Float64" : "Float32");
  }
  const std::unique_ptr<GDALTranslateOptions, void (*)(GDALTranslateOptions*)> options(
      GDALTranslateOptionsNew(words.List(), nullptr), GDALTranslateOptionsFree);
  int failed = 0;
  Pointer copy(
      GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(&source), options.get(), &failed)),
      close_dataset);
  if (!copy) {
    throw source_error(path_, "GDAL cannot describe its bands", GdalScope::last_message(),
                       "check it with gdalinfo");
  }
  if (rpc_) {
    CPLStringList values;
    for (const std::string& value : rpc_->metadata) values.AddString(value.c_str());
    copy->SetMetadata(values.List(), "RPC");
    return copy;
  }
  std::vector<GDAL_GCP> gcps;
  for (const ControlPoint& point : points_->points) {
    gcps.push_back({const_cast<char*>(point.name.c_str()), const_cast<char*>(""), point.pixel.x, point.pixel.y,
                    point.ground.x, point.ground.y, 0});
  }
  copy->SetGCPs(static_cast<int>(gcps.size()), gcps.data(), &points_->crs);
  return copy;
}

Placement::Pointer Placement::warp(Pointer source) const {
  const GdalScope scope;
  auto described = std::make_shared<Pointer>(with_points(*source));
  GDALDataset& dataset = **described;
  const Bands bands = bands_of(dataset);
  WarpOptions options(GDALCreateWarpOptions(), GDALDestroyWarpOptions);
  options->hSrcDS = GDALDataset::ToHandle(&dataset);
  options->eResampleAlg = is_nearest_ ? GRA_NearestNeighbour : GRA_Bilinear;
  set_bands(*options, dataset, bands);

  PixelMapper mapper(path_, dataset, options_);
  void* transformer = mapper.release();
  GDALSetGenImgProjTransformerDstGeoTransform(transformer, grid_.to_ground.data());
  if (rpc_ && rpc_->dem) {
    options->pfnTransformer = GDALGenImgProjTransform;
    options->pTransformerArg = transformer;
  } else {
    options->pfnTransformer = GDALApproxTransform;
    options->pTransformerArg =
        GDALCreateApproxTransformer(GDALGenImgProjTransform, transformer, kApproximation_px);
    GDALApproxTransformerOwnsSubtransformer(options->pTransformerArg, TRUE);
  }
  std::array<double, 6> to_ground = grid_.to_ground;
  // It takes the transformer. Where it fails it may have destroyed it, so that it is not destroyed here.
  GDALDataset* made = GDALDataset::FromHandle(
      GDALCreateWarpedVRT(options->hSrcDS, grid_.width, grid_.height, to_ground.data(), options.get()));
  if (made == nullptr) {
    throw source_error(path_, "GDAL cannot warp it", scope.message(),
                       "warp it with gdalwarp first, and give the result");
  }
  // The deleter must be copyable.
  auto kept = std::make_shared<Pointer>(std::move(source));
  Pointer warped(made, [described, kept](GDALDataset* d) {
    close_dataset(d);
    described->reset();
    kept->reset();
  });
  describe_bands(*warped, dataset, bands);
  warped->SetSpatialRef(rpc_ ? &rpc_->crs : &points_->crs);
  return warped;
}

std::shared_ptr<const Placement> find_placement(const std::string& path, GDALDataset& dataset,
                                                const PlacementOptions& options, bool has_special_values) {
  const char* const* rpc = dataset.GetMetadata("RPC");
  if (dataset.GetGCPCount() == 0 && (rpc == nullptr || rpc[0] == nullptr)) return nullptr;
  return std::make_shared<const Placement>(path, dataset, options, has_special_values);
}

}  // namespace mars
