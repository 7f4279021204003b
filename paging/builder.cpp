#include "paging/builder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <set>

#include "paging/build_steps.h"
#include "paging/planet_writer.h"
#include "paging/surface.h"
#include "vpe/core/parallel.h"

namespace paging {

namespace {

// Reports the stages of a build as one rising fraction.
class Stages {
 public:
  explicit Stages(const ProgressFunction& report) : report_(report) {}

  void begin(const char* name, std::int64_t total, double share) {
    done_share_ += share_;
    share_ = share;
    name_ = name;
    total_ = total;
    done_ = 0;
    tell();
  }

  void advance() {
    const std::lock_guard lock(mutex_);
    ++done_;
    tell();
  }

 private:
  void tell() {
    if (!report_) return;
    const double part = total_ > 0 ? static_cast<double>(done_) / static_cast<double>(total_) : 1.0;
    report_({name_, done_, total_, done_share_ + share_ * part});
  }

  const ProgressFunction& report_;
  std::mutex mutex_;
  const char* name_ = "";
  std::int64_t done_ = 0;
  std::int64_t total_ = 0;
  double share_ = 0;
  double done_share_ = 0;
};

// A power of two well below what the sources resolve: heights between their posts are interpolated, and a
// coarse step would show as terraces in slopes and shading.
double choose_quantum(const std::vector<mars::SourceInfo>& sources, double finest_spacing_m) {
  double step = 1.0;
  for (const mars::SourceInfo& s : sources) {
    step = std::min(step, s.quantum_m > 0 ? s.quantum_m / 16 : std::max(s.resolution_m, finest_spacing_m) / 512);
  }
  return std::clamp(std::exp2(std::floor(std::log2(step))), 1.0 / 4096.0, 1.0);
}

WantedSpacing wanted_elevation(const BuildOptions& options, const mars::ElevationSource& source) {
  return [&options, &source](const lod::TileKey&, const mars::Cap& cap) {
    const bool fine = options.regions.empty() || std::any_of(options.regions.begin(), options.regions.end(),
                                                             [&](const Region& r) { return touches(r, cap); });
    if (!fine) return options.base_spacing_m;
    return std::min(options.base_spacing_m, std::max(source.spacing_in(cap), options.finest_spacing_m));
  };
}

double mean_height(const mars::ElevationSource& source) {
  double sum = 0;
  std::int64_t count = 0;
  source.visit_posts(20000, [&](std::span<const glm::dvec3>, std::span<const double> heights) {
    for (const double h : heights) {
      if (!std::isfinite(h)) continue;
      sum += h;
      ++count;
    }
  });
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

ResamplingError measure_resampling(const mars::ElevationSource& source, const Surface& surface, std::size_t posts) {
  ResamplingError out;
  double squares = 0;
  std::vector<double> radius;
  source.visit_posts(posts, [&](std::span<const glm::dvec3> directions, std::span<const double> heights) {
    radius.resize(directions.size());
    surface.radius(directions, radius);
    for (std::size_t n = 0; n < directions.size(); ++n) {
      if (!std::isfinite(heights[n])) continue;
      const double error = std::abs(radius[n] - surface.planet_radius_m() - heights[n]);
      out.max_m = std::max(out.max_m, error);
      squares += error * error;
      ++out.posts;
    }
  });
  out.rms_m = out.posts > 0 ? std::sqrt(squares / static_cast<double>(out.posts)) : 0.0;
  return out;
}

std::vector<lod::TileKey> plan_images(const BuildOptions& options, const mars::ImageSource& image) {
  std::vector<lod::TileKey> tiles;
  for (int f = 0; f < mars::kFaces; ++f) tiles.push_back({static_cast<mars::Face>(f), 0, 0, 0});
  for (std::size_t at = 0; at < tiles.size(); ++at) {
    const lod::TileKey key = tiles[at];
    const double spacing = lod::post_spacing_m(key.level, kImageIntervals, options.radius_m);
    const double wanted = std::max(image.spacing_in(lod::bounding_cap(key)), options.finest_image_m);
    // A texel up to a fifth coarser than asked for is not worth four times the tiles.
    if (!(spacing > 1.2 * wanted) || key.level >= 20) continue;
    for (int c = 0; c < 4; ++c) tiles.push_back(lod::child(key, c));
  }
  return tiles;
}

}  // namespace

bool touches(const Region& region, const mars::Cap& cap) {
  const mars::LonLat centre = mars::lon_lat(cap.centre);
  const double reach_deg = cap.radius_rad / mars::kRadiansPerDegree;
  if (centre.lat_deg + reach_deg < region.south_deg || centre.lat_deg - reach_deg > region.north_deg) return false;
  // Width of a cap in longitude grows with latitude; a cap that holds a pole has all longitudes.
  const double lat = std::abs(centre.lat_deg) * mars::kRadiansPerDegree;
  if (lat + cap.radius_rad >= mars::kPi / 2) return true;
  const double half_width_deg = std::asin(std::sin(cap.radius_rad) / std::cos(lat)) / mars::kRadiansPerDegree;
  double width = region.east_deg - region.west_deg;
  if (width < 0) width += 360.0;
  if (width + 2 * half_width_deg >= 360.0) return true;
  double from_west = std::fmod(centre.lon_deg + half_width_deg - region.west_deg, 360.0);
  if (from_west < 0) from_west += 360.0;
  return from_west <= width + 2 * half_width_deg;
}

BuildSummary build_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                          const mars::ImageSource* image, const ProgressFunction& progress) {
  PlanetMeta meta;
  meta.body = options.body;
  meta.radius_m = options.radius_m;
  meta.tile.k = options.tile_k;
  meta.sources = elevation.infos();
  if (meta.sources.empty()) throw PlanetError("no elevation source: give at least one DEM");
  meta.datum = meta.sources.front().datum;
  meta.quantum_m = options.quantum_m > 0 ? options.quantum_m : choose_quantum(meta.sources, options.finest_spacing_m);
  meta.fill_m = std::round(mean_height(elevation) / meta.quantum_m) * meta.quantum_m;
  for (const mars::SourceInfo& s : meta.sources) meta.illustration = meta.illustration || s.illustration;
  if (image != nullptr) meta.image_sources = image->infos();

  const Plan plan(meta.tile, meta.radius_m, wanted_elevation(options, elevation));
  const std::vector<lod::TileKey> images = image != nullptr ? plan_images(options, *image) : std::vector<lod::TileKey>();
  PlanetWriter writer(options.output);
  Stages stages(progress);
  const int threads = options.threads > 0 ? options.threads : vpe::core::default_threads();
  MesherPool meshers;
  BuildContext context{options, meta, plan, elevation, writer, meshers, {}};

  // 1. Finest tiles: heights and meshes.
  const std::vector<lod::TileKey>& leaves = plan.leaves();
  std::vector<Node> leaf_nodes(leaves.size());
  stages.begin("sampling", static_cast<std::int64_t>(leaves.size()), 0.62);
  vpe::core::parallel_for(leaves.size(), threads, [&](std::size_t n) {
    leaf_nodes[n] = build_leaf(context, leaves[n]);
    stages.advance();
  });
  for (std::size_t n = 0; n < leaves.size(); ++n) context.nodes.emplace(leaves[n], std::move(leaf_nodes[n]));

  // 2. Inner tiles, deepest first: posts and meshes over their children's posts.
  const std::vector<lod::TileKey>& inner = plan.inner();
  stages.begin("meshing", static_cast<std::int64_t>(inner.size()), 0.15);
  for (std::size_t begin = 0; begin < inner.size();) {
    std::size_t end = begin;
    while (end < inner.size() && inner[end].level == inner[begin].level) ++end;
    std::vector<Node> made(end - begin);
    vpe::core::parallel_for(end - begin, threads, [&](std::size_t n) {
      made[n] = build_inner(context, inner[begin + n]);
      stages.advance();
    });
    for (std::size_t n = begin; n < end; ++n) context.nodes.emplace(inner[n], std::move(made[n - begin]));
    begin = end;
  }

  // 3. Every inner mesh against the finest posts and facets below it.
  constexpr std::size_t kChunk = 32;
  const std::size_t chunks = (leaves.size() + kChunk - 1) / kChunk;
  std::mutex merge;
  stages.begin("measuring", static_cast<std::int64_t>(chunks), 0.15);
  vpe::core::parallel_for(chunks, threads, [&](std::size_t c) {
    const auto found = measure_chunk(context, std::span(leaves).subspan(c * kChunk, std::min(kChunk, leaves.size() - c * kChunk)));
    {
      const std::lock_guard lock(merge);
      for (const auto& [key, terms] : found) context.nodes.at(key).variants.front().terms.include(terms);
    }
    stages.advance();
  });
  nest_errors(context);

  // 4. The image's own pyramid.
  stages.begin("image", static_cast<std::int64_t>(images.size()), 0.06);
  vpe::core::parallel_for(images.size(), threads, [&](std::size_t n) {
    build_image(context, *image, images[n]);
    stages.advance();
  });
  for (const lod::TileKey& key : images) meta.finest_image_level = std::max(meta.finest_image_level, key.level);
  meta.image_tiles = static_cast<std::int64_t>(images.size());

  BuildSummary summary;
  meta.tiles = static_cast<std::int64_t>(context.nodes.size());
  meta.leaf_tiles = static_cast<std::int64_t>(leaves.size());
  meta.lowest_radius_m = meta.highest_radius_m = meta.radius_m + context.nodes.begin()->second.lowest_m;
  for (const auto& [key, node] : context.nodes) {
    meta.lowest_radius_m = std::min(meta.lowest_radius_m, meta.radius_m + node.lowest_m);
    meta.highest_radius_m = std::max(meta.highest_radius_m, meta.radius_m + node.max_m);
    meta.finest_level = std::max(meta.finest_level, key.level);
    for (const lod::MeshVariant& v : node.variants) summary.mesh_triangles += v.triangles;
    writer.put_node(to_row(key, node));
  }
  writer.seal(meta);

  // 5. S against the sources' own posts, through the same reader that everybody uses.
  stages.begin("checking", 1, 0.02);
  {
    const Surface surface(PlanetFile::open(writer.part_path()), std::size_t{64} << 20);
    meta.resampling = measure_resampling(elevation, surface, options.resampling_posts);
  }
  stages.advance();  // the last chance to be interrupted
  writer.publish(meta);

  summary.posts = meta.leaf_tiles * meta.tile.post_count();
  summary.bytes = static_cast<std::int64_t>(std::filesystem::file_size(options.output));
  summary.meta = meta;
  return summary;
}

}  // namespace paging
