// Targets that read the metadata of panoramas, and the images themselves.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "panorama/image/big_tiff.h"
#include "panorama/image/metadata_error.h"
#include "panorama/image/raster_plane.h"
#include "panorama/image/row_source.h"
#include "panorama/image/tiled_image.h"
#include "panorama/image/xmp_file.h"
#include "panorama/metadata/auxiliary_files.h"
#include "panorama/metadata/gpano.h"
#include "panorama/metadata/label.h"
#include "panorama/metadata/open_panorama.h"
#include "panorama/metadata/sidecar.h"
#include "panorama/viewer/render_view.h"
#include "panorama/viewer/viewer.h"
#include "tests/fuzz/targets.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace fuzz {
namespace {

namespace fs = std::filesystem;

// Returns a folder of this process alone, in memory where the system has such a place.
const fs::path& scratch() {
  static const fs::path path = [] {
    const fs::path where = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : fs::temp_directory_path();
    static const fs::path kept = where / ("vpe-panorama-" + std::to_string(::getpid()));
    fs::create_directories(kept);
    std::atexit([] {
      std::error_code none;
      fs::remove_all(kept, none);
    });
    return kept;
  }();
  return path;
}

std::string text_of(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

// Requires a readable error message, whatever the file contains.
void check_words(const std::exception& error) {
  const std::string words = error.what();
  require(!words.empty() && words.size() < 2000, "a message for people");
}

void check_map(const panorama::PanoramaMap& map) {
  require(panorama::check(map).empty(), "maps that are read can be used");
  const panorama::Direction middle =
      map.to_direction(0.5 * static_cast<double>(map.width_px), 0.5 * static_cast<double>(map.height_px));
  require(middle.azimuth_deg >= 0 && middle.azimuth_deg < 360, "azimuths are 0 to 360");
  require(std::abs(middle.elevation_deg) <= 90, "elevations are -90 to 90");
  const panorama::Viewer viewer(map, 32, 16);
  require(std::isfinite(viewer.yaw_deg()) && std::abs(viewer.pitch_deg()) <= 90, "somebody can look there");
}

void check_same(const panorama::PanoramaMap& a, const panorama::PanoramaMap& b) {
  require(a.kind == b.kind && a.width_px == b.width_px && a.height_px == b.height_px && a.facets == b.facets,
          "maps survive being written");
  require(std::abs(a.turn_px - b.turn_px) <= 1e-9 * a.turn_px &&
              std::abs(a.focal_px - b.focal_px) <= 1e-9 * a.focal_px &&
              std::abs(a.horizon_px - b.horizon_px) <= 1e-9 * (1 + std::abs(a.horizon_px)),
          "the scale of maps survives being written");
}

// The first byte selects text labels (PDS3, VICAR) or PDS4.
void run_rover(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const std::string text = text_of(bytes.subspan(1));
  try {
    const auto label = bytes[0] % 2 == 0 ? panorama::read_text_label(text) : panorama::read_pds4_label(text);
    if (!label) return;
    require(label->columns_per_degree > 0 && label->rows_per_degree > 0, "scales are more than 0");
    check_map(panorama::map_of(*label, label->samples.value_or(1000), label->lines.value_or(500)));
  } catch (const panorama::MetadataError& error) {
    check_words(error);
  }
}

std::vector<Bytes> rover_seeds() {
  const std::string texts[] = {
      "PDS_VERSION_ID = PDS3\nOBJECT = IMAGE\n LINES = 1000\n LINE_SAMPLES = 7696\nEND_OBJECT = IMAGE\n"
      "GROUP = SURFACE_PROJECTION_PARMS\n MAP_PROJECTION_TYPE = \"CYLINDRICAL\"\n"
      " REFERENCE_COORD_SYSTEM_NAME = \"SITE_FRAME\"\n MAP_RESOLUTION = (21.3778 <pixels/degree>, 21.3778 "
      "<pixels/degree>)\n START_AZIMUTH = 0.0 <degrees>\n STOP_AZIMUTH = 360.0 <degrees>\n"
      " MAXIMUM_ELEVATION = 12.0 <degrees>\n MINIMUM_ELEVATION = -34.0 <degrees>\n"
      " ZERO_ELEVATION_LINE = 257.5\nEND_GROUP = SURFACE_PROJECTION_PARMS\nEND\n",
      "LBLSIZE=2048  FORMAT='HALF'  TYPE='IMAGE'  NL=600  NS=2000  NB=1  PROPERTY='SURFACE_PROJECTION_PARMS'  "
      "MAP_PROJECTION_TYPE='CYLINDRICAL'  REFERENCE_COORD_SYSTEM_NAME='LOCAL_LEVEL_FRAME'  "
      "MAP_RESOLUTION=(0.00305, 3.05)  MAP_RESOLUTION__UNIT=('rad/pixel', 'mrad/pixel')  START_AZIMUTH=1.5  "
      "START_AZIMUTH__UNIT='rad'  ZERO_ELEVATION_LINE=200.0  TASK='MARSMAP'  USER='it''s'  ",
      "<?xml version=\"1.0\"?><Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\" "
      "xmlns:cart=\"http://pds.nasa.gov/pds4/cart/v1\"><cart:Cartography><cart:Map_Projection_Lander>"
      "<cart:lander_map_projection_name>Cylindrical</cart:lander_map_projection_name><cart:Cylindrical>"
      "<cart:pixel_scale_x unit=\"pixel/deg\">20</cart:pixel_scale_x><cart:pixel_scale_y unit=\"pixel/deg\">"
      "20</cart:pixel_scale_y><cart:maximum_elevation unit=\"deg\">10</cart:maximum_elevation>"
      "<cart:minimum_elevation unit=\"deg\">-20</cart:minimum_elevation><cart:start_azimuth unit=\"deg\">30"
      "</cart:start_azimuth><cart:stop_azimuth unit=\"deg\">90</cart:stop_azimuth><cart:zero_elevation_line>"
      "201</cart:zero_elevation_line></cart:Cylindrical></cart:Map_Projection_Lander></cart:Cartography>"
      "<Array_2D_Image><Axis_Array><axis_name>Line</axis_name><elements>600</elements></Axis_Array>"
      "<Axis_Array><axis_name>Sample</axis_name><elements>1200</elements></Axis_Array></Array_2D_Image>"
      "</Product_Observational>"};
  std::vector<Bytes> all;
  for (const std::string& text : texts) {
    Bytes seed{static_cast<std::uint8_t>(text.starts_with("<"))};
    seed.insert(seed.end(), text.begin(), text.end());
    all.push_back(seed);
  }
  return all;
}

void run_gpano(std::span<const std::uint8_t> bytes) {
  try {
    const auto gpano = panorama::read_gpano(text_of(bytes));
    if (!gpano) return;
    // What XML cannot hold is left out the first time.
    const auto written = panorama::read_gpano(panorama::to_xmp(*gpano));
    require(written.has_value() && panorama::read_gpano(panorama::to_xmp(*written)) == written,
            "fields survive being written");
    const panorama::PanoramaMap map = panorama::map_of(*gpano);
    check_map(map);
    check_same(map, panorama::map_of(panorama::gpano_of(map)));
  } catch (const panorama::MetadataError& error) {
    check_words(error);
  }
}

std::vector<Bytes> gpano_seeds() {
  panorama::GPano round = panorama::gpano_of(panorama::cylinder_map(700, 200, 700.0, 10.0, 120.0));
  round.capture_software = "a & b";
  round.interior_left_px = 3;
  const std::string by_attributes =
      "<x:xmpmeta xmlns:x='adobe:ns:meta/'><r:RDF xmlns:r='http://www.w3.org/1999/02/22-rdf-syntax-ns#'>"
      "<r:Description xmlns:P='http://ns.google.com/photos/1.0/panorama/' P:ProjectionType='equirectangular' "
      "P:CroppedAreaImageWidthPixels='400' P:CroppedAreaImageHeightPixels='100' P:FullPanoWidthPixels='800' "
      "P:FullPanoHeightPixels='400' P:CroppedAreaLeftPixels='10' P:CroppedAreaTopPixels='150' "
      "P:PoseHeadingDegrees='12.5' P:UsePanoramaViewer='True'/></r:RDF></x:xmpmeta>";
  return {bytes_of(panorama::to_xmp(round)), bytes_of(by_attributes)};
}

void run_sidecar(std::span<const std::uint8_t> bytes) {
  const std::string text = text_of(bytes);
  try {
    panorama::read_auxiliary_files(text);
  } catch (const panorama::MetadataError& error) {
    check_words(error);
  }
  try {
    const panorama::Sidecar sidecar = panorama::read_sidecar(text);
    check_map(sidecar.map);
    const panorama::Sidecar again = panorama::read_sidecar(panorama::to_text(sidecar));
    require(again.image == sidecar.image && again.viewpoint == sidecar.viewpoint,
            "stations survive being written");
    check_same(sidecar.map, again.map);
  } catch (const panorama::MetadataError& error) {
    check_words(error);
  }
}

std::vector<Bytes> sidecar_seeds() {
  const std::string start = "{\"image\": \"p.png\", \"width\": 600, \"height\": 200, ";
  const std::string texts[] = {
      start +
          "\"projection\": \"cylinder\", \"azimuth_deg_at_left\": -180, \"degrees_per_pixel\": 0.6, "
          "\"horizon_row\": 120, \"pose\": {\"lon_deg\": 137.37, \"lat_deg\": -4.668, \"height_m\": 2, "
          "\"ground_m\": -4446.8, \"datum\": \"areoid\"}, \"stereo\": \"ou\", \"planes\": {\"range\": "
          "{\"file\": \"p.range.tif\"}, \"lonlat\": \"p.lonlat.tif\"}}",
      start +
          "\"projection\": \"facets\", \"facets\": 8, \"start_yaw_deg\": 10, \"columns_per_turn\": 640, "
          "\"crop_left_px\": 20, \"elevation_deg_at_top\": 30}",
      start +
          "\"projection\": \"equirectangular\", \"azimuth_deg_at_left\": 350, \"azimuth_deg_at_right\": 20, "
          "\"elevation_deg_at_top\": 12, \"elevation_deg_at_bottom\": -5}",
      start +
          "\"projection\": \"cylindrical (even)\", \"azimuth_deg_at_sample_0\": 0.3, \"columns_per_turn\": "
          "600, \"elevation_deg_at_line_0\": 20, \"elevation_deg_per_line\": -0.2, \"rover\": "
          "{\"lon_deg_east\": 137, \"lat_deg\": -4, \"elevation_m_areoid\": -4400}}"};
  std::vector<Bytes> all;
  for (const std::string& text : texts) all.push_back(bytes_of(text));
  return all;
}

void describe(const fs::path& path) {
  try {
    check_map(panorama::describe(path).map);
  } catch (const vpe::base::FileError& error) {
    check_words(error);
  }
}

void look_at(const fs::path& path, const panorama::ImageFileHeader& header) {
  try {
    panorama::TiledImageOptions options;
    options.budget_bytes = std::size_t{8} << 20;
    const auto tiled_image = panorama::open_tiled_image(path, header.format, options);
    const panorama::ImageLevel size = tiled_image->levels().front();
    require(size.width_px == header.width_px && size.height_px == header.height_px, "one size");
    const panorama::PanoramaMap map =
        panorama::cylinder_map(size.width_px, size.height_px, static_cast<double>(size.width_px), 0.0,
                               0.5 * static_cast<double>(size.height_px));
    if (!panorama::check(map).empty()) return;
    panorama::RenderViewOptions view_options;
    view_options.threads = 1;
    panorama::render_view(*tiled_image, map, panorama::Viewer(map, 16, 8).view(), view_options);
  } catch (const vpe::base::FileError& error) {
    check_words(error);
  }
}

// Reads a file as images larger than memory are read, and as planes.
void read_parts(const fs::path& path, const panorama::ImageFileHeader& header) {
  constexpr std::int64_t kMaxPixels = 1 << 20;
  try {
    const auto rows = panorama::open_rows(path, header.format, std::size_t{1} << 22);
    if (rows->width_px() > kMaxPixels / rows->height_px()) return;
    std::vector<vpe::base::Rgb> row(static_cast<std::size_t>(rows->width_px()));
    for (std::int64_t y = 0; y < rows->height_px(); ++y) rows->read(row);
  } catch (const vpe::base::FileError& error) {
    check_words(error);
  }
  try {
    if (header.format != panorama::ImageFileFormat::kTiff) return;
    const panorama::RasterPlane plane(path, header.width_px, header.height_px);
    require(!plane.at(header.width_px - 1, header.height_px - 1).empty(), "planes have bands");
  } catch (const vpe::base::FileError& error) {
    check_words(error);
  }
}

void put_packet(std::span<const std::uint8_t> bytes) {
  try {
    const panorama::ImageFileHeader header = panorama::read_image_header(bytes);
    const Bytes with_packet = panorama::with_xmp(bytes, "<a>packet</a>");
    const panorama::ImageFileHeader again = panorama::read_image_header(with_packet);
    require(again.xmp == "<a>packet</a>" && again.width_px == header.width_px &&
                again.height_px == header.height_px,
            "packets are read back");
  } catch (const panorama::MetadataError& error) {
    check_words(error);
  }
}

void run_image(std::span<const std::uint8_t> bytes) {
  const fs::path path = scratch() / "p.img";
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text_of(bytes);
  describe(path);
  put_packet(bytes);
  panorama::ImageFileHeader header;
  try {
    header = panorama::read_image_header(path);
  } catch (const vpe::base::FileError& error) {
    return check_words(error);
  }
  look_at(path, header);
  read_parts(path, header);
}

std::vector<Bytes> image_seeds() {
  constexpr int kWidth = 40;
  constexpr int kHeight = 24;
  std::vector<vpe::base::Rgb> pixels(std::size_t{kWidth} * kHeight);
  for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = {static_cast<std::uint8_t>(n), 90, 200};
  const std::string packet =
      panorama::to_xmp(panorama::gpano_of(panorama::cylinder_map(kWidth, kHeight, kWidth, 10.0, 12.0)));
  const Bytes png = vpe::core::encode_png(pixels, kWidth, kHeight);
  const Bytes jpeg = vpe::core::encode_jpeg(pixels, kWidth, kHeight, 80);
  std::vector<Bytes> all{png, jpeg, panorama::with_xmp(png, packet), panorama::with_xmp(jpeg, packet)};
  // TIFF: one of this program in tiles, and one in rows.
  const fs::path path = scratch() / "seed.tif";
  {
    vpe::base::OutputFile file(path);
    panorama::BigTiffTags tags;
    tags.xmp = packet;
    panorama::BigTiffWriter writer(file, kWidth, kHeight, panorama::kRgb, tags);
    Bytes tile(panorama::kRgb.tile_bytes());
    for (std::size_t n = 0; n < tile.size(); ++n) tile[n] = static_cast<std::uint8_t>(n / 97);
    writer.put(0, 0, panorama::pack_tile(tile, panorama::kRgb));
    writer.finish();
    file.commit();
  }
  all.push_back(vpe::base::read_file(path, 1 << 24));
  vpe::core::write_tiff(path, std::vector<float>(pixels.size(), 1.5F), kWidth, kHeight, {});
  all.push_back(vpe::base::read_file(path, 1 << 24));
  return all;
}

}  // namespace

const Target kRover{"rover", run_rover, rover_seeds};
const Target kGpano{"gpano", run_gpano, gpano_seeds};
const Target kSidecar{"sidecar", run_sidecar, sidecar_seeds};
const Target kImage{"image", run_image, image_seeds};

}  // namespace fuzz
