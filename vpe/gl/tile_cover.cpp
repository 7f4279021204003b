#include "vpe/gl/tile_cover.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_set>
#include <utility>

#include "cull/frustum.h"
#include "cull/horizon.h"
#include "lod/front_to_back.h"
#include "lod/options.h"
#include "lod/reevaluate.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;
using LoadOutcome = TileStreamer::LoadOutcome;

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

// Tiles whose meshes are loaded at once before it is known what they hide.
constexpr std::size_t kWave = 32;

// What is drawn lies within this of its place: docs/design/culling.md.
constexpr double kOcclusionMargin_px = 0.25;

// Skirts reach farther down by this part of distance and tile side, for the rounding of their feet to float.
constexpr double kFootError = 1e-6;

double occlusion_margin_rad(const core::View& view) { return kOcclusionMargin_px / core::focal_px(view); }

const core::View& culling_view(const core::DrawRequest& request) {
  return request.cull_view ? *request.cull_view : request.view;
}

}  // namespace

TileCover::TileCover(const paging::PlanetFile& planet, TileStreamer& streamer, const CameraClearance& clearance,
                     std::int64_t most_triangles)
    : planet_(planet), streamer_(streamer), clearance_(clearance), most_triangles_(most_triangles) {}

void TileCover::select(const core::DrawRequest& request) {
  options_ = lod::select_options(request, planet_.radius_m(), most_triangles_);
  lod::select(options_, planet_.tree(), lod::select_view(culling_view(request)), scratch_, wanted_);
  if (request.cull_view) lod::reevaluate_for_view(lod::select_view(request.view), planet_.tree(), wanted_);
  const core::Occlusion occlusion = request.settings.occlusion;
  occluding_ = occlusion == core::Occlusion::kOn ||
               (occlusion == core::Occlusion::kAuto && (request.paging.wait || culling_.use()));
  occlude_ms_ = 0;
  hidden_.clear();
  not_needed_.clear();
}

bool TileCover::is_drawable(const lod::SelectedTile& tile) {
  return streamer_.is_drawable(planet_.tree()[tile.index], tile.variant);
}

LoadOutcome TileCover::load_ground(const core::View& view, TileStreamer::Deadline deadline) {
  const auto page = clearance_.needed_page(view);
  if (!page || streamer_.is_resident(*page)) return LoadOutcome::kAll;
  return streamer_.load(std::span(&*page, 1), {}, deadline);
}

