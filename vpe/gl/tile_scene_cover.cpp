// What covers a frame: complete, or as far as it is there; and what of it nearer ground hides.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "lod/front_to_back.h"
#include "vpe/gl/tile_scene.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

// Adds up the time in which it lives.
class Stopwatch {
 public:
  explicit Stopwatch(double& ms) : ms_(ms) {}
  ~Stopwatch() { ms_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& ms_;
  Clock::time_point start_ = Clock::now();
};

// Tiles whose meshes are loaded at once before what they hide is known.
constexpr std::size_t kWave = 32;

// Nearer than this the near plane depends on the ground below the camera.
constexpr double kGroundMatters_m = 1000.0;

// What is drawn lies within this of its place: docs/culling.md.
constexpr double kOcclusionMargin_px = 0.25;

double occlusion_margin_rad(const core::View& view) { return kOcclusionMargin_px / core::focal_px(view); }

const core::View& culling_view(const core::DrawRequest& request) {
  return request.cull_view ? *request.cull_view : request.view;
}

const lod::SelectedTile* tile_over(const lod::Selection& cover, const lod::TileKey& finest) {
  const std::int64_t at = lod::z_position(finest);
  const auto after =
      std::partition_point(cover.tiles.begin(), cover.tiles.end(),
                           [&](const lod::SelectedTile& t) { return lod::z_position(t.key) <= at; });
  if (after == cover.tiles.begin() || !lod::contains((after - 1)->key, finest)) return nullptr;
  return &*(after - 1);
}

}  // namespace

const paging::TileHeights* TileScene::ground_tile(const lod::TileKey& key) const {
  const auto at = std::find_if(ground_.begin(), ground_.end(), [&](const auto& g) { return g.first == key; });
  return at == ground_.end() ? nullptr : at->second.get();
}

std::optional<double> TileScene::ground_m(const core::View& view) {
  const lod::TileKey key = ground_page(view.camera.position_m).tile;
  const paging::TileHeights* tile = ground_tile(key);
  if (tile == nullptr) return std::nullopt;
  const mars::ChartPoint at = mars::chart_point(view.camera.position_m);
  const lod::Posts& posts = tile->posts;
  return lod::surface_height(posts, lod::grid_lines(key, posts.intervals), at.u, at.v, planet_->radius_m(),
                             nullptr, shading_->exaggeration);
}

void TileScene::find_clearance(const core::View& view) {
  const double height = glm::length(view.camera.position_m) - planet_->radius_m();
  if (const auto ground = ground_m(view)) {
    clearance_m_ = std::abs(height - *ground);
    return;
  }
  const double x = shading_->exaggeration;
  const lod::TileInfo& tile = *planet_->tree().find(ground_page(view.camera.position_m).tile);
  clearance_m_ = std::max({0.0, height - x * tile.max_height_m, x * tile.min_height_m - height});
}

bool TileScene::needs_ground(const core::View& view) const {
  const double height = glm::length(view.camera.position_m) - planet_->radius_m();
  const lod::TileInfo& tile = *planet_->tree().find(ground_page(view.camera.position_m).tile);
  const double x = shading_->exaggeration;
  return height < x * tile.max_height_m + kGroundMatters_m && unreadable_.count(tile.key) == 0;
}

// Above what is drawn under it, not only above S.
bool TileScene::is_above_ground(const lod::Selection& cover, const core::View& view) {
  const lod::TileKey finest = ground_page(view.camera.position_m).tile;
  const lod::SelectedTile* drawn = tile_over(cover, finest);
  const double geometric_error_m = drawn == nullptr ? 0.0 : drawn->geometric_error_m;
  const double height = glm::length(view.camera.position_m) - planet_->radius_m();
  const lod::TileInfo& tile = *planet_->tree().find(finest);
  if (height > shading_->exaggeration * tile.max_height_m + geometric_error_m) return true;
  const auto ground = ground_m(view);
  return ground && height > *ground + geometric_error_m;
}

TileScene::Load TileScene::load_ground(const core::View& view, Deadline deadline) {
  const PageKey page = ground_page(view.camera.position_m);
  if (!needs_ground(view) || ground_tile(page.tile) != nullptr) return Load::kAll;
  return load(std::span(&page, 1), {}, deadline);
}

