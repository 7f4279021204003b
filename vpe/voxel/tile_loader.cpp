#include "vpe/voxel/tile_loader.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "vpe/base/parallel.h"
#include "vpe/voxel/downsampled_view.h"

namespace vpe::voxel {

namespace {

// Where the shown tile is more levels above the absent one, the level this far above is loaded first: it costs a
// 64th of the tiles.
constexpr int kStepLevels = 3;
constexpr double kStepUrgency = 64;
// Below everything that the view itself lacks.
constexpr double kLater = 1e-9;

bool is_same_image(const core::DrawRequest& a, const core::DrawRequest& b) {
  return same_view(a.view, b.view) && a.settings == b.settings && a.sun == b.sun &&
         a.coarsening == b.coarsening && a.want_colour == b.want_colour;
}

// Returns how many pixels the posts of a level are apart about where a tile lies.
double spacing_px(const core::View& view, const lod::TileKey& tile, int level, const lod::TileTree& tree) {
  const glm::dvec3 centre = tree.radius_m() * lod::bounding_cap(tile).centre;
  const double side_m = lod::nominal_side_m(tile.level, tree.radius_m());
  const double distance_m = std::max(glm::length(centre - view.camera.position_m) - side_m, 0.01 * side_m);
  return lod::nominal_side_m(level, tree.radius_m()) / tree.shape().intervals() * core::focal_px(view) /
         distance_m;
}

}  // namespace

TileLoader::TileLoader(const RangeCaster& caster, const ImagePainter& painter, int threads)
    : caster_(caster), painter_(painter), threads_(threads > 0 ? threads : base::default_threads()) {}

void TileLoader::load(const Page& page) const {
  if (page.kind == Page::Kind::kColours) {
    painter_.read(page.paint);
    return;
  }
  const lod::TileTree& tree = caster_.store().planet().tree();
  const auto tile = static_cast<lod::TileTree::Index>(tree.find(page.key) - tree.tiles().data());
  if (page.kind == Page::Kind::kGrids) {
    caster_.store().read(tile, page.family, page.paint.exaggeration);
    return;
  }
  try {
    caster_.surface().tile(page.key, page.paint.exaggeration);
  } catch (const paging::PlanetError& e) {
    caster_.store().record_failure(tile, e.what());
  }
}

void TileLoader::reset() {
  pager_.reset();
  last_.reset();
  loaded_.clear();
  reads_all_ = false;
}

bool TileLoader::begin(const core::DrawRequest& request) {
  if (!last_ || !is_same_image(*last_, request)) {
    loaded_.clear();
    reads_all_ = false;
    last_ = request;
    last_->paging = {};
  }
  if (pager_) {
    for (const Pager::Loaded& page : pager_->take(std::numeric_limits<std::size_t>::max()))
      loaded_.insert(page.key);
  }
  return reads_all_;
}

bool TileLoader::add(const core::View& view, const LackingTiles& lacking, double factor,
                     std::vector<Pager::Want>& wants) {
  const lod::TileTree& tree = caster_.store().planet().tree();
  bool was_dropped = false;
  const auto want = [&](const Page& page, int level_in_place, double more) {
    if (loaded_.contains(page)) return false;
    wants.push_back({page, factor * more * spacing_px(view, page.key, level_in_place, tree)});
    return true;
  };
  const auto want_in_steps = [&](const Page& page, int level_in_place) {
    if (page.key.level - level_in_place > kStepLevels) {
      Page step = page;
      step.key = step.paint.key = lod::ancestor(page.key, page.key.level - kStepLevels);
      want(step, level_in_place, kStepUrgency);
    }
    was_dropped = !want(page, level_in_place, 1) || was_dropped;
  };
  for (const AbsentTile& absent : lacking.ground) {
    if (absent.failure) continue;
    Page page;
    page.kind = absent.for_single_rays ? Page::Kind::kSurface : Page::Kind::kGrids;
    page.key = tree[absent.tile].key;
    page.family = absent.family;
    page.paint.exaggeration = lacking.exaggeration;
    const int level_in_place = tree[absent.source].key.level;
    if (absent.for_single_rays) {
      was_dropped = !want(page, level_in_place, 1) || was_dropped;
    } else {
      want_in_steps(page, level_in_place);
    }
  }
  for (const AbsentPage& absent : lacking.colours) {
    if (absent.failure) continue;
    Page page;
    page.kind = Page::Kind::kColours;
    page.key = absent.page.key;
    page.paint = absent.page;
    if (page.paint.is_image) {
      was_dropped = !want(page, absent.shown.level, 1) || was_dropped;
    } else {
      want_in_steps(page, absent.shown.level);
    }
  }
  return was_dropped;
}

bool TileLoader::request(const core::View& view, const LackingTiles& lacking,
                         std::span<const Expected> expected) {
  std::vector<Pager::Want> wants;
  const bool was_dropped = add(view, lacking, 1, wants);
  const bool is_lacking = !wants.empty();
  // What is not on its way any more was dropped: the caches cannot hold all of the image.
  if (was_dropped && !is_lacking) reads_all_ = true;
  double factor = kLater;
  for (const Expected& later : expected) {
    add(later.view, later.lacking, factor, wants);
    factor *= kLater;
  }
  if (!pager_ && !wants.empty()) {
    pager_.emplace(
        [this](const Page& page) {
          load(page);
          return std::pair(char{}, std::size_t{0});
        },
        threads_, 1);
  }
  if (pager_) pager_->want(std::move(wants));
  return is_lacking || was_dropped;
}

std::vector<core::MissingTile> missing_tiles(const lod::TileTree& tree, const LackingTiles& lacking) {
  std::map<std::string, core::MissingTile> by_name;
  const auto add = [&](const lod::TileKey& key, const std::optional<std::string>& failure) {
    core::MissingTile& tile = by_name[lod::to_string(key)];
    if (tile.is_unreadable) return;
    tile = {lod::to_string(key), failure.value_or("not loaded yet"), failure.has_value()};
  };
  for (const AbsentTile& absent : lacking.ground) add(tree[absent.tile].key, absent.failure);
  for (const AbsentPage& absent : lacking.colours) add(absent.page.key, absent.failure);
  std::vector<core::MissingTile> out;
  for (auto& [name, tile] : by_name) out.push_back(std::move(tile));
  return out;
}

}  // namespace vpe::voxel
