#include "paging/build/estimate.h"

#include <algorithm>

#include "paging/build/build_inputs.h"
#include "paging/build/build_steps.h"
#include "paging/build/shard_plan.h"
#include "vpe/base/parallel.h"

namespace paging {

namespace {

// Measured 2026-11-21, processor time of one core of a 2-core virtual machine: mola8 to 5.3 and 2.6 km, the
// same with relief added to 326 m, mdim21, the embedded Mars; docs/measurements/scaling.md.
constexpr double kLeafPost_s = 1.2e-6;  // sampled from a raster, meshed, measured, packed
constexpr double kInnerPost_s = 1.0e-6;
constexpr double kTexel_s = 0.2e-6;
// Besides, where a source is made up: the embedded Mars of 62 million posts, 2026-11-24.
constexpr double kMadeUpPost_s = 0.1e-6;
constexpr double kMadeUpTexel_s = 0.7e-6;
constexpr double kLeafPost_bytes = 2.9;
constexpr double kInnerPost_bytes = 1.7;
constexpr double kTexel_bytes = 0.75;
constexpr std::int64_t kIndexEntry_bytes = 700;  // of a tile, while it is built

std::int64_t rounded(double x) { return static_cast<std::int64_t>(x + 0.5); }

}  // namespace

BuildEstimate estimate_build(const BuildOptions& options, const BuildPlan& plan,
                             const mars::ElevationSource& elevation, const mars::ImageSource* image) {
  const lod::TileShape tile{options.tile_k};
  const ShardPlan shard = shard_plan(plan, options.shard);
  BuildEstimate out;
  out.leaf_tiles = static_cast<std::int64_t>(shard.leaves.size());
  out.inner_tiles = static_cast<std::int64_t>(shard.inner.size());
  if (image != nullptr) {
    const auto count = static_cast<std::int64_t>(plan_images(options, *image).size());
    out.image_tiles = options.shard.end(count) - options.shard.begin(count);
    for (const auto& layer : plan_layers(options, image)) {
      const auto own = static_cast<std::int64_t>(layer.size());
      out.layer_tiles += options.shard.end(own) - options.shard.begin(own);
    }
  }
  out.posts = out.leaf_tiles * tile.post_count();
  int coarsest = lod::kMaxLevel;
  for (const lod::TileKey& key : shard.leaves) coarsest = std::min(coarsest, key.level);
  out.coarsest_spacing_m = lod::post_spacing_m(coarsest, tile.intervals(), options.radius_m);
  out.largest_sagitta_m = facet_sagitta_m(out.coarsest_spacing_m, options.radius_m);
  const auto leaf_posts = static_cast<double>(out.posts);
  const auto inner_posts = static_cast<double>(out.inner_tiles * tile.post_count());
  const double texels =
      static_cast<double>(out.image_tiles + out.layer_tiles) * (kImageIntervals + 1) * (kImageIntervals + 1);
  const auto made_up = [](const std::vector<mars::SourceInfo>& infos) {
    return std::any_of(infos.begin(), infos.end(), [](const mars::SourceInfo& s) { return s.illustration; });
  };
  const double post_s = kLeafPost_s + (made_up(elevation.infos()) ? kMadeUpPost_s : 0);
  const double texel_s = kTexel_s + (image != nullptr && made_up(image->infos()) ? kMadeUpTexel_s : 0);
  out.bytes = rounded(kLeafPost_bytes * leaf_posts + kInnerPost_bytes * inner_posts + kTexel_bytes * texels);
  out.processor_s = post_s * leaf_posts + kInnerPost_s * inner_posts + texel_s * texels;
  out.wall_s = out.processor_s / (options.threads > 0 ? options.threads : vpe::base::default_threads());
  out.memory_bytes = (out.leaf_tiles + out.inner_tiles) * kIndexEntry_bytes;
  return out;
}

}  // namespace paging
