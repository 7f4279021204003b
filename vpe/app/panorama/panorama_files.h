// The files of a panorama: image, planes and sidecar, joined from strips.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "panorama/image/strip_file.h"
#include "panorama/planes.h"
#include "panorama/projection.h"
#include "panorama/stereo_pieces.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

enum class PanoramaFormat : std::uint8_t { kTiff, kPng, kJpeg };

// By the extension. Throws std::runtime_error for others, and check_output()'s.
PanoramaFormat panorama_format(const std::filesystem::path& path);

// Throws std::runtime_error when the format cannot hold the size.
void check_panorama_size(const std::filesystem::path& path, const panorama::ImageSize& size, int memory_mb);

std::filesystem::path plane_file(const std::filesystem::path& image, panorama::Plane plane);
std::filesystem::path sidecar_file(const std::filesystem::path& image);
// Throws std::runtime_error when the sidecar's name is taken by a file that this program did not write.
void check_sidecar(const std::filesystem::path& image);
// Removes what killed runs left half-written of the image, its planes and sidecar.
void remove_stale_files(const std::filesystem::path& image);
// Where strips are kept until all are there.
std::filesystem::path strips_folder(const std::filesystem::path& image);

// What the blocks of a strip are, in this order: the report of its pieces; the image, as tiles row by row
// (TIFF) or as bands of rows; each plane's tiles.
struct StripLayout {
  static constexpr std::int64_t kBandRows = 64;

  bool in_tiles = false;  // of the image
  std::int64_t tiles_across = 0;
  std::int64_t tiles_down = 0;
  std::int64_t bands = 0;
  std::size_t planes = 0;

  std::size_t tiles() const { return static_cast<std::size_t>(tiles_across * tiles_down); }
  std::size_t image_blocks() const { return in_tiles ? tiles() : static_cast<std::size_t>(bands); }
  std::size_t blocks() const { return 1 + image_blocks() + planes * tiles(); }
};
StripLayout layout_of(PanoramaFormat format, std::int64_t height_px, const panorama::Strip& strip,
                      std::size_t planes);

struct PanoramaJob {
  std::filesystem::path output;
  PanoramaFormat format = PanoramaFormat::kTiff;
  panorama::PanoramaMap map;  // of one eye
  panorama::ImageSize size;   // of the file
  bool is_red_cyan = false;   // two eyes in one image
  bool has_gpano = false;     // where GPano can describe the map
  std::vector<panorama::Strip> strips;
  std::vector<panorama::Plane> planes;
  std::string software;
  std::string sidecar;  // JSON
};

// Writes planes, image and sidecar, each under a temporary name until all are complete. `done` is called with
// the share that is ready and may throw. Throws base::FileError.
void join_strips(const PanoramaJob& job, const std::vector<panorama::StripFile>& strips, base::ThreadPool& pool,
                 const std::function<void(double)>& done);

}  // namespace vpe::app
