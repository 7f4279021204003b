// Pages of tiles: what is wanted, loaded, uploaded and resident.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "lod/select.h"
#include "paging/pager.h"
#include "vpe/core/frame.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/tile_needs.h"
#include "vpe/gl/tile_page.h"

namespace vpe::gl {

// Keeps the meshes, textures and ground posts of tiles on the GPU or in memory, within the budget, and tells
// the loaders what to make next. Knows nothing of which tiles a frame draws but what it is asked for.
//
// A page is found resident by the frame that begin_frame() began; what a frame has found stays until the next.
// Thread rule: the context's thread. Loaders run on threads of their own, which end in the destructor.
//
// Typical usage, once a frame:
//
//   streamer.begin_frame(request);
//   streamer.take_loaded(4.0);                          // or load(pages, ...), which waits
//   ... is_drawable(tile, variant), mesh(tile, need), texture(tile, need) ...
//   streamer.begin_requests();
//   streamer.request_frame(wanted, not_needed, drawn, view);
//   streamer.send_requests();
//   streamer.trim();
class TileStreamer {
 public:
  using Pager = paging::Pager<PageKey, Page, PageKeyHash>;
  using Deadline = Pager::Clock::time_point;

  TileStreamer(std::shared_ptr<const paging::PlanetFile> planet, const RendererOptions& options);

  // Goes over to another version of the planet, as paging::PlanetUser::change_planet(). Waits for loads that have
  // begun. Drops the resident pages that are not the same in both.
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet);

  // Begins a frame. Drops what a change of appearance makes useless. A frame without colours needs no textures.
  // Returns true if no resident tile fits any more.
  bool begin_frame(const core::DrawRequest& request);

  const TileMaterial& material() const { return material_; }
  double exaggeration() const { return shading_->exaggeration; }

  // Returns the scale of the colours shown, or null if none is shown.
  const std::shared_ptr<const core::ColourScale>& scale() const { return scale_; }

  // Returns the mesh and the texture that each tile of a selection needs in a view.
  std::vector<TileNeed> needs_of(const lod::Selection& selection, const core::View& view) const;
  // Returns the need of a tile that is drawn as a fallback: its coarsest mesh, its smallest texture.
  TileNeed coarse_need(const lod::TileKey& tile) const;

  // Returns the keys of pages with the current appearance.
  PageKey mesh_page(const lod::TileKey& tile, const MeshDetail& mesh) const;
  PageKey texture_page(const lod::TileKey& tile, int texture) const;
  // Returns the page of the posts of the finest tile below the camera.
  PageKey ground_page(const glm::dvec3& camera_m) const;

  // Returns true if a page is resident, and marks it as used in this frame.
  bool is_resident(const PageKey& page) { return is_resident(page, frame_); }
  // Returns true if a tile can be drawn with a variant of its meshes: with any origin and any texture, since
  // both are better than a coarser tile. Marks what it finds as used.
  bool is_drawable(const lod::TileInfo& tile, int variant);
  // Returns false once loading one of the tile's pages has failed.
  bool is_readable(const lod::TileKey& tile) const { return failures_.count(tile) == 0; }
  // Returns true if no tile has failed yet.
  bool is_all_readable() const { return failures_.empty(); }
  // Returns the reason why a tile cannot be read, or null.
  const std::string* failure(const lod::TileKey& tile) const;

  // Returns the reason why a tile has coarser colours than it needs, or null.
  const std::string* coarse_colours(const lod::TileKey& tile) const;

  // Returns the mesh of a variant, with the origin and charts of `need` if there is one, or null.
  const GpuMesh* mesh(const lod::SelectedTile& tile, const TileNeed& need);
  // Returns the texture nearest to `need`, or null. The current shading is preferred to earlier ones, then the
  // wanted size or a larger one to smaller ones.
  const GpuTexture* texture(const lod::SelectedTile& tile, const TileNeed& need);
  // Returns the occluder profile of a mesh, or null if the mesh is not resident or has none.
  const lod::OccluderProfile* occluders(const lod::TileKey& tile, const MeshDetail& mesh);
  // Does the same for any mesh of a variant.
  const lod::OccluderProfile* occluders(const lod::TileKey& tile, int variant);
  // Returns the posts of a tile that ground_page() named, or null if they are not resident.
  const paging::TileHeights* ground(const lod::TileKey& tile) const;

  // Loads pages, and waits for them. `then` is loaded after them, but not waited for. Returns as soon as a page
  // has failed or the deadline has passed.
  enum class LoadOutcome { kAll, kFailure, kTimeout };
  LoadOutcome load(std::span<const PageKey> pages, std::span<const PageKey> then, Deadline deadline);
  // Loads a page on this thread, since loaders may all be busy for long. Returns false if it cannot be read.
  bool load_now(const PageKey& page);
  // Uploads what the loaders have finished, for about `limit_ms`; one batch in any case.
  void take_loaded(double limit_ms);

