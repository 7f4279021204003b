// What the loaders are asked for between frames.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/gl/tile_scene.h"

namespace vpe::gl {

namespace {

constexpr std::size_t kMostUpcoming = 3;
constexpr double kBufferZone = 1.25;  // the field of view of what is kept ready round a moving image
constexpr double kLater = 1e12;       // less urgent than anything of this view

// Tiles in the middle of the image count more: half at a radian from the view's axis, for instance.
double centre_weight(const lod::TileKey& key, const core::View& view, double radius_m) {
  const glm::dvec3 to = radius_m * lod::bounding_cap(key).centre - view.camera.position_m;
  const double angle = std::acos(std::clamp(glm::dot(glm::normalize(to), view.camera.axes.forward), -1.0, 1.0));
  return 1.0 / (1.0 + angle * angle);
}

// The drawn tile that holds the first corner of a tile.
const lod::SelectedTile* stand_in(const lod::Selection& drawn, const lod::TileKey& key) {
  const std::int64_t at = lod::z_position(key);
  const auto after =
      std::partition_point(drawn.tiles.begin(), drawn.tiles.end(),
                           [&](const lod::SelectedTile& t) { return lod::z_position(t.key) <= at; });
  return after == drawn.tiles.begin() ? nullptr : &*(after - 1);
}

}  // namespace

// How wrong the image is without the page, in pixels, more in the middle. Where a tile far above stands in,
// the levels between are wanted first, so that the image sharpens in steps.
void TileScene::ask(const core::DrawRequest& request, const lod::SelectOptions& options) {
  std::vector<TilePager::Want> wants;
  std::unordered_set<PageKey, PageKeyHash> asked;
  const bool any_failed = pager_.any_failed();
  const auto add = [&](const PageKey& page, double urgency) {
    if (unreadable_.count(page.tile) != 0 || is_resident(page, frame_) || !asked.insert(page).second) return;
    if (const auto why = any_failed ? pager_.failure(page) : std::nullopt) return note_failure(page, *why);
    wants.push_back({page, urgency});
  };
  if (!request.paging.wait) {
    const std::vector<TileNeed> needs = needs_of(wanted_, request.view);
    for (std::size_t n = 0; n < needs.size(); ++n) {
      const lod::SelectedTile& tile = wanted_.tiles[n];
      if (!not_needed_.empty() && not_needed_[n] != 0) continue;
      double urgency =
          0.5 * centre_weight(tile.key, request.view, planet_->radius_m());  // of its exact texture
      const lod::SelectedTile* stand = stand_in(drawn_.drawn, tile.key);
      if (stand != nullptr && stand->key.level < tile.key.level) {
        urgency *= 2.0 * std::min(stand->screen_space_error_px, 1e6);
        if (stand->key.level + 1 < tile.key.level) {
          const lod::TileKey step = lod::ancestor(tile.key, stand->key.level + 1);
          const TileNeed coarse = coarse_need(step);
          add(mesh_page(step, coarse.mesh), 2.0 * urgency);
          if (coarse.paint != 0)
            add(texture_page(step, needs[n].paint > 0 ? needs[n].paint : coarse.paint), 2.0 * urgency);
        }
      }
      add(mesh_page(tile.key, needs[n].mesh), urgency);
      if (needs[n].paint != 0) add(texture_page(tile.key, needs[n].paint), urgency);
    }
    if (needs_ground(request.view)) add(ground_page(request.view.camera.position_m), 1e6);
    if (request.cull_view && needs_ground(*request.cull_view))
      add(ground_page(request.cull_view->camera.position_m), 1e6);
    if (!wants.empty()) settled_ = false;
  }
  want_upcoming(request, options, wants);
  pager_.want(std::move(wants));
}

void TileScene::want_upcoming(const core::DrawRequest& request, const lod::SelectOptions& options,
                              std::vector<TilePager::Want>& wants) {
  if (!has_room()) return;
  std::vector<core::View> views(
      request.paging.upcoming.begin(),
      request.paging.upcoming.begin() +
          static_cast<std::ptrdiff_t>(std::min(request.paging.upcoming.size(), kMostUpcoming)));
  if (!request.paging.wait) {
    core::View wider = request.view;
    wider.fov_deg = std::min(kBufferZone * wider.fov_deg, core::ViewLimits::kMaxFov_deg);
    views.push_back(wider);
  }
  std::unordered_set<PageKey, PageKeyHash> asked;
  for (const TilePager::Want& w : wants) asked.insert(w.key);
  lod::Selection later;
  for (const core::View& view : views) {
    lod::select(options, planet_->tree(), lod::select_view(view), scratch_, later);
    if (occluding_) {
      std::vector<std::uint8_t> hidden;
      occlude(later, view, hidden);
      std::size_t n = 0;
      std::erase_if(later.tiles, [&](const lod::SelectedTile&) { return hidden[n++] != 0; });
    }
    std::vector<PageKey> pages = absent_pages(later, view, frame_ - 1);
    if (needs_ground(view)) pages.insert(pages.begin(), ground_page(view.camera.position_m));
    for (const PageKey& page : pages) {
      if (unreadable_.count(page.tile) != 0 || !asked.insert(page).second) continue;
      wants.push_back({page, -kLater - static_cast<double>(wants.size())});
    }
  }
}

}  // namespace vpe::gl
