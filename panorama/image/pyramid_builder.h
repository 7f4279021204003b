// Smaller copies of an image, in memory or in a folder of files. Private to panorama.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "panorama/image/box_downsampler.h"
#include "panorama/image/row_source.h"
#include "panorama/image/tiff_tiles.h"

namespace panorama {

// Receives the finished fraction now and then; may throw to stop the work.
using TiledImageProgress = std::function<void(double fraction)>;

// Sides of the smallest level are at most this.
inline constexpr std::int64_t kCoarsestSide_px = 256;

// Takes the rows of level 0 and passes the rows of every level on as soon as they are known. For one thread.
class PyramidBuilder {
 public:
  using Sink = std::function<void(std::span<const vpe::base::Rgb>)>;
  // Returns the receiver of a level's rows; an empty function when the level is not needed. Called for level 0,
  // 1, ...
  using MakeSink = std::function<Sink(int level, std::int64_t width_px, std::int64_t height_px)>;

  PyramidBuilder(std::int64_t width_px, std::int64_t height_px, const MakeSink& make);
  // Takes the next row of level 0.
  void take(std::span<const vpe::base::Rgb> row) { pass(0, row); }

 private:
  void pass(std::size_t level, std::span<const vpe::base::Rgb> row);

  std::vector<Sink> sinks_;
  std::vector<std::unique_ptr<BoxDownsampler>> downsamplers_;
};

// Returns all levels in memory, each as one tile: 4 bytes a pixel of the image.
std::unique_ptr<TileSource> memory_pyramid(RowSource& rows);

// Writes level first_level and all smaller ones as `folder`/level-K.tif, tiled, lossless. The folder appears
// only when it is complete; one that another process has made by then is left as it is. Memory: max_bytes and
// that of `rows`. Throws vpe::base::FileError, as for a full disk.
void write_pyramid(const std::filesystem::path& folder, RowSource& rows, int first_level, std::size_t max_bytes,
                   const TiledImageProgress& progress);

// Returns the pages of such a folder, largest first; none when the folder is not there. Throws
// vpe::base::FileError.
std::vector<TiffPage> pyramid_pages(const std::filesystem::path& folder);

}  // namespace panorama
