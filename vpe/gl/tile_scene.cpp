#include "vpe/gl/tile_scene.h"

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "lod/options.h"
#include "lod/reevaluate.h"
#include "vpe/base/parallel.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Share of the memory budget for each holder; the rest is for work in progress.
constexpr double kPainterShare = 0.14;
constexpr double kMeshShare = 0.17;
constexpr double kTextureShare = 0.34;
constexpr double kLoadedShare = 0.05;

// What OpenGL without a GPU keeps of a frame of some 400 000 triangles, and the images on their way out.
constexpr std::size_t kDriverBytes = std::size_t{160} << 20;
// Skirts reach farther down by this part of distance and tile side, for the rounding of their feet to float.
constexpr double kFootError = 1e-6;

// Pages for later views are loaded while what this view needs takes up less than this part of the budget.
constexpr double kRoomForLater = 0.6;

// Below the camera now and soon, and below the culling camera.
constexpr std::size_t kGroundTiles = 8;

constexpr std::size_t kTakeAtOnce = std::size_t{1} << 20;

std::size_t for_tiles(std::size_t memory_bytes, std::size_t index_bytes) {
  const std::size_t fixed = kDriverBytes + index_bytes;
  return std::max(memory_bytes / 8, memory_bytes - std::min(memory_bytes, fixed));
}

bool same_scale(const core::Appearance& a, const core::Appearance& b) {
  return a.colour == b.colour && a.palette == b.palette && a.palette_low == b.palette_low &&
         a.palette_high == b.palette_high && static_cast<const core::HsvRamp&>(a) == b;
}

// Grids fit every mesh of a tile, facets their own.
bool fits(const TextureDetail& texture, int variant) {
  return texture.paint > 0 || painted_variant(texture.paint) == variant;
}

}  // namespace

TileScene::TileScene(std::shared_ptr<const paging::PlanetFile> planet, const RendererOptions& options)
    : planet_(std::move(planet)),
      most_triangles_(most_triangles(options.memory_bytes)),
      memory_(for_tiles(options.memory_bytes, planet_->tree().bytes())),
      painter_(std::make_shared<TerrainShader>(planet_, share(kPainterShare))),
      loader_(planet_, painter_),
      load_([this, before = options.before_load](const PageKey& key) {
        if (before) before(key.tile);
        return loader_.load(key);
      }),
      pager_(load_,
             options.threads > 0 ? std::min(options.threads, base::kMaxThreads) : base::default_threads(),
             share(kLoadedShare)) {}

void TileScene::set_shading(const core::DrawRequest& request) {
  const core::Appearance& appearance = request.settings;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (!paging::needs_scale(appearance, has_image)) {
    scale_ = nullptr;
  } else if (!scale_ || !same_scale(appearance, scale_of_)) {
    scale_ = std::make_shared<const core::ColourScale>(appearance);
    scale_of_ = appearance;
  }
  // Those that are there have none, and would hide nothing. Once asked for they are made from then on, so that
  // switching to and fro loses nothing.
  if (!needs_occluders_ && request.settings.occlusion != core::Occlusion::kOff) {
    needs_occluders_ = true;
    meshes_.clear();
  }
  const TileMaterial now = gl::material(appearance, request.sun, has_image, scale_);
  if (shading_ && material_ == now) return;
  // Meshes of two exaggerations do not meet; what is painted in another way needs other vertices and programs.
  const bool other_meshes = !shading_ || shading_->exaggeration != now.shading.exaggeration;
  const bool other_paint = material_.by != now.by || material_.shows_nodata != now.shows_nodata ||
                           material_.shading.flat != now.shading.flat;
  if (other_meshes) ground_.clear();
  if (other_meshes || other_paint) meshes_.clear();
  if (other_paint) textures_.clear();
  material_ = now;
  other_shadings_ = true;
  if (!shading_ || *shading_ != now.shading) shading_ = std::make_shared<const ShadingParams>(now.shading);
}

// Once the image is complete nothing of what was drawn before a change is of use.
void TileScene::drop_other_shadings() {
  if (!std::exchange(other_shadings_, false)) return;
  textures_.drop([&](const TextureDetail& t) { return t.shading != shading_; });
}

std::vector<TileNeed> TileScene::needs_of(const lod::Selection& selection, const core::View& view) const {
  return tile_needs(selection.tiles, view, *planet_, *painter_, {material_, share(kTextureShare)});
}

