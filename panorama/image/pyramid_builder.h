// Smaller copies of an image: in memory, or in a folder of files. Private to panorama.
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

// Said now and then with what is done, 0 to 1; may throw to stop the work.
using TiledImageProgress = std::function<void(double fraction)>;

// Levels down to one whose sides are at most this.
inline constexpr std::int64_t kCoarsestSide_px = 256;

// Rows of level 0 in, rows of every level out, as soon as they are known.
class PyramidBuilder {
 public:
  using Sink = std::function<void(std::span<const vpe::base::Rgb>)>;
  // Called for level 0, 1, ...; an empty sink is a level that nobody wants.
  using MakeSink = std::function<Sink(int level, std::int64_t width_px, std::int64_t height_px)>;

  PyramidBuilder(std::int64_t width_px, std::int64_t height_px, const MakeSink& make);
  void take(std::span<const vpe::base::Rgb> row) { pass(0, row); }

 private:
  void pass(std::size_t level, std::span<const vpe::base::Rgb> row);

  std::vector<Sink> sinks_;
  std::vector<std::unique_ptr<BoxDownsampler>> downsamplers_;
};

// All levels in memory, each of them one tile: 4 bytes a pixel of the image.
std::unique_ptr<TileSource> memory_pyramid(RowSource& rows);

// Writes level first_level and all smaller ones as `folder`/level-K.tif, tiled, lossless. What is written
// appears under that name only when it is complete; a folder that is there by then is left as it is. Memory:
// max_bytes and the rows' own. Throws vpe::base::FileError, as for a full disk.
void write_pyramid(const std::filesystem::path& folder, RowSource& rows, int first_level, std::size_t max_bytes,
                   const TiledImageProgress& progress);

// The pages of such a folder, largest first; empty when it is not there. Throws vpe::base::FileError.
std::vector<TiffPage> pyramid_pages(const std::filesystem::path& folder);

}  // namespace panorama
