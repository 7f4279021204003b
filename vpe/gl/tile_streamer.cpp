#include "vpe/gl/tile_streamer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <new>

#include "paging/shading/texel_block.h"
#include "vpe/base/parallel.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

// Shares of the memory budget; the rest is for work in progress.
constexpr double kTerrainShaderShare = 0.14;
constexpr paging::ShaderBudgetShares kShaderShares{.textures = 0.7};  // a tenth of the budget
constexpr double kMeshShare = 0.17;
constexpr double kTextureShare = 0.34;
constexpr double kLoadedShare = 0.05;

// What OpenGL without a GPU keeps of a frame of some 400 000 triangles, and the images on their way out.
constexpr std::size_t kDriverBytes = std::size_t{160} << 20;

// Pages for later views are loaded while what this view needs takes up less than this part of the budget.
constexpr double kRoomForLater = 0.6;
constexpr double kRoomForCoarse = 0.9;  // they take a few per cent

// Below the camera now and soon, and below the culling camera.
constexpr std::size_t kGroundTiles = 8;

constexpr std::size_t kTakeAtOnce = std::size_t{1} << 20;

// Pages of later views count as used so many frames ago. Frames of a motion differ in how fine they are, so what one of them
// does not draw the next may need.
constexpr std::uint64_t kLaterAge = 8;

constexpr double kLater = 1e12;  // less urgent than anything of this view

std::size_t bytes_for_tiles(std::size_t memory_bytes, std::size_t index_bytes) {
  const std::size_t fixed = kDriverBytes + index_bytes;
  return std::max(memory_bytes / 8, memory_bytes - std::min(memory_bytes, fixed));
}

bool same_scale(const core::Appearance& a, const core::Appearance& b) {
  return a.colour == b.colour && a.palette == b.palette && a.palette_low == b.palette_low &&
         a.palette_high == b.palette_high && static_cast<const core::HsvRamp&>(a) == b;
}

// Grids fit every mesh of a tile, facets their own.
bool fits(const TextureDetail& detail, int variant) {
  return detail.texture > 0 || variant_of_facets(detail.texture) == variant;
}

// Tiles in the middle of the image count more: half at a radian from the view's axis, for instance.
double centre_weight(const lod::TileKey& key, const core::View& view, double radius_m) {
  const glm::dvec3 to = radius_m * lod::bounding_cap(key).centre - view.camera.position_m;
  const double angle = std::acos(std::clamp(glm::dot(glm::normalize(to), view.camera.axes.forward), -1.0, 1.0));
  return 1.0 / (1.0 + angle * angle);
}

// The drawn tile that holds the first corner of a tile.
const lod::SelectedTile* fallback_of(const lod::Selection& drawn, const lod::TileKey& key) {
  const std::int64_t at = lod::morton_position(key);
  const auto after =
      std::partition_point(drawn.tiles.begin(), drawn.tiles.end(),
                           [&](const lod::SelectedTile& t) { return lod::morton_position(t.key) <= at; });
  return after == drawn.tiles.begin() ? nullptr : &*(after - 1);
}

}  // namespace

TileStreamer::TileStreamer(std::shared_ptr<const paging::PlanetFile> planet, const RendererOptions& options)
    : planet_(std::move(planet)),
      options_(options),
      memory_(bytes_for_tiles(options.memory_bytes, planet_->tree().bytes())),
      terrain_shader_(std::make_shared<TerrainShader>(planet_, share(kTerrainShaderShare), kShaderShares)),
      loader_(planet_, terrain_shader_),
      load_([this](const PageKey& key) {
        if (options_.before_load) options_.before_load(key.tile);
        return loader_.load(key);
      }) {
  start_pager();
}

void TileStreamer::start_pager() {
  pager_.emplace(load_,
                 options_.threads > 0 ? std::min(options_.threads, base::kMaxThreads) : base::default_threads(),
                 share(kLoadedShare));
}