PageKey TileScene::mesh_page(const lod::TileKey& tile, const MeshDetail& mesh) const {
  return {PageKind::kMesh,        tile,    mesh.variant,    mesh.origin, mesh.charts,
          shading_->exaggeration, nullptr, needs_occluders_};
}
PageKey TileScene::texture_page(const lod::TileKey& tile, int paint) const {
  return {PageKind::kTexture, tile, paint, kTileCentre, true, 1, shading_};
}
TileNeed TileScene::coarse_need(const lod::TileKey& tile) const {
  const bool textured = is_textured(tile, *planet_, material_);
  return {{0, kTileCentre, needs_charts(tile, *planet_, material_)},
          !textured        ? 0
          : shading_->flat ? facet_paint(0)
                           : kSmallestTexture};
}
PageKey TileScene::ground_page(const glm::dvec3& camera_m) const {
  const lod::TileKey finest = lod::tile_at(mars::chart_point(camera_m), lod::kMaxLevel);
  return {PageKind::kGround,
          planet_->tree().deepest(finest).key,
          0,
          kTileCentre,
          true,
          shading_->exaggeration,
          nullptr};
}

bool TileScene::is_resident(const PageKey& page, std::uint64_t frame) {
  switch (page.kind) {
    case PageKind::kMesh:
      return meshes_.find(page.tile, {page.detail, page.origin, page.charts}, frame) != nullptr;
    case PageKind::kTexture: return textures_.find(page.tile, {page.detail, page.shading}, frame) != nullptr;
    case PageKind::kGround: break;
  }
  return ground_tile(page.tile) != nullptr;
}

// With any origin and any texture; better than a coarser tile in both cases.
bool TileScene::can_be_drawn(const lod::TileInfo& tile, int variant) {
  const bool mesh = meshes_.best(tile.key, frame_,
                                 [&](const MeshDetail& m) { return m.variant == variant ? 0 : -1; }) != nullptr;
  if (!mesh) return false;
  return !is_textured(tile.key, *planet_, material_) ||
         textures_.best(tile.key, frame_, [&](const TextureDetail& t) { return fits(t, variant) ? 0 : -1; }) !=
             nullptr;
}

bool TileScene::is_readable(const lod::TileInfo& tile) const { return unreadable_.count(tile.key) == 0; }

void TileScene::upload(TilePager::Loaded page) {
  const PageKey& key = page.key;
  switch (key.kind) {
    case PageKind::kMesh:
      // Asked for before a change.
      if (key.exaggeration != shading_->exaggeration ||
          key.charts != needs_charts(key.tile, *planet_, material_))
        return;
      if (needs_occluders_ && !key.occluders) return;
      {
        GpuMesh mesh = gl::upload(page.value.geometry);
        mesh.occluders = std::move(page.value.occluders);
        meshes_.insert(key.tile, {key.detail, key.origin, key.charts}, std::move(mesh), frame_);
        break;
      }
    case PageKind::kTexture:
      if (key.shading->flat != shading_->flat || !is_textured(key.tile, *planet_, material_)) return;
      textures_.insert(key.tile, {key.detail, key.shading}, gl::upload(page.value.shaded), frame_);
      break;
    case PageKind::kGround:
      if (key.exaggeration != shading_->exaggeration) return;
      if (ground_.size() >= kGroundTiles) ground_.erase(ground_.begin());
      ground_.emplace_back(key.tile, page.value.ground);
      break;
  }
  ++stats_.pages_uploaded;
}

void TileScene::trim() {
  stats_.pages_evicted += meshes_.trim(share(kMeshShare), frame_);
  stats_.pages_evicted += textures_.trim(share(kTextureShare), frame_);
}

bool TileScene::has_room() const {
  std::size_t record_frame = 0;
  for (const SceneTile& t : tiles_)
    record_frame += t.mesh->bytes + (t.texture != nullptr ? t.texture->bytes : 0);
  return static_cast<double>(record_frame) <
         kRoomForLater * static_cast<double>(share(kMeshShare + kTextureShare));
}

