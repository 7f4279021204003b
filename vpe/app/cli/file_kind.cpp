#include "vpe/app/cli/file_kind.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>

#include "paging/planet/planet_meta.h"
#include "paging/planet/sqlite.h"
#include "vpe/core/image/tiff_handle.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHeadBytes = 8192;

std::string head_of(const fs::path& file) {
  std::string bytes(kHeadBytes, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_png(std::string_view head) { return head.starts_with("\x89PNG\r\n\x1a\n"); }
bool is_jpeg(std::string_view head) { return head.starts_with("\xff\xd8\xff"); }
bool is_json(std::string_view head) {
  const std::size_t begin = head.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && head[begin] == '{';
}

core::TiffHandle open_tiff(const fs::path& file) { return {file, "rm", core::TiffHandle::kMaxTableBytes}; }

bool is_own_tiff(const core::TiffHandle& tiff) {
  const char* software = nullptr;
  return tiff.get() != nullptr && TIFFGetField(tiff.get(), TIFFTAG_SOFTWARE, &software) == 1 &&
         std::string_view(software).starts_with("vpe ");
}

bool is_range_tiff(const fs::path& file) {
  const core::TiffHandle tiff = open_tiff(file);
  if (tiff.get() == nullptr) return false;
  std::uint16_t bits = 0;
  std::uint16_t samples = 0;
  std::uint16_t format = 0;
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &format);
  if (bits != 32 || samples != 1 || format != SAMPLEFORMAT_IEEEFP) return false;
  if (is_own_tiff(tiff)) return TIFFIsTiled(tiff.get()) == 0;  // layers of panoramas are tiled
  // Older versions wrote no tags. ModelPixelScale, ModelTiepoint, ModelTransformation and GeoKeyDirectory of GeoTIFF; nodata of GDAL.
  constexpr std::array<std::uint32_t, 5> kForeignTags{33550, 33922, 34264, 34735, 42113};
  return std::none_of(kForeignTags.begin(), kForeignTags.end(), [&](std::uint32_t tag) {
    std::uint32_t count = 0;
    const void* data = nullptr;
    return TIFFGetField(tiff.get(), tag, &count, &data) == 1;
  });
}

bool is_own_geopackage(const fs::path& file) {
  try {
    paging::Database db(file.string(), paging::Database::Mode::kReadOnly);
    return db.integer("SELECT count(*) FROM gpkg_contents WHERE description LIKE 'vpe %'") > 0;
  } catch (const paging::DatabaseError&) {
    return false;
  }
}

bool is_map_tiff(const fs::path& file) {
  constexpr std::uint32_t kGeoKeys = 34735;
  const core::TiffHandle tiff = open_tiff(file);
  std::uint32_t count = 0;
  const void* data = nullptr;
  return is_own_tiff(tiff) && TIFFGetField(tiff.get(), kGeoKeys, &count, &data) == 1;
}

// Returns true if the manifest of this film lies beside it, or segments that it was joined from.
bool is_own_video(const fs::path& film) {
  std::error_code none;
  return is_of_kind(film.string() + ".json", FileKind::kManifest) ||
         fs::exists(film.string() + ".parts/segment_000000.json", none);
}

}  // namespace

const char* name_of(FileKind kind) {
  switch (kind) {
    case FileKind::kImage: return "a PNG or JPEG image";
    case FileKind::kRange: return "a range image";
    case FileKind::kPanorama: return "an image that 'vpe panorama' can have made";
    case FileKind::kPanoramaPlane: return "a layer of 'vpe panorama'";
    case FileKind::kCertificate: return "a certificate of vpe";
    case FileKind::kExplanation: return "a file of --explain-lod";
    case FileKind::kSkyline: return "a skyline of 'vpe horizon'";
    case FileKind::kLandmarks: return "a list of features of 'vpe horizon'";
    case FileKind::kLandscape: return "a landscape.ini of 'vpe horizon'";
    case FileKind::kHorizonList: return "a skyline of 'vpe horizon'";
    case FileKind::kStatistics: return "statistics of 'vpe fly'";
    case FileKind::kFlightLog: return "a log of vpe";
    case FileKind::kTraverse: return "a traverse of vpe";
    case FileKind::kFrame: return "a frame of 'vpe fly'";
    case FileKind::kManifest: return "a manifest of 'vpe fly'";
    case FileKind::kVideo: return "a film of 'vpe fly' with its manifest";
    case FileKind::kPlanet: return "a planet file of vpe";
    case FileKind::kSticks: return "a model of sticks of vpe";
    case FileKind::kVolume: return "a volume of vpe";
    case FileKind::kPlanetPage: return "a page of 'vpe info'";
    case FileKind::kPlot: return "an SVG file";
    case FileKind::kMap: return "a map of vpe";
    case FileKind::kFeatures: return "GeoJSON or a GeoPackage of vpe";
  }
  return "";
}

bool is_of_kind(const fs::path& file, FileKind kind) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return false;
  const std::string head = head_of(file);
  switch (kind) {
    case FileKind::kImage: return is_png(head) || is_jpeg(head);
    case FileKind::kRange: return is_range_tiff(file);
    case FileKind::kPanorama: return is_png(head) || is_jpeg(head) || is_own_tiff(open_tiff(file));
    case FileKind::kPanoramaPlane: return is_own_tiff(open_tiff(file));
    case FileKind::kCertificate: return is_json(head) && contains(head, "\"shift_bound_px\"");
    case FileKind::kExplanation: return is_json(head) && contains(head, "\"budget_spent\"");
    case FileKind::kSkyline: return head.starts_with("azimuth_deg,elevation_deg,");
    case FileKind::kLandmarks: return head.starts_with("name,lon_deg,lat_deg,");
    case FileKind::kLandscape: return contains(head, "\nauthor = vpe\n");
    case FileKind::kHorizonList: return head.starts_with("# azimuth (clockwise from north)");
    case FileKind::kStatistics: return head.starts_with("frame,t_s,") || head.starts_with("{\"frame\":");
    case FileKind::kFlightLog:
      return head.starts_with("flight 1\n# log of vpe") || head.starts_with("flight 1.1\n# log of vpe");
    case FileKind::kTraverse: return head.starts_with("flight 1\n# traverse of vpe");
    case FileKind::kFrame: return is_png(head) && contains(head, "vpe:fingerprint");
    case FileKind::kManifest: return is_json(head) && contains(head, "\"program\": \"vpe ");
    case FileKind::kVideo: return contains(std::string_view(head).substr(0, 12), "ftyp") && is_own_video(file);
    case FileKind::kPlanet: return paging::is_planet_file(file.string());
    case FileKind::kSticks: return head.starts_with("VPESTICK");
    case FileKind::kVolume: return head.starts_with("VPEVOLUM");
    case FileKind::kPlot: return contains(head, "<svg");
    case FileKind::kMap: return is_map_tiff(file);
    case FileKind::kFeatures:
      return (contains(head, "\"FeatureCollection\"") && contains(head, "\"vpe ")) || is_own_geopackage(file);
    case FileKind::kPlanetPage:
      return head.starts_with("<!DOCTYPE html>") && contains(head, "\"generator\" content=\"vpe info\"");
  }
  return false;
}

}  // namespace vpe::app
