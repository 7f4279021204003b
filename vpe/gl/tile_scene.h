// The tiles of a frame: chosen, paged in, and what stands in for those that are not there yet.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "cull/adaptive_culling.h"
#include "lod/fallback.h"
#include "lod/occlusion.h"
#include "paging/pager.h"
#include "vpe/core/frame.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/tile_needs.h"
#include "vpe/gl/tile_page.h"

namespace vpe::gl {

struct SceneTile {
  const lod::SelectedTile* tile = nullptr;
  const GpuMesh* mesh = nullptr;
  const GpuTexture* texture = nullptr;  // null when the mode needs none
  std::array<float, 4> skirt_m{};       // by lod::Edge
};

// Thread rule: the context's thread.
class TileScene {
 public:
  TileScene(std::shared_ptr<const paging::PlanetFile> planet, const RendererOptions& options);

  // Decides what is drawn for a request and pages it in; afterwards the members below speak of that frame.
  void prepare(const core::DrawRequest& request);

  std::span<const SceneTile> tiles() const { return tiles_; }

  const TileMaterial& material() const { return material_; }
  const std::shared_ptr<const core::ColourScale>& scale() const { return scale_; }  // null: none is shown

  // Of the frame that was prepared last, whose tiles took so long to draw.
  void drawn_in(double draw_ms);

  double nearest_m() const;  // no tile is nearer to the camera; infinite when there are none

  // Distance of the camera from the ground below or above it. A lower bound while the ground is not there yet.
  double clearance_m() const { return clearance_m_; }

  // Counts, times, missing tiles and failures of the frame.
  void report(core::DrawResult& result) const;

 private:
  using TilePager = paging::Pager<PageKey, Page, PageKeyHash>;

  using Deadline = TilePager::Clock::time_point;

  std::size_t share(double part) const { return static_cast<std::size_t>(part * static_cast<double>(memory_)); }
  void set_shading(const core::DrawRequest& request);
  void drop_other_shadings();
  std::vector<TileNeed> needs_of(const lod::Selection& selection, const core::View& view) const;
  PageKey mesh_page(const lod::TileKey& tile, const MeshDetail& mesh) const;
  PageKey texture_page(const lod::TileKey& tile, int paint) const;
  TileNeed coarse_need(const lod::TileKey& tile) const;  // of its first mesh
  PageKey ground_page(const glm::dvec3& camera_m) const;

  bool is_resident(const PageKey& page, std::uint64_t frame);  // counts as used in it
  bool can_be_drawn(const lod::TileInfo& tile, int variant);
  bool is_readable(const lod::TileInfo& tile) const;
  void upload(TilePager::Loaded page);
  void trim();
  bool has_room() const;
  std::vector<PageKey> absent_pages(const lod::Selection& selection, const core::View& view,
                                    std::uint64_t frame);

  void complete(const core::DrawRequest& request, const lod::SelectOptions& options);
  enum class Load { kAll, kFailure, kTimeout };
  Load load(std::span<const PageKey> pages, std::span<const PageKey> then, Deadline deadline);
  Load load_cover(const core::DrawRequest& request, Deadline deadline);
  Load load_ground(const core::View& view, Deadline deadline);
  void note_failure(const PageKey& page, const std::string& why);
  void draw_what_is_there(const core::DrawRequest& request, const lod::SelectOptions& options);
  void cover_without(const std::vector<std::uint8_t>& left_out, const core::DrawRequest& request,
                     const lod::SelectOptions& options);
  void occlude(const lod::Selection& tiles, const core::View& view, std::vector<std::uint8_t>& hidden);
  bool is_above_ground(const lod::Selection& cover, const core::View& view);
  bool needs_ground(const core::View& view) const;
  void take_some(double limit_ms);
  bool load_roots(const lod::Selection& needed);
  void ask(const core::DrawRequest& request, const lod::SelectOptions& options);
  void want_upcoming(const core::DrawRequest& request, const lod::SelectOptions& options,
                     std::vector<TilePager::Want>& wants);
  void lay_out(const core::View& view);
  const paging::TileHeights* ground_tile(const lod::TileKey& key) const;
  // Height of the drawn ground below the camera, metres above the sphere; nothing while its tile is not there.
  std::optional<double> ground_m(const core::View& view);
  void find_clearance(const core::View& view);

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::int64_t most_triangles_;
  std::size_t memory_;
  std::shared_ptr<TerrainShader> painter_;
  PageLoader loader_;

  Resident<MeshDetail, GpuMesh> meshes_;
  Resident<TextureDetail, GpuTexture> textures_;
  std::vector<std::pair<lod::TileKey, std::shared_ptr<const paging::TileHeights>>> ground_;  // latest last
  TileMaterial material_;
  std::shared_ptr<const ShadingParams> shading_;  // material_.look, one object while it stays the same
  bool other_shadings_ = false;                   // may be resident
  core::Appearance scale_of_;                     // whose scale this is
  std::shared_ptr<const core::ColourScale> scale_;
  std::uint64_t frame_ = 0;

  lod::SelectScratch scratch_;
  lod::Selection wanted_;
  // Its selection covers all that is seen: what is drawn and, as hidden_ says, what nearer ground hides.
  lod::FallbackSelection drawn_;
  std::vector<std::uint8_t> hidden_;
  std::vector<std::uint8_t> not_needed_;  // of wanted_: hidden, and not there
  lod::OcclusionPass pass_;
  cull::AdaptiveCulling culling_;
  bool occluding_ = false;
  bool needs_occluders_ = false;  // of the meshes that come: some frame was asked to leave out what is hidden
  std::vector<std::array<float, 4>> skirts_;
  std::vector<SceneTile> tiles_;
  double clearance_m_ = 0;
  core::FrameStats stats_;
  bool settled_ = true;
  std::unordered_map<lod::TileKey, std::string, lod::TileKeyHash> unreadable_;
  std::vector<std::string> failures_;

  TilePager::Load load_;
  TilePager pager_;  // last: its threads use the loader
};

}  // namespace vpe::gl
