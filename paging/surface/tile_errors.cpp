#include "paging/surface/tile_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace paging {

std::shared_ptr<const lod::Posts> TileErrors::posts_of(const lod::TileKey& key) const {
  return posts_->get({key, planet_->version(key)}, [&] {
    auto posts = std::make_shared<lod::Posts>(planet_->heights(key).posts);
    const std::size_t bytes = sizeof(*posts) + posts->height_m.capacity() * sizeof(posts->height_m[0]);
    return std::pair(std::shared_ptr<const lod::Posts>(std::move(posts)), bytes);
  });
}

// Puts the posts of a tile's children together.
lod::Posts TileErrors::children_posts(const lod::TileKey& key) const {
  const int half = planet_->meta().tile.intervals();
  lod::Posts out{key, 2 * half, {}};
  const auto side = static_cast<std::size_t>(out.side());
  out.height_m.resize(side * side);
  for (int c = 0; c < 4; ++c) {
    const std::shared_ptr<const lod::Posts> posts = posts_of(lod::child(key, c));
    for (int j = 0; j <= half; ++j) {
      const std::size_t row = static_cast<std::size_t>(j + (c / 2) * half) * side;
      for (int i = 0; i <= half; ++i)
        out.height_m[row + static_cast<std::size_t>(i + (c % 2) * half)] = posts->at(i, j);
    }
  }
  return out;
}

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
  if (lod::is_full_grid(info, tile.variant)) return false;
  if (info.has_children && exaggeration != 1.0) return false;
  return below_m(tile, exaggeration) < tile.geometric_error_m;
}

TileErrors::Key TileErrors::key_of(const lod::SelectedTile& tile, double exaggeration) const {
  Key key{tile.key, tile.variant, exaggeration, {planet_->version(tile.key)}, 0, 0};
  for (int c = 0; planet_->tree()[tile.index].has_children && c < 4; ++c)
    key.versions[static_cast<std::size_t>(c) + 1] = planet_->version(lod::child(tile.key, c));
  return key;
}

TileErrors::Pointer TileErrors::find_mesh(const lod::SelectedTile& tile, double exaggeration) {
  return of_meshes_->get(key_of(tile, exaggeration), [&] {
    auto errors = std::make_shared<lod::BlockErrors>();
    try {
      *errors = measure(tile, exaggeration);
    } catch (const PlanetError&) {
    }
    const std::size_t bytes = errors->bytes();
    return std::pair(Pointer(std::move(errors)), bytes);
  });
}

TileErrors::Pointer TileErrors::find(const lod::SelectedTile& tile, double exaggeration) {
  if (!says_more(tile, exaggeration)) return nullptr;
  const Pointer of_mesh = find_mesh(tile, exaggeration);
  if (of_mesh->bound_m.empty()) return nullptr;
  Key key = key_of(tile, exaggeration);
  key.below_m = below_m(tile, exaggeration);
  key.most_m = tile.geometric_error_m;
  return kept_->get(key, [&] {
    auto errors = std::make_shared<lod::BlockErrors>(*of_mesh);
    for (float& bound_m : errors->bound_m) {
      const double all_m = std::min(static_cast<double>(bound_m) + key.below_m, key.most_m);
      bound_m = std::nextafter(static_cast<float>(all_m), std::numeric_limits<float>::infinity());
    }
    const std::size_t bytes = errors->bytes();
    return std::pair(Pointer(std::move(errors)), bytes);
  });
}

std::optional<TileErrors::Pointer> TileErrors::find_measured(const lod::SelectedTile& tile,
                                                             double exaggeration) {
  if (!says_more(tile, exaggeration)) return Pointer();
  if (of_meshes_->find(key_of(tile, exaggeration)) == nullptr) return std::nullopt;
  return find(tile, exaggeration);
}

lod::BlockErrors TileErrors::measure(const lod::SelectedTile& tile, double exaggeration) const {
  const PackedMesh packed = planet_->mesh(tile.key, tile.variant);
  std::vector<double> heights;
  for (const std::int32_t q : packed.height_q) heights.push_back(q * planet_->meta().quantum_m);
  const lod::Posts posts = planet_->tree()[tile.index].has_children
                               ? children_posts(tile.key)
                               : planet_->heights(tile.key, exaggeration).posts;
  lod::BlockErrorOptions options{planet_->radius_m(), exaggeration};
  options.rows = std::min(options.rows, posts.intervals);
  return lod::block_errors(packed.mesh, heights, posts, options);
}

}  // namespace paging
