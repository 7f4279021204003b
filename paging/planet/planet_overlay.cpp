#include "paging/planet/planet_overlay.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "paging/planet/planet_file.h"

namespace paging {

namespace {

constexpr double kMargin_rad = 1e-9;

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Returns a cap that holds the patch's finest tiles, or one of negative radius if it has none. Around these alone the
// reference surface changes.
mars::Cap changed_cap(const TilePatch& patch) {
  std::vector<mars::Cap> caps;
  glm::dvec3 sum{0, 0, 0};
  for (const PatchTile& tile : patch.tiles) {
    if (tile.row.inner) continue;
    caps.push_back(lod::bounding_cap(*lod::unpack(tile.row.key)));
    sum += caps.back().centre;
  }
  if (caps.empty()) return {{1, 0, 0}, -1};
  mars::Cap all{glm::length(sum) > 0.0 ? glm::normalize(sum) : caps.front().centre, 0};
  for (const mars::Cap& cap : caps)
    all.radius_rad =
        std::max(all.radius_rad, angle_between(all.centre, cap.centre) + cap.radius_rad + kMargin_rad);
  return all;
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
  for (const PatchTile& tile : patch->tiles) {
    tiles_[tile.row.key] = {patch, &tile, version};
    mark_below(tiles_below_, tile.row.key, version);
  }
  for (const PatchImage& image : patch->images) {
    images_[image.key] = {patch, &image, version};
    mark_below(images_below_, image.key, version);
  }
  if (const mars::Cap cap = changed_cap(*patch); cap.radius_rad >= 0) changes_.push_back({version, cap});
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
  const auto include = [&](std::uint64_t version) { newest = std::max(newest, version); };
  const auto include_tile = [&](const lod::TileKey& of) {
    if (const auto* found = overlay_->tile(lod::pack(of))) include(found->version);
  };
  const auto include_image = [&](const lod::TileKey& of) {
    if (const auto* found = overlay_->image(lod::pack(of))) include(found->version);
  };
  if (made_of == MadeOf::kImage) {
    include_image(key);
    return newest;
  }
  include_tile(key);
  if (made_of == MadeOf::kTile) return newest;
  for (const lod::Edge edge : lod::kEdges) {
    const lod::TileKey across = lod::neighbour(key, edge).key;
    include_tile(tree_->deepest(across).key);
    if (made_of == MadeOf::kArea) include(overlay_->tiles_below(lod::pack(across)));
  }
  if (made_of == MadeOf::kBorders) return newest;
  include(overlay_->tiles_below(lod::pack(key)));
  include(overlay_->images_below(lod::pack(key)));
  if (const auto image = image_key(key)) include_image(*image);
  return newest;
}

std::uint64_t PlanetFile::overlay_shadow_version(const lod::TileKey& key, double exaggeration) const {
  if (exaggeration != 1.0) return version_;
  // Posts are lifted by a part of their spacing before the sun is looked for (TerrainShader).
  const double lift_m = lod::nominal_side_m(key.level, meta_.radius_m) / meta_.tile.intervals();
  return std::max(file_->version_, overlay_->seen_from(lod::bounding_cap(key), lift_m));
}

}  // namespace paging