// What a selection needs and is not resident, nearest tiles first; what is resident counts as used in `frame`.
std::vector<PageKey> TileScene::absent_pages(const lod::Selection& selection, const core::View& view,
                                             std::uint64_t frame) {
  const std::vector<TileNeed> needs = needs_of(selection, view);
  std::vector<std::pair<double, PageKey>> absent;
  for (std::size_t n = 0; n < needs.size(); ++n) {
    const lod::SelectedTile& tile = selection.tiles[n];
    PageKey page = mesh_page(tile.key, needs[n].mesh);
    if (!is_resident(page, frame)) absent.emplace_back(tile.min_distance_m, page);
    if (needs[n].paint == 0) continue;
    page = texture_page(tile.key, needs[n].paint);
    if (!is_resident(page, frame)) absent.emplace_back(tile.min_distance_m, page);
  }
  std::stable_sort(absent.begin(), absent.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PageKey> pages;
  for (auto& [distance, page] : absent) pages.push_back(std::move(page));
  return pages;
}

void TileScene::note_failure(const PageKey& page, const std::string& why) {
  if (unreadable_.emplace(page.tile, why).second) failures_.push_back(why);
}

TileScene::Load TileScene::load(std::span<const PageKey> pages, std::span<const PageKey> then,
                                Deadline deadline) {
  std::vector<TilePager::Want> wants;
  std::unordered_set<PageKey, PageKeyHash> open;
  const auto urgency = [&] { return -static_cast<double>(wants.size()); };
  for (const PageKey& page : pages) {
    if (open.insert(page).second) wants.push_back({page, urgency()});
  }
  if (open.empty()) return Load::kAll;
  for (const PageKey& page : then) {
    if (!is_resident(page, frame_)) wants.push_back({page, urgency()});
  }
  pager_.want(wants);
  while (!open.empty()) {
    const TilePager::Outcome outcome = pager_.wait(deadline);
    if (outcome == TilePager::Outcome::kTimeout) return Load::kTimeout;
    for (TilePager::Loaded& page : pager_.take(kTakeAtOnce)) {
      open.erase(page.key);
      upload(std::move(page));
    }
    trim();
    if (pager_.any_failed()) {
      bool failed = false;
      for (const PageKey& page : open) {
        if (const auto why = pager_.failure(page)) {
          note_failure(page, *why);
          failed = true;
        }
      }
      if (failed) return Load::kFailure;
    }
  }
  return Load::kAll;
}

void TileScene::take_some(double limit_ms) {
  const auto start = Clock::now();
  do {
    std::vector<TilePager::Loaded> pages = pager_.take(kTakeAtOnce);
    if (pages.empty()) break;
    for (TilePager::Loaded& page : pages) upload(std::move(page));
  } while (ms_since(start) < limit_ms);
}

// The roots of the faces that are missing, on this thread: loaders may all be busy for long. False when none
// could be added.
bool TileScene::load_roots(const lod::Selection& needed) {
  bool any = false;
  for (lod::TileTree::Index root = 0; root < mars::kFaces; ++root) {
    const lod::TileInfo& tile = planet_->tree()[root];
    const bool wanted = std::any_of(drawn_.missing.begin(), drawn_.missing.end(),
                                    [&](std::size_t n) { return needed.tiles[n].key.face == tile.key.face; });
    if (!wanted || !is_readable(tile) || can_be_drawn(tile, 0)) continue;
    const TileNeed coarse = coarse_need(tile.key);
    std::vector<PageKey> pages{mesh_page(tile.key, coarse.mesh)};
    if (coarse.paint != 0) pages.push_back(texture_page(tile.key, coarse.paint));
    for (const PageKey& page : pages) {
      try {
        auto [value, bytes] = load_(page);
        upload({page, std::move(value), bytes});
        any = true;
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception& e) {
        note_failure(page, e.what());
      }
    }
  }
  return any;
}

void TileScene::prepare(const core::DrawRequest& request) {
  ++frame_;
  stats_ = {};
  failures_.clear();
  settled_ = true;
  auto start = Clock::now();
  set_shading(request);
  const lod::SelectOptions options = lod::select_options(request, planet_->radius_m(), most_triangles_);
  lod::select(options, planet_->tree(), lod::select_view(request.cull_view.value_or(request.view)), scratch_,
              wanted_);
  if (request.cull_view) lod::reevaluate_for_view(lod::select_view(request.view), planet_->tree(), wanted_);
  stats_.select_ms = ms_since(start);
  start = Clock::now();
  const core::Occlusion occlusion = request.settings.occlusion;
  occluding_ = occlusion == core::Occlusion::kOn ||
               (occlusion == core::Occlusion::kAuto && (request.paging.wait || culling_.use()));
  hidden_.clear();
  not_needed_.clear();
  if (request.paging.wait) {
    complete(request, options);
  } else {
    take_some(request.paging.upload_ms);
    draw_what_is_there(request, options);
  }
  lay_out(request.view);
  ask(request, options);
  find_clearance(request.view);
  if (settled_) drop_other_shadings();
  trim();
  stats_.load_ms = ms_since(start);
}

void TileScene::lay_out(const core::View& view) {
  const lod::Selection& drawn = drawn_.drawn;
  lod::skirt_depths(drawn, planet_->tree(), skirts_);
  const std::vector<TileNeed> needs = needs_of(drawn, view);
  tiles_.clear();
  for (std::size_t n = 0; n < drawn.tiles.size(); ++n) {
    const lod::SelectedTile& tile = drawn.tiles[n];
    if (!hidden_.empty() && hidden_[n] != 0) continue;
    SceneTile& out = tiles_.emplace_back();
    out.tile = &tile;
    out.mesh = meshes_.best(tile.key, frame_, [&](const MeshDetail& m) {
      return m.variant != tile.variant ? -1 : m == needs[n].mesh ? 1 : 0;
    });
    if (needs[n].paint != 0) {
      const TextureDetail wanted{needs[n].paint, shading_};
      // Else the right look, else the nearest size.
      out.texture = textures_.best(tile.key, frame_, [&](const TextureDetail& t) {
        if (t == wanted) return 1 << 20;
        if (!fits(t, tile.variant)) return -1;
        return (t.shading == shading_ ? 1 << 16 : 0) + std::max(0, std::min(t.paint, wanted.paint));
      });
    }
    out.skirt_m = skirts_[n];
    const double side = lod::nominal_side_m(tile.key.level, planet_->radius_m());
    for (float& depth : out.skirt_m) {
      if (depth > 0.0F) depth += static_cast<float>(kFootError * (tile.min_distance_m + 2.0 * side));
    }
  }
}

double TileScene::nearest_m() const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const lod::SelectedTile& t : drawn_.drawn.tiles) nearest = std::min(nearest, t.min_distance_m);
  return nearest;
}

