// Cover of a frame: which tiles are drawn.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "cull/adaptive_culling.h"
#include "lod/fallback.h"
#include "lod/occlusion.h"
#include "lod/select.h"
#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"
#include "vpe/gl/camera_clearance.h"
#include "vpe/gl/tile_streamer.h"

namespace vpe::gl {

// Holds all that drawing a tile of a frame needs. Pointers are valid until the next frame.
struct SceneTile {
  const lod::SelectedTile* tile = nullptr;
  const GpuMesh* mesh = nullptr;
  const GpuTexture* texture = nullptr;  // null when the mode needs none
  std::array<float, 4> skirt_m{};       // by lod::Edge
  std::span<const IndexRange> surface;  // the triangles that the image may show
};

// Selects the tiles of a frame, replaces those that are not resident by fallbacks, and leaves out those that
// nearer ground hides. The cover is disjoint and without a hole in every frame.
//
// Thread rule: the context's thread. `planet`, `streamer` and `clearance` must outlive it.
//
// Typical usage, once a frame, after TileStreamer::begin_frame():
//
//   cover.select(request);
//   if (!cover.load_all(request, 1.5)) ...    // or cover.use_resident(request), which does not wait
//   cover.lay_out(request.view);
//   for (const SceneTile& tile : cover.tiles()) ...
class TileCover {
 public:
  // most_triangles: what the memory is enough for, > 0.
  TileCover(const paging::PlanetFile& planet, TileStreamer& streamer, const CameraClearance& clearance,
            std::int64_t most_triangles);

  // Selects what a request needs, whatever is resident, and decides whether hidden tiles are looked for.
  void select(const core::DrawRequest& request);

  // Loads all that is selected and not hidden, and covers the frame with it. Tiles that cannot be read are
  // covered by their nearest readable ancestors. Throws paging::PlanetError if that fails too. Returns false when
  // the time-out has passed: then the frame is covered with what is resident.
  bool load_all(const core::DrawRequest& request, double timeout_s);

  // Covers the frame with what is resident. Loads only roots of faces that would be uncovered.
  void use_resident(const core::DrawRequest& request);

  // Collects the meshes, textures, skirt depths and seen pieces of the cover.
  void lay_out(const core::View& view);

  // Returns the tiles to draw, as lay_out() found them.
  std::span<const SceneTile> tiles() const { return tiles_; }
  // Returns the bytes of their meshes and textures.
  std::size_t bytes() const;

  // Returns what the frame's view needs, and flags of what of it is hidden and not resident. No flags: none.
  const lod::Selection& wanted() const { return wanted_; }
  std::span<const std::uint8_t> not_needed() const { return not_needed_; }
  // Returns what the frame's view needs where some of it cannot be read: the nearest readable ancestors in the
  // places of the others, as load_all() has them.
  lod::Selection readable(const core::View& view) const;
  // Returns the cover, hidden tiles included.
  const lod::Selection& cover() const { return drawn_.drawn; }

  // Returns, coarsest first, what stands in for ground that a motion may bring: the roots, the ancestors of what is
  // wanted or drawn, and their children that are not drawn.
  std::vector<lod::TileKey> near_fallbacks() const;

  // Selects what another view will need and, while hidden tiles are looked for, what will not be hidden there.
  void select_later(const core::View& view, lod::Selection& later);

  // Takes the time in which the tiles of this frame were drawn, to decide whether looking for hidden ones pays.
  void record_draw_time(double draw_ms);

  // Fills in counts of tiles and triangles, and the missing tiles.
  void report(core::DrawResult& result) const;

 private:
  void replace_unreadable(const core::View& view, lod::FallbackSelection& result) const;
  TileStreamer::LoadOutcome load_cover(const core::DrawRequest& request, TileStreamer::Deadline deadline);
  TileStreamer::LoadOutcome load_ground(const core::View& view, TileStreamer::Deadline deadline);
  bool load_roots(const lod::Selection& needed);
  // Throws paging::PlanetError if nothing covers a tile because not even its root can be read.
  void require_cover() const;
  void cover_without(std::span<const std::uint8_t> left_out, const core::View& view);
  void merge_hidden(std::span<const std::uint8_t> left_out);
  void occlude(const lod::Selection& tiles, const core::View& view, std::vector<std::uint8_t>& hidden);
  bool is_drawable(const lod::SelectedTile& tile);
  void find_seen_pieces(const core::View& view);

  const paging::PlanetFile& planet_;
  TileStreamer& streamer_;
  const CameraClearance& clearance_;
  std::int64_t most_triangles_;

  lod::SelectOptions options_;  // of the frame
  lod::SelectScratch scratch_;
  lod::Selection wanted_;
  // Its selection covers all that is seen: what is drawn and, by the flags of hidden_, what nearer ground
  // hides.
  lod::FallbackSelection drawn_;
  std::vector<std::uint8_t> hidden_;
  std::vector<std::uint8_t> not_needed_;
  lod::OcclusionPass pass_;
  cull::AdaptiveCulling culling_;
  bool occluding_ = false;
  double occlude_ms_ = 0;
  std::vector<std::array<float, 4>> skirts_;
  std::vector<SceneTile> tiles_;
  std::vector<IndexRange> ranges_;  // of all tiles
};

}  // namespace vpe::gl
