#include "paging/surface/tile_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace paging {

namespace {

// Puts the posts of a tile's children together.
lod::Posts children_posts(const PlanetFile& planet, const lod::TileKey& key) {
  const int half = planet.meta().tile.intervals();
  lod::Posts out{key, 2 * half, {}};
  const auto side = static_cast<std::size_t>(out.side());
  out.height_m.resize(side * side);
  for (int c = 0; c < 4; ++c) {
    const lod::Posts posts = planet.heights(lod::child(key, c)).posts;
    for (int j = 0; j <= half; ++j) {
      const std::size_t row = static_cast<std::size_t>(j + (c / 2) * half) * side;
      for (int i = 0; i <= half; ++i)
        out.height_m[row + static_cast<std::size_t>(i + (c % 2) * half)] = posts.at(i, j);
    }
  }
  return out;
}

}  // namespace

// The error of the children's posts; infinite where it is not known.
double TileErrors::below_m(const lod::SelectedTile& tile, double exaggeration) const {
  const lod::TileTree& tree = planet_->tree();
  double most_m = 0;
  for (lod::TileTree::Index c = 0; tree[tile.index].has_children && c < 4; ++c) {
    const lod::TileInfo& child = tree[tree.first_child(tile.index) + c];
    if (!child.has_children) continue;
    most_m = std::max(most_m, child.posts_terms.known()
                                  ? tree.geometric_error_m(child, child.posts_terms.terms(), exaggeration)
                                  : std::numeric_limits<double>::infinity());
  }
  return most_m;
}

bool TileErrors::says_more(const lod::SelectedTile& tile, double exaggeration) const {
  const lod::TileInfo& info = planet_->tree()[tile.index];
  if (lod::is_full_grid(info, tile.variant) || (info.has_children && exaggeration != 1.0)) return false;
  return below_m(tile, exaggeration) < tile.geometric_error_m;
}

TileErrors::Key TileErrors::key_of(const lod::SelectedTile& tile, double exaggeration) const {
  Key key{tile.key,
          tile.variant,
          exaggeration,
          {planet_->version(tile.key)},
          below_m(tile, exaggeration),
          tile.geometric_error_m};
  for (int c = 0; planet_->tree()[tile.index].has_children && c < 4; ++c)
    key.versions[static_cast<std::size_t>(c) + 1] = planet_->version(lod::child(tile.key, c));
  return key;
}

TileErrors::Pointer TileErrors::find(const lod::SelectedTile& tile, double exaggeration) {
  if (!says_more(tile, exaggeration)) return nullptr;
  const Pointer found = kept_->get(key_of(tile, exaggeration), [&] {
    auto errors = std::make_shared<lod::BlockErrors>();
    try {
      *errors = measure(tile, exaggeration);
    } catch (const PlanetError&) {
    }
    const std::size_t bytes = errors->bytes();
    return std::pair(Pointer(std::move(errors)), bytes);
  });
  return found->bound_m.empty() ? nullptr : found;
}

std::optional<TileErrors::Pointer> TileErrors::find_measured(const lod::SelectedTile& tile,
                                                             double exaggeration) {
  if (!says_more(tile, exaggeration)) return Pointer();
  const Pointer found = kept_->find(key_of(tile, exaggeration));
  if (found == nullptr) return std::nullopt;
  return found->bound_m.empty() ? nullptr : found;
}

lod::BlockErrors TileErrors::measure(const lod::SelectedTile& tile, double exaggeration) const {
  const PackedMesh packed = planet_->mesh(tile.key, tile.variant);
  std::vector<double> heights;
  for (const std::int32_t q : packed.height_q) heights.push_back(q * planet_->meta().quantum_m);
  const lod::Posts posts = planet_->tree()[tile.index].has_children
                               ? children_posts(*planet_, tile.key)
                               : planet_->heights(tile.key, exaggeration).posts;
  lod::BlockErrorOptions options{planet_->radius_m(), exaggeration};
  options.rows = std::min(options.rows, posts.intervals);
  lod::BlockErrors errors = lod::block_errors(packed.mesh, heights, posts, options);
  const double posts_m = below_m(tile, exaggeration);
  for (float& bound_m : errors.bound_m) {
    const double all_m = std::min(static_cast<double>(bound_m) + posts_m, tile.geometric_error_m);
    bound_m = std::nextafter(static_cast<float>(all_m), std::numeric_limits<float>::infinity());
  }
  return errors;
}

}  // namespace paging
