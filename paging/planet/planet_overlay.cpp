#include "paging/planet/planet_overlay.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "paging/planet/ground_version.h"
#include "paging/planet/planet_file.h"

namespace paging {

namespace {

constexpr double kMargin_rad = 1e-9;

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Changes that are kept one by one; older ones are joined. More: fewer pages with shadows are made again that need not be.
constexpr std::size_t kMostChanges = 32;

// Returns a cap that holds tiles, or one of negative radius if there are none.
mars::Cap cap_round(const std::vector<std::int64_t>& rows) {
  std::vector<mars::Cap> caps;
  glm::dvec3 sum{0, 0, 0};
  for (const std::int64_t row : rows) {
    caps.push_back(lod::bounding_cap(*lod::unpack(row)));
    sum += caps.back().centre;
  }
  if (caps.empty()) return {{1, 0, 0}, -1};
  mars::Cap all{glm::length(sum) > 0.0 ? glm::normalize(sum) : caps.front().centre, 0};
  for (const mars::Cap& cap : caps)
    all.radius_rad =
        std::max(all.radius_rad, angle_between(all.centre, cap.centre) + cap.radius_rad + kMargin_rad);
  return all;
}

// Returns a cap that holds two.
mars::Cap joined(const mars::Cap& a, const mars::Cap& b) {
  return {a.centre, std::max(a.radius_rad, angle_between(a.centre, b.centre) + b.radius_rad + kMargin_rad)};
}

bool same_terms(const lod::ErrorTerms& a, const lod::ErrorTerms& b) {
  return a.height_error_m == b.height_error_m && a.sagitta_m == b.sagitta_m && a.total_m == b.total_m;
}

bool same_row(const NodeRow& a, const NodeRow& b) {
  return a.min_m == b.min_m && a.max_m == b.max_m && a.inner == b.inner &&
         a.coarser_neighbour_mask == b.coarser_neighbour_mask && a.slope == b.slope && a.sources == b.sources &&
         a.posts_terms.has_value() == b.posts_terms.has_value() &&
         (!a.posts_terms || same_terms(*a.posts_terms, *b.posts_terms)) &&
         std::ranges::equal(a.variants, b.variants, [](const auto& v, const auto& w) {
           return v.triangles == w.triangles && same_terms(v.terms, w.terms);
         });
}

bool same_content(const PlanetOverlay::Tile& a, const PlanetOverlay::Tile& b) {
  if (a.source_numbers != b.source_numbers) return false;
  return a.tile == b.tile || (same_row(a.tile->row, b.tile->row) && a.tile->payload == b.tile->payload &&
                              a.tile->resampling == b.tile->resampling);
}

bool same_content(const PlanetOverlay::Image& a, const PlanetOverlay::Image& b) {
  return a.image == b.image || a.image->jpeg == b.image->jpeg;
}

void mark_below(std::unordered_map<std::int64_t, std::uint64_t>& below, std::int64_t row,
                std::uint64_t version) {
  for (lod::TileKey at = *lod::unpack(row);; at = lod::parent(at)) {
    below[lod::pack(at)] = version;
    if (at.level == 0) return;
  }
}

}  // namespace

void PlanetOverlay::add(const std::shared_ptr<const TilePatch>& patch, std::uint64_t version) {
  if (!patch->source_numbers.empty()) {
    const auto renumber = [&](std::vector<int>& numbers) {
      if (numbers.empty()) {
        numbers = patch->source_numbers;
      } else {
        for (int& number : numbers) number = patch->source_numbers[static_cast<std::size_t>(number)];
      }
    };
    renumber(source_numbers_);
    for (auto& [row, tile] : tiles_) renumber(tile.source_numbers);
  }
  std::vector<std::int64_t> finest;
  for (const PatchTile& tile : patch->tiles) {
    tiles_[tile.row.key] = {patch, &tile, version};
    mark_tile(tile.row.key, version);
    if (!tile.row.inner) finest.push_back(tile.row.key);
  }
  for (const PatchImage& image : patch->images) {
    images_[image.key] = {patch, &image, version};
    mark_below(images_below_, image.key, version);
  }
  // Around finest tiles alone the reference surface changes.
  add_change(version, cap_round(finest));
}

void PlanetOverlay::mark_tile(std::int64_t row, std::uint64_t version) {
  returned_tiles_.erase(row);
  mark_below(tiles_below_, row, version);
  lod::TileKey at = *lod::unpack(row);
  for (std::array<bool, 4> touches{true, true, true, true}; std::ranges::count(touches, true) > 0;) {
    EdgeVersions& along = tiles_along_[lod::pack(at)];
    for (std::size_t edge = 0; edge < 4; ++edge)
      if (touches[edge]) along[edge] = version;
    if (at.level == 0) return;
    const std::array<bool, 4> of_parent{at.i % 2 == 0, at.i % 2 != 0, at.j % 2 == 0, at.j % 2 != 0};
    for (std::size_t edge = 0; edge < 4; ++edge) touches[edge] = touches[edge] && of_parent[edge];
    at = lod::parent(at);
  }
}

// A change that a later one covers is never found. Where a place is near several that are joined, the last number counts.
void PlanetOverlay::add_change(std::uint64_t version, const mars::Cap& cap) {
  if (cap.radius_rad < 0) return;
  std::erase_if(changes_, [&](const Change& before) {
    return angle_between(cap.centre, before.cap.centre) + before.cap.radius_rad <= cap.radius_rad;
  });
  changes_.push_back({version, cap});
  if (changes_.size() <= kMostChanges) return;
  changes_[1].cap = joined(changes_[1].cap, changes_[0].cap);
  changes_.erase(changes_.begin());
}

// Each planet has one before it. A tile has the number of the last planet on this way with which it changed, so the largest
// number of several tiles names a planet since which none of them has changed.
void PlanetOverlay::follow(const PlanetOverlay& former, std::uint64_t version) {
  returned_tiles_ = former.returned_tiles_;
  returned_images_ = former.returned_images_;
  tiles_below_ = former.tiles_below_;
  images_below_ = former.images_below_;
  tiles_along_ = former.tiles_along_;
  changes_ = former.changes_;
  lowest_radius_m_ = std::min(lowest_radius_m_, former.lowest_radius_m_);
  highest_radius_m_ = std::max(highest_radius_m_, former.highest_radius_m_);
  std::vector<std::int64_t> finest;
  for (auto& [row, tile] : tiles_) {
    const Tile* before = former.tile(row);
    if (before != nullptr && same_content(tile, *before)) {
      tile.version = before->version;
      continue;
    }
    tile.version = version;
    mark_tile(row, version);
    if (!tile.tile->row.inner) finest.push_back(row);
  }
  for (const auto& [row, before] : former.tiles_) {
    if (tiles_.contains(row)) continue;
    mark_tile(row, version);
    returned_tiles_[row] = version;
    if (!before.tile->row.inner) finest.push_back(row);
  }
  add_change(version, cap_round(finest));
  for (auto& [row, image] : images_) {
    const Image* before = former.image(row);
    image.version = before != nullptr && same_content(image, *before) ? before->version : version;
    returned_images_.erase(row);
    if (image.version == version) mark_below(images_below_, row, version);
  }
  for (const auto& [row, before] : former.images_) {
    if (images_.contains(row)) continue;
    returned_images_[row] = version;
    mark_below(images_below_, row, version);
  }
}

// Where ground at q hides the sun from a place p, the line between them passes above the ground and so never below the
// lowest radius. The angle between p and q is then at most acos(lowest / p) + acos(lowest / q).
std::uint64_t PlanetOverlay::seen_from(const mars::Cap& cap, double lift_m) const {
  const double ratio = lowest_radius_m_ / (highest_radius_m_ + lift_m);
  const double reach_rad =
      2.0 * (ratio > 0.0 ? std::acos(std::min(1.0, ratio)) : std::numbers::pi) + kMargin_rad;
  for (auto change = changes_.rbegin(); change != changes_.rend(); ++change) {
    if (angle_between(cap.centre, change->cap.centre) <= cap.radius_rad + change->cap.radius_rad + reach_rad)
      return change->version;
  }
  return 0;
}

std::uint64_t PlanetFile::overlay_version(const lod::TileKey& key, MadeOf made_of) const {
  // The version of the file under the patches is smaller than any patch's.
  std::uint64_t newest = file_->version_;
  // What layers show is not in patches.
  if (made_of == MadeOf::kImage && !shown_layers_.empty()) return newest;
  const auto include = [&](std::uint64_t version) { newest = std::max(newest, version); };
  const auto include_tile = [&](const lod::TileKey& of) { include(overlay_->tile_version(lod::pack(of))); };
  const auto include_image = [&](const lod::TileKey& of) { include(overlay_->image_version(lod::pack(of))); };
  // The ground may go back to the file's while the choice of layers stays, so the larger of both numbers is no name.
  const auto with_layers = [&] { return images_version_ << kGroundVersionBits | newest; };
  if (made_of == MadeOf::kImage) {
    include_image(key);
    return with_layers();
  }
  include_tile(key);
  if (made_of == MadeOf::kTile) return newest;
  for (const lod::Edge edge : lod::kEdges) {
    const lod::Neighbour across = lod::neighbour(key, edge);
    include_tile(tree_->deepest(across.key).key);
    if (made_of == MadeOf::kArea) include(overlay_->tiles_along(lod::pack(across.key), across.edge));
  }
  if (made_of == MadeOf::kBorders) return newest;
  include(overlay_->tiles_below(lod::pack(key)));
  include(overlay_->images_below(lod::pack(key)));
  if (const auto image = image_key(key)) include_image(*image);
  // A finer image that is gone was shown before.
  for (int level = key.level; level >= 0 && overlay_->has_returned_images(); --level)
    include_image(lod::ancestor(key, level));
  return with_layers();
}

std::uint64_t PlanetFile::overlay_shadow_version(const lod::TileKey& key, double exaggeration) const {
  if (exaggeration != 1.0) return version_;
  // Posts are lifted by a part of their spacing before the sun is looked for (TerrainShader).
  const double lift_m = lod::nominal_side_m(key.level, meta_.radius_m) / meta_.tile.intervals();
  return std::max(file_->version_, overlay_->seen_from(lod::bounding_cap(key), lift_m));
}

}  // namespace paging
