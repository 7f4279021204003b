#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "panorama/image/pyramid_builder.h"
#include "panorama/image/tiled_image.h"
#include "vpe/core/image/image.h"

namespace panorama {

namespace {

namespace fs = std::filesystem;
using vpe::base::file_error;

// Increase it when copies are made in another way.
constexpr int kCopyGeneration = 1;
// Larger tiles would make views slow.
constexpr std::size_t kMaxTileBytes = std::size_t{4} << 20;
// Limits the smallest level, which is read whole when all of an image is in view.
constexpr std::int64_t kMaxCoarsestPixels = std::int64_t{1} << 23;
// Memory while a PNG is decoded: the file, RGBA and RGB at once, then the smaller copies.
constexpr std::int64_t kUnpackBytesAPixel = 9;

std::int64_t pixels_of(const ImageLevel& level) { return level.width_px * level.height_px; }

// Reads rows of an image in memory.
class ImageRows : public RowSource {
 public:
  explicit ImageRows(vpe::core::RgbImage image) : image_(std::move(image)) {}
  std::int64_t width_px() const override { return image_.width; }
  std::int64_t height_px() const override { return image_.height; }
  void read(std::span<vpe::base::Rgb> row) override {
    std::copy_n(image_.pixels.begin() + next_, row.size(), row.begin());
    next_ += static_cast<std::ptrdiff_t>(row.size());
  }

 private:
  vpe::core::RgbImage image_;
  std::ptrdiff_t next_ = 0;
};

// Returns a name that is the same in every run and version, by FNV-1a.
std::string name_of_copies(const fs::path& path) {
  const std::string text = fs::canonical(path).string() + "|" + std::to_string(fs::file_size(path)) + "|" +
                           std::to_string(fs::last_write_time(path).time_since_epoch().count()) + "|" +
                           std::to_string(kCopyGeneration);
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001b3;
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash));
  return std::string(digits.data()) + ".levels";
}

// Returns whether copies begin with the right level and each is half of the one before.
bool are_whole(const std::vector<TiffPage>& pages, const ImageLevel& size, int first_level) {
  std::int64_t width_px = first_level > 0 ? half_px(size.width_px) : size.width_px;
  std::int64_t height_px = first_level > 0 ? half_px(size.height_px) : size.height_px;
  for (const TiffPage& page : pages) {
    if (page.level.width_px != width_px || page.level.height_px != height_px) return false;
    width_px = half_px(width_px);
    height_px = half_px(height_px);
  }
  return !pages.empty();
}

// Removes unfinished copies of killed processes.
void remove_old_drafts(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const auto age = fs::file_time_type::clock::now() - fs::last_write_time(entry->path(), ignored);
    if (!ignored && entry->path().extension() == ".tmp" && age > std::chrono::hours(24))
      fs::remove_all(entry->path(), ignored);
  }
}

// Returns the pages of the copies, and makes them when they are not there.
std::vector<TiffPage> copies(const fs::path& path, ImageFileFormat format, const ImageLevel& size,
                             int first_level, const TiledImageOptions& options) {
  if (!options.cache_folder) {
    throw file_error("read", path, "it does not fit into memory, and there is no folder for copies of it",
                     "give more --memory");
  }
  const fs::path folder = options.cache_folder() / name_of_copies(path);
  if (fs::is_directory(folder)) {
    if (auto pages = pyramid_pages(folder); are_whole(pages, size, first_level)) return pages;
    fs::remove_all(folder);
  }
  remove_old_drafts(options.cache_folder());
  // Lossless copies of photographs take at most as much as the pixels, and a third more for the smaller levels.
  const std::int64_t needed_bytes = pixels_of(size) * (first_level > 0 ? 1 : 4);
  std::error_code error;
  const fs::space_info space = fs::space(options.cache_folder(), error);
  if (!error && static_cast<std::uintmax_t>(needed_bytes) > space.available) {
    throw file_error("read", path,
                     "tiled copies of it may take " + std::to_string(needed_bytes >> 20) + " MB in '" +
                         options.cache_folder().string() + "', where " + std::to_string(space.available >> 20) +
                         " MB are free",
                     "make room, set XDG_CACHE_HOME to another disk, or convert the image: "
                     "gdal_translate -of COG IN OUT.tif");
  }
  const std::size_t share = options.budget_bytes / 2;
  const auto rows = open_rows(path, format, share);
  write_pyramid(folder, *rows, first_level, share, options.progress);
  return pyramid_pages(folder);
}

// Returns whether the image and its reduced copies can be read tile by tile as they are.
bool has_usable_levels(const std::vector<TiffPage>& pages) {
  return pixels_of(pages.back().level) <= kMaxCoarsestPixels &&
         std::all_of(pages.begin(), pages.end(), [](const TiffPage& page) {
           return page.is_tiled && tile_bytes(page.level) <= kMaxTileBytes;
         });
}

std::unique_ptr<TileSource> open_tiff(const fs::path& path, const TiledImageOptions& options) {
  std::vector<TiffPage> pages = list_pages(path);
  if (pages.size() > 1 && has_usable_levels(pages)) return std::make_unique<TiffTiles>(pages);
  const TiffPage full = pages.front();
  const std::int64_t unpacked_bytes = pixels_of(full.level) * kUnpackBytesAPixel;
  if (unpacked_bytes <= static_cast<std::int64_t>(options.budget_bytes)) {
    const auto rows = open_rows(path, ImageFileFormat::kTiff, options.budget_bytes);
    return memory_pyramid(*rows);
  }
  const bool keep_full = full.is_tiled && tile_bytes(full.level) <= kMaxTileBytes;
  std::vector<TiffPage> smaller = copies(path, ImageFileFormat::kTiff, full.level, keep_full ? 1 : 0, options);
  if (keep_full) smaller.insert(smaller.begin(), full);
  return std::make_unique<TiffTiles>(std::move(smaller));
}

std::unique_ptr<TileSource> open_coded(const fs::path& path, ImageFileFormat format,
                                       const TiledImageOptions& options) {
  const ImageFileHeader header = read_image_header(path);
  ImageLevel size;
  size.width_px = header.width_px;
  size.height_px = header.height_px;
  const std::int64_t most_pixels = static_cast<std::int64_t>(options.budget_bytes) / kUnpackBytesAPixel;
  if (std::max(size.width_px, size.height_px) <= vpe::core::kMaxImageSide_px &&
      pixels_of(size) <= most_pixels) {
    ImageRows rows(vpe::core::read_image(path, most_pixels));
    return memory_pyramid(rows);
  }
  return std::make_unique<TiffTiles>(copies(path, format, size, 0, options));
}

}  // namespace

std::unique_ptr<TiledImage> open_tiled_image(const fs::path& path, ImageFileFormat format,
                                             const TiledImageOptions& options) {
  TiledImageOptions limited = options;
  limited.budget_bytes = std::max(options.budget_bytes, TiledImageOptions::kMinBudget_bytes);
  auto source = format == ImageFileFormat::kTiff ? open_tiff(path, limited) : open_coded(path, format, limited);
  // The other half is for tiles that threads hold.
  return std::make_unique<TiledImage>(std::move(source), limited.budget_bytes / 2);
}

}  // namespace panorama