LoadOutcome TileCover::load_cover(const core::DrawRequest& request, TileStreamer::Deadline deadline) {
  const core::View& view = request.view;
  const core::View& seen = culling_view(request);
  const lod::Selection& cover = drawn_.drawn;
  const std::size_t count = cover.tiles.size();
  const std::vector<TileNeed> needs = streamer_.needs_of(cover, view);
  std::vector<lod::TileKey> keys;
  for (std::size_t n = 0; n < count; ++n) {
    keys.push_back(cover.tiles[n].key);
    // Marks pages as used, so that none is evicted before it is needed below.
    streamer_.is_resident(streamer_.mesh_page(keys[n], needs[n].mesh));
    if (needs[n].texture != 0) streamer_.is_resident(streamer_.texture_page(keys[n], needs[n].texture));
  }
  streamer_.trim();
  for (const core::View* from : {&view, &seen}) {
    if (const LoadOutcome outcome = load_ground(*from, deadline); outcome != LoadOutcome::kAll) return outcome;
  }
  hidden_.assign(count, 0);
  std::vector<std::uint32_t> order;
  {
    const Stopwatch watch(occlude_ms_);
    lod::front_to_back(keys, glm::normalize(seen.camera.position_m), order);
    pass_.begin(seen.camera.position_m, occluding_ && clearance_.is_above_ground(cover, seen),
                occlusion_margin_rad(seen));
  }
  const auto hidden = [&](std::uint32_t n) {
    if (hidden_[n] == 0 && occluding_ &&
        pass_.hidden(planet_.tree().region(cover.tiles[n].index, cover.exaggeration,
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
      const PageKey page = streamer_.mesh_page(keys[n], needs[n].mesh);
      if (!hidden(n) && !streamer_.is_resident(page)) meshes.push_back(page);
    }
    if (const LoadOutcome outcome = streamer_.load(meshes, textures, deadline); outcome != LoadOutcome::kAll)
      return outcome;
    const Stopwatch watch(occlude_ms_);
    for (const std::uint32_t n : wave) {
      if (hidden(n)) continue;
      if (occluding_) pass_.add(keys[n], *streamer_.occluders(keys[n], needs[n].mesh), planet_.radius_m());
      if (needs[n].texture == 0) continue;
      const PageKey page = streamer_.texture_page(keys[n], needs[n].texture);
      if (!streamer_.is_resident(page)) textures.push_back(page);
    }
  }
  std::erase_if(textures, [&](const PageKey& page) { return streamer_.is_resident(page); });
  return streamer_.load(textures, {}, deadline);
}

void TileCover::replace_unreadable(const core::View& view, lod::FallbackSelection& result) const {
  const auto readable = [](const void* streamer, const lod::TileInfo& tile, int) {
    return static_cast<const TileStreamer*>(streamer)->is_readable(tile.key);
  };
  lod::select_fallbacks(options_, planet_.tree(), lod::select_view(view), wanted_, {readable, &streamer_},
                        result);
}

lod::Selection TileCover::readable(const core::View& view) const {
  lod::FallbackSelection result;
  replace_unreadable(view, result);
  return std::move(result.drawn);
}

bool TileCover::load_all(const core::DrawRequest& request, double timeout_s) {
  const double limit_s = std::min(timeout_s, 1e9);
  const TileStreamer::Deadline deadline =
      limit_s < 1e9 ? Clock::now() + std::chrono::microseconds(static_cast<std::int64_t>(1e6 * limit_s))
                    : TileStreamer::Deadline::max();
  for (;;) {
    replace_unreadable(request.view, drawn_);
    const LoadOutcome outcome = load_cover(request, deadline);
    if (outcome == LoadOutcome::kAll) {
      require_cover();
      return true;
    }
    if (outcome == LoadOutcome::kTimeout) break;
  }
  use_resident(request);
  return false;
}

// Ground that nothing covers would be drawn as sky.
void TileCover::require_cover() const {
  if (drawn_.uncovered == 0) return;
  for (const std::size_t n : drawn_.missing) {
    if (const std::string* why = streamer_.failure(lod::ancestor(wanted_.tiles[n].key, 0)))
      throw paging::PlanetError(*why);
  }
}

// The roots of the faces that are missing. Returns false if none could be added.
bool TileCover::load_roots(const lod::Selection& needed) {
  bool any = false;
  for (lod::TileTree::Index root = 0; root < mars::kFaces; ++root) {
    const lod::TileInfo& tile = planet_.tree()[root];
    const bool wanted = std::any_of(drawn_.missing.begin(), drawn_.missing.end(),
                                    [&](std::size_t n) { return needed.tiles[n].key.face == tile.key.face; });
    if (!wanted || !streamer_.is_readable(tile.key) || streamer_.is_drawable(tile, 0)) continue;
    const TileNeed coarse = streamer_.coarse_need(tile.key);
    any |= streamer_.load_now(streamer_.mesh_page(tile.key, coarse.mesh));
    if (coarse.texture != 0) any |= streamer_.load_now(streamer_.texture_page(tile.key, coarse.texture));
  }
  return any;
}

// hidden[n]: of tiles as they can be drawn now. A tile that is not resident hides nothing.
void TileCover::occlude(const lod::Selection& tiles, const core::View& view,
                        std::vector<std::uint8_t>& hidden) {
  const Stopwatch watch(occlude_ms_);
  std::vector<lod::OccludingTile> list;
  for (const lod::SelectedTile& tile : tiles.tiles) {
    list.push_back({tile.key, planet_.tree().region(tile.index, tiles.exaggeration, tile.geometric_error_m),
                    is_drawable(tile) ? streamer_.occluders(tile.key, tile.variant) : nullptr});
  }
  lod::occlude(list, view.camera.position_m, clearance_.is_above_ground(tiles, view),
               occlusion_margin_rad(view), planet_.radius_m(), pass_, hidden);
}

// Covers the frame with what is resident, as if the tiles that are left out were not seen. They are in the
// cover, hidden. No flags: none is left out.
void TileCover::cover_without(std::span<const std::uint8_t> left_out, const core::View& view) {
  // A pointer to the streamer's address, since the streamer marks as used what it finds.
  TileStreamer* const streamer = &streamer_;
  const lod::IsResident resident{
      [](const void* context, const lod::TileInfo& tile, int variant) {
        return (*static_cast<TileStreamer* const*>(context))->is_drawable(tile, variant);
      },
      &streamer};
  const lod::SelectView select_view = lod::select_view(view);
  lod::Selection needed = wanted_;
  needed.tiles.clear();
  std::vector<std::size_t> places;  // of the needed tiles in wanted_
  for (std::size_t n = 0; n < wanted_.tiles.size(); ++n) {
    if (!left_out.empty() && left_out[n] != 0) continue;
    needed.tiles.push_back(wanted_.tiles[n]);
    places.push_back(n);
  }
  lod::select_fallbacks(options_, planet_.tree(), select_view, needed, resident, drawn_);
  if (drawn_.uncovered > 0 && load_roots(needed)) {
    lod::select_fallbacks(options_, planet_.tree(), select_view, needed, resident, drawn_);
  }
  for (std::size_t& n : drawn_.missing) n = places[n];
  require_cover();
  hidden_.assign(drawn_.drawn.tiles.size(), 0);
  if (!left_out.empty()) merge_hidden(left_out);
}

// Adds the tiles that are left out to the cover, where nothing coarser covers them.
void TileCover::merge_hidden(std::span<const std::uint8_t> left_out) {
  std::vector<lod::SelectedTile>& cover = drawn_.drawn.tiles;
  std::vector<lod::SelectedTile> merged;
  std::vector<std::uint8_t> flags;
  std::size_t next = 0;
  for (std::size_t n = 0; n < wanted_.tiles.size(); ++n) {
    if (left_out[n] == 0) continue;
    const lod::SelectedTile& tile = wanted_.tiles[n];
    while (next < cover.size() && lod::morton_position(cover[next].key) <= lod::morton_position(tile.key)) {
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

void TileCover::use_resident(const core::DrawRequest& request) {
  not_needed_.assign(wanted_.tiles.size(), 0);
  if (!occluding_) {
    cover_without({}, request.view);
    return;
  }
  // Of the tiles wanted, those that resident ones hide need neither be resident nor have a fallback.
  std::vector<std::uint8_t> hidden;
  occlude(wanted_, culling_view(request), hidden);
  bool any_absent = false;
  for (std::size_t n = 0; n < hidden.size(); ++n) {
    const bool resident = is_drawable(wanted_.tiles[n]);
    any_absent |= !resident;
    not_needed_[n] = hidden[n] != 0 && !resident ? 1 : 0;
  }
  cover_without(not_needed_, request.view);
  if (!any_absent) {
    hidden_ = std::move(hidden);
    return;
  }
  // Fallbacks may be lower than what they replace.
  const std::vector<std::uint8_t> left_out = hidden_;
  occlude(drawn_.drawn, culling_view(request), hidden_);
  for (std::size_t n = 0; n < left_out.size(); ++n) {
    if (left_out[n] == 0 || hidden_[n] != 0) continue;
    cover_without({}, request.view);
    occlude(drawn_.drawn, culling_view(request), hidden_);
    return;
  }
}

std::vector<lod::TileKey> TileCover::near_fallbacks() const {
  std::unordered_set<lod::TileKey, lod::TileKeyHash> drawn;
  const std::vector<lod::SelectedTile>& cover = drawn_.drawn.tiles;
  for (std::size_t n = 0; n < cover.size(); ++n)
    if (hidden_.empty() || hidden_[n] == 0) drawn.insert(cover[n].key);
  // What is wanted counts, not only what is drawn: below a fallback the next one is needed.
  std::unordered_set<lod::TileKey, lod::TileKeyHash> refined;
  for (const std::vector<lod::SelectedTile>* tiles : {&wanted_.tiles, &cover}) {
    for (const lod::SelectedTile& tile : *tiles) {
      for (int level = tile.key.level - 1; level >= 0; --level) {
        if (!refined.insert(lod::ancestor(tile.key, level)).second) break;
      }
    }
  }
  std::vector<lod::TileKey> out;
  const auto add = [&](const lod::TileKey& key) {
    if (drawn.count(key) == 0) out.push_back(key);
  };
  for (lod::TileTree::Index root = 0; root < mars::kFaces; ++root) add(planet_.tree()[root].key);
  for (const lod::TileKey& key : refined) {
    for (int child = 0; child < 4; ++child) add(lod::child(key, child));
  }
  std::sort(out.begin(), out.end(), [](const lod::TileKey& a, const lod::TileKey& b) {
    return a.level != b.level ? a.level < b.level : lod::morton_position(a) < lod::morton_position(b);
  });
  return out;
}

void TileCover::select_later(const core::View& view, lod::Selection& later) {
  lod::select(options_, planet_.tree(), lod::select_view(view), scratch_, later);
  if (!occluding_) return;
  std::vector<std::uint8_t> hidden;
  occlude(later, view, hidden);
  std::size_t n = 0;
  std::erase_if(later.tiles, [&](const lod::SelectedTile&) { return hidden[n++] != 0; });
}

void TileCover::lay_out(const core::View& view) {
  const lod::Selection& drawn = drawn_.drawn;
  lod::skirt_depths(drawn, planet_.tree(), skirts_);
  const std::vector<TileNeed> needs = streamer_.needs_of(drawn, view);
  tiles_.clear();
  for (std::size_t n = 0; n < drawn.tiles.size(); ++n) {
    const lod::SelectedTile& tile = drawn.tiles[n];
    if (!hidden_.empty() && hidden_[n] != 0) continue;
    SceneTile& out = tiles_.emplace_back();
    out.tile = &tile;
    out.mesh = streamer_.mesh(tile, needs[n]);
    if (needs[n].texture != 0) out.texture = streamer_.texture(tile, needs[n]);
    out.skirt_m = skirts_[n];
    const double side = lod::nominal_side_m(tile.key.level, planet_.radius_m());
    for (float& depth : out.skirt_m) {
      if (depth > 0.0F) depth += static_cast<float>(kFootError * (tile.min_distance_m + 2.0 * side));
    }
  }
  find_seen_pieces(view);
}

// Ground that the sphere below all of it hides is hidden by what is drawn, which is within its errors of the ground.
void TileCover::find_seen_pieces(const core::View& view) {
  double geometric_error_m = 0;
  for (const SceneTile& t : tiles_) geometric_error_m = std::max(geometric_error_m, t.tile->geometric_error_m);
  const double occluder_m = planet_.tree().lowest_radius_m(drawn_.drawn.exaggeration) - geometric_error_m;
  const PieceView seen{cull::make_frustum(view), cull::make_horizon(cull::make_camera(view.camera.position_m),
                                                                    std::max(0.0, occluder_m))};
  std::vector<std::size_t> ends;
  ranges_.clear();
  for (const SceneTile& t : tiles_) {
    seen_ranges(t.mesh->pieces, t.mesh->frame, seen, ranges_);
    ends.push_back(ranges_.size());
  }
  std::size_t begin = 0;
  for (std::size_t n = 0; n < tiles_.size(); begin = ends[n++])
    tiles_[n].surface = std::span(ranges_).subspan(begin, ends[n] - begin);
}

std::size_t TileCover::bytes() const {
  std::size_t sum = 0;
  for (const SceneTile& t : tiles_) sum += t.mesh->bytes + (t.texture != nullptr ? t.texture->bytes : 0);
  return sum;
}

void TileCover::record_draw_time(double draw_ms) {
  if (!occluding_) {
    culling_.skip_frame();
    return;
  }
  culling_.record_frame({occlude_ms_, static_cast<int>(hidden_.size()),
                         static_cast<int>(std::count(hidden_.begin(), hidden_.end(), 1)),
                         draw_ms / std::max<double>(1.0, static_cast<double>(tiles_.size()))});
}

void TileCover::report(core::DrawResult& result) const {
  core::FrameStats& s = result.stats;
  s.occlude_ms = occlude_ms_;
  s.tiles_visited = wanted_.visited;
  s.tiles_culled_frustum = wanted_.culled_frustum;
  s.tiles_culled_horizon = wanted_.culled_horizon;
  s.tiles_culled_occlusion = static_cast<int>(std::count(hidden_.begin(), hidden_.end(), 1));
  s.tiles_drawn = static_cast<int>(tiles_.size());
  s.tiles_substituted = drawn_.substituted;
  s.triangles = 0;
  s.skirt_triangles = 0;
  s.tiles_by_level.clear();
  for (const SceneTile& t : tiles_) {
    const auto level = static_cast<std::size_t>(t.tile->key.level);
    if (s.tiles_by_level.size() <= level) s.tiles_by_level.resize(level + 1);
    ++s.tiles_by_level[level];
    const IndexRanges& ranges = t.mesh->ranges;
    s.triangles += ranges.surface / 3;
    for (const IndexRange& range : t.surface) s.triangles_in_sight += (range.end - range.begin) / 3;
    for (std::size_t e = 0; e < 4; ++e) {
      if (t.skirt_m[e] > 0.0F) s.skirt_triangles += (ranges.skirts[e + 1] - ranges.skirts[e]) / 2;
    }
  }
  result.missing.clear();
  for (const std::size_t n : drawn_.missing) {
    const lod::TileKey& key = wanted_.tiles[n].key;
    const std::string* why = streamer_.failure(key);
    result.missing.push_back({lod::to_string(key), why == nullptr ? "not loaded yet" : *why, why != nullptr});
  }
  for (const SceneTile& t : tiles_) {
    if (t.texture == nullptr) continue;
    if (const std::string* why = streamer_.coarse_colours(t.tile->key))
      result.missing.push_back({lod::to_string(t.tile->key), *why, true});
  }
  s.tiles_missing = static_cast<int>(result.missing.size());
}

}  // namespace vpe::gl