void TileStreamer::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  pager_.reset();
  const std::shared_ptr<const paging::PlanetFile> before = std::exchange(planet_, std::move(planet));
  memory_ = bytes_for_tiles(options_.memory_bytes, planet_->tree().bytes());
  terrain_shader_->change_planet(planet_, share(kTerrainShaderShare));
  loader_ = PageLoader(planet_, terrain_shader_);
  const auto is_other_texture = [&](const lod::TileKey& tile, const TextureDetail& t) {
    return paging::texture_version(*before, tile, t.texture, *t.shading) !=
           paging::texture_version(*planet_, tile, t.texture, *t.shading);
  };
  const auto is_other_tile = [&](const lod::TileKey& tile) {
    return planet_->tree().find(tile) == nullptr || before->version(tile) != planet_->version(tile);
  };
  const ShadingParams of_normals =
      normal_params(shading_ ? shading_->exaggeration : 1, gl::shadow_sun(material_));
  const auto has_other_normals = [&](const lod::TileKey& tile) {
    return paging::shading_version(*before, tile, paging::MadeOf::kBorders, of_normals) !=
           paging::shading_version(*planet_, tile, paging::MadeOf::kBorders, of_normals);
  };
  meshes_.drop([&](const lod::TileKey& tile, const MeshDetail& m, std::uint64_t) {
    return is_other_tile(tile) || (m.normals && has_other_normals(tile));
  });
  textures_.drop([&](const lod::TileKey& tile, const TextureDetail& t, std::uint64_t) {
    return is_other_tile(tile) || is_other_texture(tile, t);
  });
  std::erase_if(ground_, [&](const auto& g) { return is_other_tile(g.first); });
  failures_.clear();
  coarse_colours_.clear();
  requests_.clear();
  requested_.clear();
  has_new_planet_ = true;
  start_pager();
}

bool TileStreamer::begin_frame(const core::DrawRequest& request) {
  ++frame_;
  uploaded_ = 0;
  evicted_ = 0;
  new_failures_.clear();
  // The material stays that of the images before, so that their meshes serve and their textures are kept.
  wants_textures_ = request.want_colour;
  const bool has_new_planet = std::exchange(has_new_planet_, false);
  return set_shading(request) || has_new_planet;
}

bool TileStreamer::is_textured(const lod::TileKey& tile) const {
  return wants_textures_ && gl::is_textured(tile, *planet_, material_);
}

// Returns true if meshes or textures were dropped.
bool TileStreamer::set_shading(const core::DrawRequest& request) {
  const core::Appearance& appearance = request.settings;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (!paging::needs_scale(appearance, has_image)) {
    scale_ = nullptr;
  } else if (!scale_ || !same_scale(appearance, scale_appearance_)) {
    scale_ = std::make_shared<const core::ColourScale>(appearance);
    scale_appearance_ = appearance;
  }
  // Resident meshes without occluders would hide nothing. Once asked for, occluders are made from then on, so
  // that switching to and fro loses nothing.
  bool lost = false;
  if (!needs_occluders_ && request.settings.occlusion != core::Occlusion::kOff) {
    needs_occluders_ = true;
    lost = meshes_.bytes() > 0;
    meshes_.clear();
  }
  const TileMaterial now = gl::material(appearance, request.sun, has_image, scale_);
  if (shading_ && material_ == now) return lost;
  // Meshes of two exaggerations do not meet; another method needs other vertices and programs.
  const bool other_meshes = !shading_ || shading_->exaggeration != now.shading.exaggeration;
  const bool other_method = material_.method != now.method || material_.shows_nodata != now.shows_nodata ||
                            material_.shading.flat != now.shading.flat ||
                            material_.light.has_value() != now.light.has_value();
  const bool other_shadows = gl::shadow_sun(material_) != gl::shadow_sun(now);
  const bool lose_meshes = other_meshes || other_method || other_shadows;
  lost |= lose_meshes && meshes_.bytes() > 0;
  if (other_meshes) ground_.clear();
  if (lose_meshes) meshes_.clear();
  if (other_method) textures_.clear();
  material_ = now;
  has_other_shadings_ = true;
  if (!shading_ || *shading_ != now.shading) shading_ = std::make_shared<const ShadingParams>(now.shading);
  return lost;
}