void TileScene::report(core::DrawResult& result) const {
  core::FrameStats& s = result.stats;
  s = stats_;
  s.tiles_visited = wanted_.visited;
  s.tiles_culled_frustum = wanted_.culled_frustum;
  s.tiles_culled_horizon = wanted_.culled_horizon;
  s.tiles_drawn = static_cast<int>(tiles_.size());
  s.tiles_missing = static_cast<int>(drawn_.missing.size());
  s.tiles_substituted = drawn_.substituted;
  s.tiles_culled_occlusion = static_cast<int>(std::count(hidden_.begin(), hidden_.end(), 1));
  for (const SceneTile& t : tiles_) {
    const auto level = static_cast<std::size_t>(t.tile->key.level);
    if (s.tiles_by_level.size() <= level) s.tiles_by_level.resize(level + 1);
    ++s.tiles_by_level[level];
    const IndexRanges& ranges = t.mesh->ranges;
    s.triangles += ranges.surface / 3;
    for (std::size_t e = 0; e < 4; ++e) {
      if (t.skirt_m[e] > 0.0F) s.skirt_triangles += (ranges.skirts[e + 1] - ranges.skirts[e]) / 2;
    }
  }
  const paging::PagerCounts counts = pager_.counts();
  s.pages_wanted = static_cast<std::int64_t>(counts.wanted);
  s.pages_loading = static_cast<std::int64_t>(counts.loading);
  s.bytes_resident =
      static_cast<std::int64_t>(meshes_.bytes() + textures_.bytes() + painter_->bytes_resident() +
                                counts.bytes + planet_->tree().bytes());
  result.settled = settled_;
  result.failures = failures_;
  result.missing.clear();
  for (const std::size_t n : drawn_.missing) {
    const lod::TileKey& key = wanted_.tiles[n].key;
    const auto why = unreadable_.find(key);
    result.missing.push_back({lod::to_string(key), why == unreadable_.end() ? "not loaded yet" : why->second});
  }
}

}  // namespace vpe::gl
