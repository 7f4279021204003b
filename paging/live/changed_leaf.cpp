#include "paging/live/changed_leaf.h"

#include <cmath>
#include <limits>
#include <map>

#include "paging/build/source_heights.h"
#include "vpe/base/number.h"

namespace paging {

namespace {

// Returns the posts that a coarser tile has too, by its level: its spacing is theirs, so that both tiles agree.
std::map<int, std::vector<std::size_t>> coarser_posts(const BuildPlan& plan, const lod::TileKey& key, int n,
                                                      int coarser_neighbour_mask) {
  std::map<std::size_t, int> levels;
  const int side = n + 1;
  for (const lod::Edge edge : lod::kEdges) {
    if ((coarser_neighbour_mask >> static_cast<int>(edge) & 1) == 0) continue;
    for (int a = 0; a <= n; a += 2) levels[edge_post(edge, a, side)] = key.level - 1;
  }
  for (int corner = 0; corner < 4; ++corner) {
    const bool east = (corner & 1) != 0;
    const bool north = (corner & 2) != 0;
    levels[edge_post(north ? lod::Edge::kNorth : lod::Edge::kSouth, east ? n : 0, side)] =
        plan.coarsest_level_at_corner(key, east, north);
  }
  std::map<int, std::vector<std::size_t>> by_level;
  for (const auto& [post, level] : levels)
    if (level != key.level) by_level[level].push_back(post);
  return by_level;
}

void require_storable(const PlanetMeta& meta, const glm::dvec3& direction, double height_m) {
  const bool fits = std::abs(height_m) <= std::numeric_limits<std::int32_t>::max() * meta.quantum_m &&
                    height_m >= (kLeastRadius - 1) * meta.radius_m;
  if (fits) return;
  using vpe::base::format_general;
  const mars::LonLat at = mars::lon_lat(direction);
  throw PlanetError("the changed ground at lon " + format_general(at.lon_deg, 10) + " lat " +
                    format_general(at.lat_deg, 10) + " has a height of " + vpe::base::format_number(height_m) +
                    " m, which a planet of radius " + vpe::base::format_number(meta.radius_m) +
                    " m cannot store in steps of " + vpe::base::format_number(meta.quantum_m) +
                    " m; make the change smaller");
}

}  // namespace

SampledLeaf changed_leaf(const PlanetMeta& meta, std::size_t planet_sources, const BuildPlan& plan,
                         const GroundGrid& ground, const GroundChange& change, const lod::TileKey& key) {
  const int n = meta.tile.intervals();
  const std::size_t posts = ground.height_m.size();
  SampledLeaf leaf;
  for (const lod::Edge edge : lod::kEdges)
    if (plan.edge_step(key, edge) != 0) leaf.coarser_neighbour_mask |= 1 << static_cast<int>(edge);
  leaf.lines = ground.lines;
  leaf.posts = {key, n, ground.height_m};
  std::vector<double>& heights = leaf.posts.height_m;
  const auto below_m = [&](std::size_t p) {
    return !ground.nodata.empty() && ground.nodata[p] ? std::numeric_limits<double>::quiet_NaN()
                                                      : ground.height_m[p];
  };
  for (std::size_t p = 0; p < posts; ++p) heights[p] = below_m(p);
  const auto spacing = [&](int level) { return lod::post_spacing_m(level, n, meta.radius_m); };
  std::vector<int> decided_by(posts);
  change.change(ground.directions, spacing(key.level), heights, decided_by);
  for (const auto& [level, some] : coarser_posts(plan, key, n, leaf.coarser_neighbour_mask)) {
    std::vector<glm::dvec3> at;
    std::vector<double> values;
    for (const std::size_t p : some) {
      at.push_back(ground.directions[p]);
      values.push_back(below_m(p));
    }
    std::vector<int> decided(some.size());
    change.change(at, spacing(level), values, decided);
    for (std::size_t m = 0; m < some.size(); ++m) {
      heights[some[m]] = values[m];
      decided_by[some[m]] = decided[m];
    }
  }
  leaf.nodata.resize(posts);
  leaf.source.resize(posts);
  for (std::size_t p = 0; p < posts; ++p) {
    if (!std::isfinite(heights[p])) {
      heights[p] = ground.height_m[p];
      leaf.nodata[p] = leaf.any_nodata = true;
      leaf.source[p] = -1;
      continue;
    }
    require_storable(meta, ground.directions[p], heights[p]);
    const int own = ground.source.empty() ? 0 : std::max(0, ground.source[p]);
    leaf.source[p] = decided_by[p] >= 0 ? static_cast<int>(planet_sources) + decided_by[p] : own;
  }
  round_and_constrain(meta, leaf);
  return leaf;
}

}  // namespace paging