void TileStreamer::drop_other_shadings() {
  if (!wants_textures_ || !std::exchange(has_other_shadings_, false)) return;
  textures_.drop([&](const lod::TileKey&, const TextureDetail& t, std::uint64_t frame) {
    return t.shading != shading_ && frame != frame_;  // drawn tiles have pointers to those of this frame
  });
}

std::vector<TileNeed> TileStreamer::needs_of(const lod::Selection& selection, const core::View& view) const {
  std::vector<TileNeed> needs =
      tile_needs(selection.tiles, view, *planet_, *terrain_shader_, {material_, share(kTextureShare)});
  if (!wants_textures_) {
    for (TileNeed& need : needs) need.texture = 0;
  }
  return needs;
}

TileNeed TileStreamer::coarse_need(const lod::TileKey& tile) const {
  const bool textured = is_textured(tile);
  return {{0, kTileCentre, needs_charts(tile, *planet_, material_), material_.light.has_value()},
          !textured        ? 0
          : shading_->flat ? facet_texture(0)
                           : kSmallestTexture};
}

PageKey TileStreamer::mesh_page(const lod::TileKey& tile, const MeshDetail& mesh) const {
  return {PageKind::kMesh, tile,
          mesh.variant,    mesh.origin,
          mesh.charts,     shading_->exaggeration,
          nullptr,         needs_occluders_,
          mesh.normals,    mesh.normals ? gl::shadow_sun(material_) : std::nullopt};
}

PageKey TileStreamer::texture_page(const lod::TileKey& tile, int texture) const {
  return {PageKind::kTexture, tile, texture, kTileCentre, true, 1, shading_};
}

PageKey TileStreamer::ground_page(const glm::dvec3& camera_m) const {
  const lod::TileKey finest = lod::tile_at(mars::chart_point(camera_m), lod::kMaxLevel);
  return {PageKind::kGround,
          planet_->tree().deepest(finest).key,
          0,
          kTileCentre,
          true,
          shading_->exaggeration,
          nullptr};
}

bool TileStreamer::is_resident(const PageKey& page, std::uint64_t frame) {
  switch (page.kind) {
    case PageKind::kMesh:
      return meshes_.find(page.tile, {page.detail, page.origin, page.charts, page.normals}, frame) != nullptr;
    case PageKind::kTexture: return textures_.find(page.tile, {page.detail, page.shading}, frame) != nullptr;
    case PageKind::kGround: break;
  }
  return ground(page.tile) != nullptr;
}

bool TileStreamer::is_drawable(const lod::TileInfo& tile, int variant) {
  const bool mesh = meshes_.best(tile.key, frame_,
                                 [&](const MeshDetail& m) { return m.variant == variant ? 0 : -1; }) != nullptr;
  if (!mesh) return false;
  // A tile that cannot be read any more keeps no light of an earlier sun.
  const bool any_shading = is_readable(tile.key);
  return !is_textured(tile.key) || textures_.best(tile.key, frame_, [&](const TextureDetail& t) {
    return fits(t, variant) && (any_shading || t.shading == shading_) ? 0 : -1;
  }) != nullptr;
}

const std::string* TileStreamer::failure(const lod::TileKey& tile) const {
  const auto at = failures_.find(tile);
  return at == failures_.end() ? nullptr : &at->second;
}

const std::string* TileStreamer::coarse_colours(const lod::TileKey& tile) const {
  const auto at = coarse_colours_.find(tile);
  return at == coarse_colours_.end() ? nullptr : &at->second;
}

