#include <gdal_priv.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/pds_image.h"
#include "mars/raster/pds_map.h"
#include "mars/sources/own_light.h"
#include "tests/fuzz/targets.h"

namespace fuzz {
namespace {

namespace fs = std::filesystem;

const std::string& scratch() {
  static const std::string path = [] {
    const fs::path folder = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : fs::temp_directory_path();
    static const std::string kept = (folder / ("vpe-label-" + std::to_string(::getpid()) + ".img")).string();
    std::atexit([] {
      std::error_code none;
      fs::remove(kept, none);
    });
    return kept;
  }();
  return path;
}

void check_place(const mars::LabelGeoreference& place) {
  require(!place.crs.empty() && place.to_map.has_value(), "a map is a whole map");
  require((*place.to_map)[1] > 0 && (*place.to_map)[5] < 0, "east to the right, north up");
  if (place.grid) require(place.grid->pixels_per_degree > 0, "grids have a resolution");
  if (place.centric_scale) require(*place.centric_scale > 0, "latitudes keep their sign");
}

void run_parts(const mars::PdsLabel& label) {
  for (const auto& [key, value] : label.values) {
    const auto number = label.number(key);
    require(!number || std::isfinite(*number), "numbers are finite");
  }
  mars::pds_placement(label);
  mars::gdal_misreads(label);
  mars::pds_nodata(label);
  mars::says_own_light(std::vector<mars::LabelKeyword>(label.values.begin(), label.values.end()));
  try {
    if (const auto place = mars::pds_map(scratch(), label)) check_place(*place);
  } catch (const mars::SourceError&) {
  }
  try {
    check_place(mars::pds_catalog_map(scratch(), label));
  } catch (const mars::SourceError&) {
  }
  if (!mars::has_pds_image(label)) return;
  try {
    const mars::PdsImage image = mars::pds_image(scratch(), label);
    const mars::GdalScope scope;
    GDALDataset* dataset = GDALDataset::FromHandle(GDALOpen(mars::pds_vrt(image).c_str(), GA_ReadOnly));
    require(dataset != nullptr, "GDAL opens what we take for an image");
    std::vector<double> line(static_cast<std::size_t>(image.columns));
    const CPLErr read = dataset->GetRasterBand(image.bands)
                            ->RasterIO(GF_Read, 0, image.rows - 1, image.columns, 1, line.data(), image.columns,
                                       1, GDT_Float64, 0, 0, nullptr);
    require(read == CE_None, "the last line is there");
    GDALClose(dataset);
  } catch (const mars::SourceError&) {
  }
}

// The first byte selects the parts of the label reader, or opening the file as a user does.
void run_label(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const bool whole = bytes[0] % 2 == 1;
  const std::string text(bytes.begin() + 1, bytes.end());
  std::ofstream(scratch(), std::ios::binary | std::ios::trunc) << text;
  if (!whole) {
    run_parts(mars::parse_pds_label(text));
    return;
  }
  try {
    const mars::GdalRaster raster(scratch());
    require(raster.georeference().resolution_m() > 0, "pixels have a size");
  } catch (const mars::SourceError& error) {
    require(error.what() != std::string(), "words");
  }
}

std::string image_object(const std::string& more) {
  return "OBJECT = IMAGE\n LINES = 4\n LINE_SAMPLES = 6\n SAMPLE_TYPE = MSB_INTEGER\n SAMPLE_BITS = 16\n" +
         more + "END_OBJECT = IMAGE\n";
}

std::vector<Bytes> label_seeds() {
  const std::string axes =
      " A_AXIS_RADIUS = 3396.19 <KM>\n B_AXIS_RADIUS = 3396.19 <KM>\n C_AXIS_RADIUS = 3376.2 <KM>\n";
  const std::string modern = "PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = 12\n^IMAGE = ";
  const auto map = [&](const std::string& type, const std::string& more) {
    return "OBJECT = IMAGE_MAP_PROJECTION\n MAP_PROJECTION_TYPE = \"" + type + "\"\n" + axes +
           " CENTER_LATITUDE = 20.0\n CENTER_LONGITUDE = 70.0 <DEGREE>\n MAP_RESOLUTION = 64.0 <PIXEL/DEGREE>\n"
           " MAP_SCALE = 0.925 <KM/PIXEL>\n LINE_PROJECTION_OFFSET = 12.5\n SAMPLE_PROJECTION_OFFSET = -3.5\n" +
           more + "END_OBJECT = IMAGE_MAP_PROJECTION\nEND\n";
  };
  const std::string first =
      "CCSD3ZF0000100000001NJPL3IF0PDS200000001 = SFDU_LABEL\nRECORD_TYPE = FIXED_LENGTH\n"
      "RECORD_BYTES = 12\n^IMAGE = 8 <BYTES>\nDATA_SET_ID = \"VO1/VO2-M-VIS-5-DIM-V1.0\"\n";
  const std::string texts[] = {
      modern + "1\n" + image_object("") + map("SINUSOIDAL", " POSITIVE_LONGITUDE_DIRECTION = WEST\n"),
      modern + "(\"A.IMG\", 3 <BYTES>)\n" +
          image_object(" LINE_PREFIX_BYTES = 2\n LINE_SUFFIX_BYTES = 1\n MISSING_CONSTANT = 16#FF7FFFFB#\n") +
          map("POLAR_STEREOGRAPHIC", " COORDINATE_SYSTEM_NAME = PLANETOGRAPHIC\n"),
      modern + "9 <BYTES>\n" + image_object(" BANDS = 2\n BAND_STORAGE_TYPE = LINE_INTERLEAVED\n") +
          map("LAMBERT CONFORMAL", " FIRST_STANDARD_PARALLEL = 10.0\n SECOND_STANDARD_PARALLEL = 50\n"),
      modern + "1\n" + image_object("") +
          map("SIMPLE CYLINDRICAL", " MAXIMUM_LATITUDE = 0.1875\n WESTERNMOST_LONGITUDE = 0.0 /* so */\n"),
      first + image_object(" SCALING_FACTOR = 0.5\n OFFSET = -8000\n UNIT = METER\n") +
          "OBJECT = IMAGE_MAP_PROJECTION_CATALOG\n MAP_PROJECTION_TYPE = SINUSOIDAL\n MAP_RESOLUTION = "
          "64<PIXEL/DEG>\n MAXIMUM_LATITUDE = -27.5\n X_AXIS_PROJECTION_OFFSET = -1760.000\n "
          "Y_AXIS_PROJECTION_OFFSET = 141.922\n CENTER_LONGITUDE = 317.5\n POSITIVE_LONGITUDE_DIRECTION = "
          "WEST\n" +
          axes + "END_OBJECT = IMAGE_MAP_PROJECTION_CATALOG\nEND\n"};
  std::vector<Bytes> all;
  for (const std::string& text : texts) {
    for (const std::uint8_t kind : {std::uint8_t{0}, std::uint8_t{1}}) {
      Bytes seed{kind};
      seed.insert(seed.end(), text.begin(), text.end());
      seed.insert(seed.end(), 60, std::uint8_t{7});
      all.push_back(seed);
    }
  }
  return all;
}

}  // namespace

const Target kLabel{"label", run_label, label_seeds};

}  // namespace fuzz
