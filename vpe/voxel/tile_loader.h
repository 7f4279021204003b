// Loads the tiles that images lacked, in the background.
//
// It stands beside the pipeline RangeCaster -> ImagePainter (ray_renderer.h), for images that may not wait for
// storage. TileFallbacks and PaintSources say what an image lacked; the loader puts it into the caches of the
// caster and the painter, where the next image finds it.
//
// Typical usage, for each image:
//   const bool reads_all = loader.begin(request);
//   ...                                       // draw, with fallbacks
//   result.settled = !loader.request(view, lacking);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "paging/pager.h"
#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/cast/tile_fallbacks.h"
#include "vpe/voxel/paint/image_painter.h"

namespace vpe::voxel {

// Holds what one image lacked.
struct LackingTiles {
  double exaggeration = 1;
  std::vector<AbsentTile> ground;
  std::vector<AbsentPage> colours;
};

// Has one caller at a time. Starts threads of its own at the first request, which end in the destructor.
class TileLoader {
 public:
  // `caster` and `painter` must outlive this.
  TileLoader(const RangeCaster& caster, const ImagePainter& painter, int threads);

  // Forgets everything, so that the caster and the painter may go over to another planet. Waits for loads that have
  // begun.
  void reset();

  // Begins an image. Returns true if it shall read all tiles itself: the loader has loaded them for an image of
  // the same request before, and the caches could not hold all of them at once.
  bool begin(const core::DrawRequest& request);

  // Replaces the requests by those of an image and of expected ones, nearest first. Coarsely shown ground is
  // loaded first; where what is shown is many levels too coarse, a level in between is loaded before the tile.
  // Ignores what cannot be read. Returns true if something is on its way, or begin() will return true, so that
  // the next image of the same view will differ.
  struct Expected {
    core::View view;
    LackingTiles lacking;
  };
  bool request(const core::View& view, const LackingTiles& lacking, std::span<const Expected> expected);

 private:
  struct Page {
    enum class Kind : std::uint8_t { kGrids, kSurface, kColours };
    Kind kind = Kind::kGrids;
    lod::TileKey key;
    LineFamily family = LineFamily::kColumns;  // not compared
    PaintPage paint;                           // of kColours; its exaggeration counts for all kinds
    bool operator==(const Page& other) const {
      return kind == other.kind && key == other.key && paint == other.paint;
    }
  };
  struct PageHash {
    std::size_t operator()(const Page& page) const {
      return lod::TileKeyHash()(page.key) * 3 + static_cast<std::size_t>(page.kind) +
             std::hash<double>()(page.paint.exaggeration);
    }
  };
  using Pager = paging::Pager<Page, char, PageHash>;

  void load(const Page& page) const;
  // Appends what is lacking. Returns true if the caches have dropped something that was loaded for this view.
  bool add(const core::View& view, const LackingTiles& lacking, double factor, std::vector<Pager::Want>& wants);

  const RangeCaster& caster_;
  const ImagePainter& painter_;
  int threads_;
  std::optional<core::DrawRequest> last_;  // request that loaded_ belongs to
  std::unordered_set<Page, PageHash> loaded_;
  bool reads_all_ = false;
  std::optional<Pager> pager_;  // last: its threads use the others
};

// Returns the missing tiles of an image, each once.
std::vector<core::MissingTile> missing_tiles(const lod::TileTree& tree, const LackingTiles& lacking);

}  // namespace vpe::voxel