TileScene::Load TileScene::load_cover(const core::DrawRequest& request, Deadline deadline) {
  const core::View& view = request.view;
  const core::View& seen = culling_view(request);
  const lod::Selection& cover = drawn_.drawn;
  const std::size_t count = cover.tiles.size();
  const std::vector<TileNeed> needs = needs_of(cover, view);
  std::vector<lod::TileKey> keys;
  for (std::size_t n = 0; n < count; ++n) {
    keys.push_back(cover.tiles[n].key);
    // Counts as used, so that nothing leaves before its turn comes.
    is_resident(mesh_page(keys[n], needs[n].mesh), frame_);
    if (needs[n].paint != 0) is_resident(texture_page(keys[n], needs[n].paint), frame_);
  }
  trim();
  for (const core::View* from : {&view, &seen}) {
    if (const Load outcome = load_ground(*from, deadline); outcome != Load::kAll) return outcome;
  }
  hidden_.assign(count, 0);
  std::vector<std::uint32_t> order;
  {
    const Stopwatch watch(stats_.occlude_ms);
    lod::front_to_back(keys, glm::normalize(seen.camera.position_m), order);
    pass_.begin(seen.camera.position_m, occluding_ && is_above_ground(cover, seen), occlusion_margin_rad(seen));
  }
  const auto hidden = [&](std::uint32_t n) {
    if (hidden_[n] == 0 && occluding_ &&
        pass_.hidden(planet_->tree().region(cover.tiles[n].index, cover.exaggeration,
                                            cover.tiles[n].geometric_error_m))) {
      hidden_[n] = 1;
    }
    return hidden_[n] != 0;
  };
  std::vector<PageKey> textures;
  for (std::size_t begin = 0; begin < count; begin += kWave) {
    const auto wave = std::span(order).subspan(begin, std::min(kWave, count - begin));
    std::vector<PageKey> meshes;
    for (const std::uint32_t n : wave) {
      const PageKey page = mesh_page(keys[n], needs[n].mesh);
      if (!hidden(n) && !is_resident(page, frame_)) meshes.push_back(page);
    }
    if (const Load outcome = load(meshes, textures, deadline); outcome != Load::kAll) return outcome;
    const Stopwatch watch(stats_.occlude_ms);
    for (const std::uint32_t n : wave) {
      if (hidden(n)) continue;
      if (occluding_) {
        pass_.add(keys[n], *meshes_.find(keys[n], needs[n].mesh, frame_)->occluders, planet_->radius_m());
      }
      if (needs[n].paint == 0) continue;
      const PageKey page = texture_page(keys[n], needs[n].paint);
      if (!is_resident(page, frame_)) textures.push_back(page);
    }
  }
  std::erase_if(textures, [&](const PageKey& page) { return is_resident(page, frame_); });
  return load(textures, {}, deadline);
}

void TileScene::complete(const core::DrawRequest& request, const lod::SelectOptions& options) {
  const double limit_s = std::min(request.paging.timeout_s, 1e9);
  const Deadline deadline =
      limit_s < 1e9 ? Clock::now() + std::chrono::microseconds(static_cast<std::int64_t>(1e6 * limit_s))
                    : Deadline::max();
  const lod::SelectView view = lod::select_view(request.view);
  const auto readable = [](const void* self, const lod::TileInfo& tile, int) {
    return static_cast<const TileScene*>(self)->is_readable(tile);
  };
  for (;;) {
    lod::select_fallbacks(options, planet_->tree(), view, wanted_, {readable, this}, drawn_);
    const Load outcome = load_cover(request, deadline);
    if (outcome == Load::kAll) return;
    if (outcome == Load::kTimeout) break;
  }
  settled_ = false;
  draw_what_is_there(request, options);
}

// hidden[n]: of tiles as they can be drawn now; a tile that is not there hides nothing.
void TileScene::occlude(const lod::Selection& tiles, const core::View& view,
                        std::vector<std::uint8_t>& hidden) {
  const Stopwatch watch(stats_.occlude_ms);
  std::vector<lod::OccludingTile> list;
  for (const lod::SelectedTile& tile : tiles.tiles) {
    const GpuMesh* mesh = nullptr;
    if (can_be_drawn(planet_->tree()[tile.index], tile.variant)) {
      mesh = meshes_.best(tile.key, frame_,
                          [&](const MeshDetail& m) { return m.variant == tile.variant ? 0 : -1; });
    }
    list.push_back({tile.key, planet_->tree().region(tile.index, tiles.exaggeration, tile.geometric_error_m),
                    mesh == nullptr ? nullptr : mesh->occluders.get()});
  }
  lod::occlude(list, view.camera.position_m, is_above_ground(tiles, view), occlusion_margin_rad(view),
               planet_->radius_m(), pass_, hidden);
}