const GpuMesh* TileStreamer::mesh(const lod::SelectedTile& tile, const TileNeed& need) {
  return meshes_.best(tile.key, frame_, [&](const MeshDetail& m) {
    return m.variant != tile.variant ? -1 : m == need.mesh ? 1 : 0;
  });
}

const GpuTexture* TileStreamer::texture(const lod::SelectedTile& tile, const TileNeed& need) {
  const TextureDetail wanted{need.texture, shading_};
  return textures_.best(tile.key, frame_, [&](const TextureDetail& t) {
    if (t == wanted) return 1 << 20;
    if (!fits(t, tile.variant)) return -1;
    return (t.shading == shading_ ? 1 << 16 : 0) + std::max(0, std::min(t.texture, wanted.texture));
  });
}

const lod::OccluderProfile* TileStreamer::occluders(const lod::TileKey& tile, const MeshDetail& mesh) {
  const GpuMesh* found = meshes_.find(tile, mesh, frame_);
  return found == nullptr ? nullptr : found->occluders.get();
}

const lod::OccluderProfile* TileStreamer::occluders(const lod::TileKey& tile, int variant) {
  const GpuMesh* found =
      meshes_.best(tile, frame_, [&](const MeshDetail& m) { return m.variant == variant ? 0 : -1; });
  return found == nullptr ? nullptr : found->occluders.get();
}

const paging::TileHeights* TileStreamer::ground(const lod::TileKey& tile) const {
  const auto at = std::find_if(ground_.begin(), ground_.end(), [&](const auto& g) { return g.first == tile; });
  return at == ground_.end() ? nullptr : at->second.get();
}

void TileStreamer::upload(Pager::Loaded page, std::uint64_t frame) {
  const PageKey& key = page.key;
  // Pages that were requested before a change of appearance are of no use.
  switch (key.kind) {
    case PageKind::kMesh: {
      if (key.exaggeration != shading_->exaggeration ||
          key.charts != needs_charts(key.tile, *planet_, material_))
        return;
      if (needs_occluders_ && !key.occluders) return;
      if (key.normals != material_.light.has_value() || key.shadow_sun != gl::shadow_sun(material_)) return;
      GpuMesh mesh = gl::upload(page.value.geometry);
      mesh.occluders = std::move(page.value.occluders);
      meshes_.insert(key.tile, {key.detail, key.origin, key.charts, key.normals}, std::move(mesh), frame);
      break;
    }
    case PageKind::kTexture:
      if (key.shading->flat != shading_->flat || !gl::is_textured(key.tile, *planet_, material_)) return;
      if (material_.light && key.shading->lit) return;  // the vertices would light it again
      textures_.insert(key.tile, {key.detail, key.shading}, gl::upload(page.value.shaded), frame);
      if (const std::string& why = page.value.coarse_because; !why.empty()) {
        if (coarse_colours_.emplace(key.tile, why).second && failures_.count(key.tile) == 0)
          new_failures_.push_back(why);
      }
      break;
    case PageKind::kGround:
      if (key.exaggeration != shading_->exaggeration) return;
      if (ground_.size() >= kGroundTiles) ground_.erase(ground_.begin());
      ground_.emplace_back(key.tile, page.value.ground);
      break;
  }
  ++uploaded_;
}

void TileStreamer::trim() {
  evicted_ += meshes_.trim(share(kMeshShare), frame_);
  evicted_ += textures_.trim(share(kTextureShare), frame_);
}

void TileStreamer::record_failure(const PageKey& page, const std::string& why) {
  if (failures_.emplace(page.tile, why).second) new_failures_.push_back(why);
}

