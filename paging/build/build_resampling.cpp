#include "paging/build/build_resampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "vpe/base/parallel.h"

namespace paging {

namespace {

// Number of posts that are looked up together: enough that neighbours in a source's rows share the reading of a
// tile.
constexpr std::size_t kBatch = std::size_t{1} << 19;

constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

// A batch of posts does not fit the caches, so a post keeps its place in the chart where its direction was.
struct SourcePost {
  glm::dvec3 place{};  // a direction; after locate() u and v
  double height_m = 0;
  std::uint32_t leaf = kNowhere;  // index of the finest tile, when it is one of the given ones
  int source = 0;                 // index into PlanetMeta::sources
};

class Meter {
 public:
  Meter(const SampleInputs& sampling, const StoredTiles& stored, std::span<const lod::TileKey> leaves,
        int threads, const std::function<void()>& step)
      : sampling_(sampling),
        stored_(stored),
        leaves_(leaves),
        threads_(threads),
        step_(step),
        by_leaf_(leaves.size()) {
    posts_.reserve(kBatch);
  }

  void add(std::span<const glm::dvec3> directions, std::span<const double> heights) {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      if (!std::isfinite(heights[n])) continue;
      posts_.push_back({directions[n], heights[n]});
      if (posts_.size() >= kBatch) measure();
    }
  }

  ResamplingReport finish() {
    measure();
    ResamplingReport out;
    for (std::size_t n = 0; n < leaves_.size(); ++n) {
      for (const auto& [source, sum] : by_leaf_[n]) {
        out.sums[{leaves_[n].level, source}].include(sum);
        out.tiles.push_back({lod::pack(leaves_[n]), {source, sum.error()}});
      }
    }
    return out;
  }

 private:
  // Neighbours mostly lie in one tile.
  void locate(std::span<SourcePost> posts) const {
    std::uint32_t last = kNowhere;
    mars::ChartRect inside;  // of the last tile
    for (SourcePost& p : posts) {
      const mars::ChartPoint point = mars::chart_point(p.place);
      const bool is_inside = last != kNowhere && point.face == leaves_[last].face && point.u > inside.u0 &&
                             point.u < inside.u1 && point.v > inside.v0 && point.v < inside.v1;
      if (!is_inside) {
        const lod::TileKey key = lod::tile_at(point, sampling_.plan.leaf_level(point));
        const auto leaf = std::lower_bound(leaves_.begin(), leaves_.end(), key, morton_less);
        last = leaf == leaves_.end() || *leaf != key ? kNowhere
                                                     : static_cast<std::uint32_t>(leaf - leaves_.begin());
        if (last != kNowhere) inside = lod::chart_rect(key);
      }
      p.leaf = last;
      p.place = {point.u, point.v, 0};
    }
  }

  std::vector<glm::dvec3> directions_of(std::span<const SourcePost> posts) const {
    std::vector<glm::dvec3> directions;
    if (sampling_.meta.sources.size() < 2) return directions;
    for (const SourcePost& p : posts) directions.push_back(p.place);
    return directions;
  }

  // Only posts that one source alone makes are visited, so it is the origin of their place.
  void find_sources(std::span<SourcePost> posts, std::span<const glm::dvec3> all_directions) const {
    if (all_directions.empty()) return;
    std::vector<glm::dvec3> directions;
    std::vector<std::size_t> numbers;
    for (std::size_t n = 0; n < posts.size(); ++n) {
      if (posts[n].leaf == kNowhere) continue;
      directions.push_back(all_directions[n]);
      numbers.push_back(n);
    }
    std::vector<int> origin(directions.size());
    sampling_.elevation.origin(directions, origin);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      posts[numbers[n]].source = origin[n];
      if (origin[n] < 0) posts[numbers[n]].leaf = kNowhere;
    }
  }

  void measure() {
    constexpr std::size_t kBlock = 4096;
    vpe::base::parallel_for((posts_.size() + kBlock - 1) / kBlock, threads_, [&](std::size_t n) {
      const auto block = std::span(posts_).subspan(n * kBlock, std::min(kBlock, posts_.size() - n * kBlock));
      const std::vector<glm::dvec3> directions = directions_of(block);
      locate(block);
      find_sources(block, directions);
    });
    // Numbers of posts by leaf: a counting sort.
    std::vector<std::size_t> end(leaves_.size() + 1);
    for (const SourcePost& p : posts_)
      if (p.leaf != kNowhere) ++end[p.leaf + 1];
    std::vector<std::size_t> runs;  // leaves that have posts
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
      if (end[leaf + 1] != 0) runs.push_back(leaf);
      end[leaf + 1] += end[leaf];
    }
    std::vector<std::size_t> begin(end.begin(), end.end() - 1);
    std::vector<std::uint32_t> by_leaf(end.back());
    for (std::size_t n = 0; n < posts_.size(); ++n)
      if (posts_[n].leaf != kNowhere) by_leaf[begin[posts_[n].leaf]++] = static_cast<std::uint32_t>(n);
    vpe::base::parallel_for(runs.size(), threads_, [&](std::size_t r) {
      const std::size_t leaf = runs[r];
      const lod::TileKey& key = leaves_[leaf];
      const lod::Posts posts = read_posts(stored_, key);
      const lod::GridLines lines = lod::grid_lines(key, posts.intervals);
      auto& sums = by_leaf_[leaf];
      for (std::size_t k = end[leaf]; k < end[leaf + 1]; ++k) {
        const SourcePost& p = posts_[by_leaf[k]];
        const double height_m = lod::surface_height(posts, lines, p.place.x, p.place.y, stored_.meta.radius_m);
        sums[p.source].add(std::abs(height_m - p.height_m));
      }
    });
    posts_.clear();
    step_();
  }

  const SampleInputs& sampling_;
  const StoredTiles& stored_;
  std::span<const lod::TileKey> leaves_;
  int threads_;
  const std::function<void()>& step_;
  std::vector<SourcePost> posts_;
  std::vector<std::map<int, ResamplingSum>> by_leaf_;  // by source
};

}  // namespace

ResamplingReport measure_resampling(const SampleInputs& sampling, const StoredTiles& stored,
                                    std::size_t most_posts, const mars::WantedCap& wanted,
                                    std::span<const lod::TileKey> leaves, int threads,
                                    const std::function<void()>& step) {
  Meter meter(sampling, stored, leaves, threads, step);
  sampling.elevation.visit_posts_in(
      most_posts, wanted, [&](std::span<const glm::dvec3> directions, std::span<const double> heights) {
        meter.add(directions, heights);
      });
  return meter.finish();
}

mars::WantedCap wanted_posts(const BuildOptions& options, const PlanetMeta& meta,
                             std::span<const lod::TileKey> leaves, bool are_some) {
  const bool is_regional =
      !options.regions.empty() &&
      std::ranges::any_of(meta.sources, [](const mars::SourceInfo& s) { return s.is_remote; });
  if (!is_regional && !are_some) return {};
  std::vector<mars::Cap> own;
  if (are_some) {
    for (const lod::TileKey& leaf : leaves) own.push_back(lod::bounding_cap(leaf));
  }
  return [&options, is_regional, are_some, own = std::move(own)](const mars::Cap& cap) {
    if (is_regional && std::ranges::none_of(options.regions, [&](const Region& r) { return touches(r, cap); }))
      return false;
    return !are_some || std::ranges::any_of(own, [&](const mars::Cap& tile) {
      return mars::angle_between_rad(tile.centre, cap.centre) <= tile.radius_rad + cap.radius_rad;
    });
  };
}

}  // namespace paging