// Covers the frame with what is there, as if the tiles that are left out were not seen; they are in the cover,
// hidden.
void TileScene::cover_without(const std::vector<std::uint8_t>& left_out, const core::DrawRequest& request,
                              const lod::SelectOptions& options) {
  const auto there = [](const void* self, const lod::TileInfo& tile, int variant) {
    // Marks what it finds as used, which changes nothing that it answers.
    return const_cast<TileScene*>(static_cast<const TileScene*>(self))->can_be_drawn(tile, variant);
  };
  const lod::SelectView view = lod::select_view(request.view);
  lod::Selection needed = wanted_;
  needed.tiles.clear();
  for (std::size_t n = 0; n < wanted_.tiles.size(); ++n) {
    if (left_out.empty() || left_out[n] == 0) needed.tiles.push_back(wanted_.tiles[n]);
  }
  lod::select_fallbacks(options, planet_->tree(), view, needed, {there, this}, drawn_);
  if (drawn_.uncovered > 0 && load_roots(needed)) {
    lod::select_fallbacks(options, planet_->tree(), view, needed, {there, this}, drawn_);
  }
  // From places in `needed` to places in wanted_.
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < wanted_.tiles.size(); ++n) {
    if (left_out.empty() || left_out[n] == 0) places.push_back(n);
  }
  for (std::size_t& n : drawn_.missing) n = places[n];
  std::vector<lod::SelectedTile>& cover = drawn_.drawn.tiles;
  hidden_.assign(cover.size(), 0);
  if (left_out.empty()) return;
  std::vector<lod::SelectedTile> merged;
  std::vector<std::uint8_t> flags;
  std::size_t next = 0;
  for (std::size_t n = 0; n < wanted_.tiles.size(); ++n) {
    if (left_out[n] == 0) continue;
    const lod::SelectedTile& tile = wanted_.tiles[n];
    while (next < cover.size() && lod::z_position(cover[next].key) <= lod::z_position(tile.key)) {
      merged.push_back(cover[next++]);
      flags.push_back(0);
    }
    if (!merged.empty() && lod::contains(merged.back().key, tile.key)) continue;
    merged.push_back(tile);
    flags.push_back(1);
  }
  for (; next < cover.size(); ++next) {
    merged.push_back(cover[next]);
    flags.push_back(0);
  }
  cover = std::move(merged);
  hidden_ = std::move(flags);
}

void TileScene::draw_what_is_there(const core::DrawRequest& request, const lod::SelectOptions& options) {
  not_needed_.assign(wanted_.tiles.size(), 0);
  if (!occluding_) {
    cover_without({}, request, options);
    return;
  }
  // With what is there of the tiles wanted, those that are hidden need neither be there nor be stood in for.
  std::vector<std::uint8_t> hidden;
  occlude(wanted_, culling_view(request), hidden);
  bool any_absent = false;
  for (std::size_t n = 0; n < hidden.size(); ++n) {
    const lod::SelectedTile& tile = wanted_.tiles[n];
    const bool there = can_be_drawn(planet_->tree()[tile.index], tile.variant);
    any_absent |= !there;
    not_needed_[n] = hidden[n] != 0 && !there ? 1 : 0;
  }
  cover_without(not_needed_, request, options);
  if (!any_absent) {
    hidden_ = std::move(hidden);
    return;
  }
  // Stand-ins may be lower than what they stand in for.
  const std::vector<std::uint8_t> left_out = hidden_;
  occlude(drawn_.drawn, culling_view(request), hidden_);
  for (std::size_t n = 0; n < left_out.size(); ++n) {
    if (left_out[n] == 0 || hidden_[n] != 0) continue;
    cover_without({}, request, options);
    occlude(drawn_.drawn, culling_view(request), hidden_);
    return;
  }
}

void TileScene::drawn_in(double draw_ms) {
  if (!occluding_) {
    culling_.skip_frame();
    return;
  }
  culling_.record_frame({stats_.occlude_ms, static_cast<int>(hidden_.size()),
                         static_cast<int>(std::count(hidden_.begin(), hidden_.end(), 1)),
                         draw_ms / std::max<double>(1.0, static_cast<double>(tiles_.size()))});
}

}  // namespace vpe::gl