TileStreamer::LoadOutcome TileStreamer::load(std::span<const PageKey> pages, std::span<const PageKey> then,
                                             Deadline deadline) {
  std::vector<Pager::Want> wants;
  std::unordered_set<PageKey, PageKeyHash> open;
  const auto urgency = [&] { return -static_cast<double>(wants.size()); };
  for (const PageKey& page : pages) {
    if (open.insert(page).second) wants.push_back({page, urgency()});
  }
  if (open.empty()) return LoadOutcome::kAll;
  for (const PageKey& page : then) {
    if (!is_resident(page)) wants.push_back({page, urgency()});
  }
  pager_->want(wants);
  while (!open.empty()) {
    const Pager::Outcome outcome = pager_->wait(deadline);
    if (outcome == Pager::Outcome::kTimeout) return LoadOutcome::kTimeout;
    for (Pager::Loaded& page : pager_->take(kTakeAtOnce)) {
      open.erase(page.key);
      upload(std::move(page), frame_);
    }
    trim();
    if (pager_->any_failed()) {
      bool failed = false;
      for (const PageKey& page : open) {
        if (const auto why = pager_->failure(page)) {
          record_failure(page, *why);
          failed = true;
        }
      }
      if (failed) return LoadOutcome::kFailure;
    }
  }
  return LoadOutcome::kAll;
}

bool TileStreamer::load_now(const PageKey& page) {
  try {
    auto [value, bytes] = load_(page);
    upload({page, std::move(value), bytes}, frame_);
    return true;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    record_failure(page, e.what());
    return false;
  }
}

std::uint64_t TileStreamer::later_frame() const { return frame_ > kLaterAge ? frame_ - kLaterAge : 0; }

void TileStreamer::take_loaded(double limit_ms) {
  const auto start = Clock::now();
  const auto elapsed_ms = [&] {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  };
  do {
    std::vector<Pager::Loaded> pages = pager_->take(kTakeAtOnce);
    if (pages.empty()) break;
    // Those of this view are marked when they are used; those of later views must not outlast them.
    for (Pager::Loaded& page : pages) upload(std::move(page), later_frame());
  } while (elapsed_ms() < limit_ms);
}

void TileStreamer::begin_requests() {
  requests_.clear();
  requested_.clear();
  later_meshes_ = later_textures_ = {};
  any_failed_ = pager_->any_failed();
}

void TileStreamer::request(const PageKey& page, double urgency) {
  if (!is_readable(page.tile) || is_resident(page) || !requested_.insert(page).second) return;
  if (const auto why = any_failed_ ? pager_->failure(page) : std::nullopt) {
    record_failure(page, *why);
    return;
  }
  requests_.push_back({page, urgency});
}

void TileStreamer::request_frame(const lod::Selection& wanted, std::span<const std::uint8_t> not_needed,
                                 const lod::Selection& drawn, const core::View& view) {
  const std::vector<TileNeed> needs = needs_of(wanted, view);
  for (std::size_t n = 0; n < needs.size(); ++n) {
    const lod::SelectedTile& tile = wanted.tiles[n];
    if (!not_needed.empty() && not_needed[n] != 0) continue;
    // A tile that is drawn may still lack its exact texture.
    double urgency = 0.5 * centre_weight(tile.key, view, planet_->radius_m());
    const lod::SelectedTile* fallback = fallback_of(drawn, tile.key);
    if (fallback != nullptr && fallback->key.level < tile.key.level) {
      urgency *= 2.0 * std::min(fallback->screen_space_error_px, 1e6);
      if (fallback->key.level + 1 < tile.key.level) {
        const lod::TileKey step = lod::ancestor(tile.key, fallback->key.level + 1);
        const TileNeed coarse = coarse_need(step);
        request(mesh_page(step, coarse.mesh), 2.0 * urgency);
        if (coarse.texture != 0) {
          request(texture_page(step, needs[n].texture > 0 ? needs[n].texture : coarse.texture), 2.0 * urgency);
        }
      }
    }
    request(mesh_page(tile.key, needs[n].mesh), urgency);
    if (needs[n].texture != 0) request(texture_page(tile.key, needs[n].texture), urgency);
  }
}

bool TileStreamer::has_room(std::size_t frame_bytes, double part) const {
  return static_cast<double>(frame_bytes) < part * static_cast<double>(share(kMeshShare + kTextureShare));
}