  // Collects the requests of a frame. send_requests() then replaces what the loaders were asked for before;
  // requests that are not repeated are dropped unless a loader has begun them.
  void begin_requests();
  // Requests what a frame lacks. Urgency is the screen-space error without the page, more in the middle of the
  // image. Where the fallback is several levels above, the level below it is more urgent than the tile itself,
  // so that the image sharpens in steps. not_needed: flags of `wanted`; empty: all are needed.
  void request_frame(const lod::Selection& wanted, std::span<const std::uint8_t> not_needed,
                     const lod::Selection& drawn, const core::View& view);
  // Requests one page. Ignores resident, unreadable and repeated ones.
  void request(const PageKey& page, double urgency);
  // Requests `first` and what a later view lacks, nearest tiles first, after all that was requested before.
  void request_later(const lod::Selection& selection, const core::View& view, std::optional<PageKey> first);
  // Requests the coarsest pages of tiles, after all that was requested before, and keeps those that are resident as
  // if this frame had drawn them. Returns true if a page was requested.
  bool request_coarse(std::span<const lod::TileKey> tiles);
  bool has_requests() const { return !requests_.empty(); }
  // Returns true if a frame whose meshes and textures take `frame_bytes` leaves room for pages of later views.
  bool has_room_for_later(std::size_t frame_bytes) const;
  // Returns the same for the coarsest pages, which are small.
  bool has_room_for_coarse(std::size_t frame_bytes) const;
  void send_requests();

  // Drops textures of an earlier shading. For complete frames: incomplete ones may still show them.
  void drop_other_shadings();
  // Drops what was used longest ago until the budget is kept. Never drops what this frame has used.
  void trim();

  // Fills in counts of pages, bytes and the failures that are new in this frame.
  void report(core::DrawResult& result) const;

 private:
  void start_pager();
  std::size_t share(double part) const { return static_cast<std::size_t>(part * static_cast<double>(memory_)); }
  bool has_room(std::size_t frame_bytes, double part) const;
  // Returns the frame in which pages of later views count as used.
  std::uint64_t later_frame() const;
  bool set_shading(const core::DrawRequest& request);
  bool is_textured(const lod::TileKey& tile) const;
  bool is_resident(const PageKey& page, std::uint64_t frame);
  std::vector<PageKey> absent_pages(const lod::Selection& selection, const core::View& view,
                                    std::uint64_t frame);
  // Marks the page as used in `frame`.
  void upload(Pager::Loaded page, std::uint64_t frame);
  void record_failure(const PageKey& page, const std::string& why);

  std::shared_ptr<const paging::PlanetFile> planet_;
  RendererOptions options_;
  std::size_t memory_;
  std::shared_ptr<TerrainShader> terrain_shader_;
  PageLoader loader_;
  std::uint64_t frame_ = 0;

  TileMaterial material_;
  std::shared_ptr<const ShadingParams> shading_;  // material_.shading, one object while it stays the same
  bool has_other_shadings_ = false;               // textures of earlier ones may be resident
  bool has_new_planet_ = false;                   // since the last frame
  bool wants_textures_ = true;                    // of this frame
  bool needs_occluders_ = false;                  // meshes are made with them, once a frame has needed them
  core::Appearance scale_appearance_;             // the appearance that scale_ was made for
  std::shared_ptr<const core::ColourScale> scale_;

  Resident<MeshDetail, GpuMesh> meshes_;
  Resident<TextureDetail, GpuTexture> textures_;
  std::vector<std::pair<lod::TileKey, std::shared_ptr<const paging::TileHeights>>> ground_;  // latest last

  // Room for pages of later views.
  struct LaterRoom {
    std::size_t used = 0;       // by this frame and what later views have
    std::size_t requested = 0;  // for later views, since the requests began
    // Takes room for a page, if there is as much within `limit`.
    bool take(std::size_t bytes, std::size_t limit) {
      if (used + requested + bytes > limit) return false;
      requested += bytes;
      return true;
    }
  };
  LaterRoom later_meshes_;
  LaterRoom later_textures_;
  std::vector<Pager::Want> requests_;
  std::unordered_set<PageKey, PageKeyHash> requested_;
  bool any_failed_ = false;  // when the requests began

  std::unordered_map<lod::TileKey, std::string, lod::TileKeyHash> failures_;
  std::unordered_map<lod::TileKey, std::string, lod::TileKeyHash> coarse_colours_;
  std::vector<std::string> new_failures_;
  std::int64_t uploaded_ = 0;
  std::int64_t evicted_ = 0;

  Pager::Load load_;
  std::optional<Pager> pager_;  // last, so that it is destroyed first: its threads use the loader; never empty
};

}  // namespace vpe::gl