bool TileStreamer::has_room_for_later(std::size_t frame_bytes) const {
  return has_room(frame_bytes, kRoomForLater);
}

bool TileStreamer::has_room_for_coarse(std::size_t frame_bytes) const {
  return has_room(frame_bytes, kRoomForCoarse);
}

// Nearest tiles first. What is resident is marked as used in `frame`.
std::vector<PageKey> TileStreamer::absent_pages(const lod::Selection& selection, const core::View& view,
                                                std::uint64_t frame) {
  const std::vector<TileNeed> needs = needs_of(selection, view);
  std::vector<std::pair<double, PageKey>> absent;
  for (std::size_t n = 0; n < needs.size(); ++n) {
    const lod::SelectedTile& tile = selection.tiles[n];
    PageKey page = mesh_page(tile.key, needs[n].mesh);
    if (!is_resident(page, frame)) absent.emplace_back(tile.min_distance_m, page);
    if (needs[n].texture == 0) continue;
    page = texture_page(tile.key, needs[n].texture);
    if (!is_resident(page, frame)) absent.emplace_back(tile.min_distance_m, page);
  }
  std::stable_sort(absent.begin(), absent.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PageKey> pages;
  for (auto& [distance, page] : absent) pages.push_back(std::move(page));
  return pages;
}

void TileStreamer::request_later(const lod::Selection& selection, const core::View& view,
                                 std::optional<PageKey> first) {
  // So that they leave before those of this view and of the last ones.
  std::vector<PageKey> pages = absent_pages(selection, view, later_frame());
  if (first) pages.insert(pages.begin(), std::move(*first));
  // More than there is room for would be dropped before it is used, and loaded again for ever. Pages count as many bytes
  // as those that are resident do in the mean.
  later_meshes_.used = meshes_.bytes_since(later_frame());
  later_textures_.used = textures_.bytes_since(later_frame());
  const std::size_t mesh_bytes = meshes_.mean_bytes();
  const std::size_t texture_bytes = textures_.mean_bytes();
  for (const PageKey& page : pages) {
    if (!is_readable(page.tile) || requested_.count(page) > 0) continue;
    if (page.kind == PageKind::kMesh && !later_meshes_.take(mesh_bytes, share(kMeshShare))) continue;
    if (page.kind == PageKind::kTexture && !later_textures_.take(texture_bytes, share(kTextureShare))) continue;
    requested_.insert(page);
    requests_.push_back({page, -kLater - static_cast<double>(requests_.size())});
  }
}

bool TileStreamer::request_coarse(std::span<const lod::TileKey> tiles) {
  bool any = false;
  for (const lod::TileKey& tile : tiles) {
    if (!is_readable(tile)) continue;
    const TileNeed need = coarse_need(tile);
    std::vector<PageKey> pages{mesh_page(tile, need.mesh)};
    if (need.texture != 0) pages.push_back(texture_page(tile, need.texture));
    for (const PageKey& page : pages) {
      if (is_resident(page, frame_) || (any_failed_ && pager_->failure(page))) continue;
      if (!requested_.insert(page).second) continue;
      requests_.push_back({page, -kLater - static_cast<double>(requests_.size())});
      any = true;
    }
  }
  return any;
}

void TileStreamer::send_requests() { pager_->want(std::exchange(requests_, {})); }

void TileStreamer::report(core::DrawResult& result) const {
  const paging::PagerCounts counts = pager_->counts();
  core::FrameStats& s = result.stats;
  s.pages_uploaded = uploaded_;
  s.pages_evicted = evicted_;
  s.pages_wanted = static_cast<std::int64_t>(counts.wanted);
  s.pages_loading = static_cast<std::int64_t>(counts.loading);
  s.bytes_resident =
      static_cast<std::int64_t>(meshes_.bytes() + textures_.bytes() + terrain_shader_->bytes_resident() +
                                counts.bytes + planet_->tree().bytes());
  result.failures = new_failures_;
}

}  // namespace vpe::gl
