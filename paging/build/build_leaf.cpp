#include <algorithm>
#include <cmath>

#include "lod/mesh/error_meter.h"
#include "paging/build/build_grid.h"
#include "paging/build/nodata_fill.h"
#include "paging/build/source_heights.h"
#include "paging/planet/layer_tile.h"
#include "paging/planet/tile_sources.h"
#include "vpe/base/mutation.h"
#include "vpe/core/appearance/nodata_pattern.h"
#include "vpe/core/image/image.h"

namespace paging {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

// Finest tiles have meshes of decreasing error, the second a quarter of the first and each later one half of the one
// before, until the next one would come close to the full grid, which is the last. The tolerance of a variant is the same
// in all tiles of a level, since equal variants meet exactly (lod::skirt_depths). Where ground is so rough that many tiles
// of an image would be full grids, meshes go on up to a larger share.
constexpr double kLastMeshShare = 0.1;
constexpr double kLastRoughShare = 0.4;
constexpr double kFirstStep = 0.25;
constexpr double kLaterStep = 0.5;
constexpr int kMaxMeshVariants = 12;
// Edges beside a border cannot be repaired by its posts, so the error of a mesh is above its tolerance where the border
// keeps too few. Smaller: more triangles along borders. Not of the first mesh: its borders are those of inner tiles.
constexpr double kBorderShare = 0.5;

// Returns true if a mesh is too far off to be drawn from the distance of a tile's side, at an error of a pixel and a
// focal length of 1024 pixels.
bool is_needed_finer(const lod::ErrorTerms& terms, double side_m) {
  constexpr double kFocal_px = 1024;
  return terms.total_m * kFocal_px > side_m;
}

// Samples heights, and the sources of posts on a planet of several.
void sample_posts(const SampleInputs& sampling, std::span<const glm::dvec3> directions, double spacing_m,
                  std::span<double> heights, std::span<int> source) {
  if (source.empty()) {
    sampling.elevation.sample(directions, spacing_m, heights);
  } else {
    sampling.elevation.sample_with_origin(directions, spacing_m, heights, source);
  }
}

// Border posts take the spacing of the coarsest tile that has them, so that both sides sample the same. Sets the
// levels of these posts.
void resample_borders(const SampleInputs& sampling, const lod::TileKey& key, int coarser_neighbour_mask,
                      const std::vector<glm::dvec3>& directions, std::vector<double>& heights,
                      std::vector<int>& source, std::vector<int>& levels) {
  const int n = sampling.meta.tile.intervals();
  const int side = n + 1;
  const auto spacing = [&](int level) { return lod::post_spacing_m(level, n, sampling.meta.radius_m); };
  for (const lod::Edge edge : lod::kEdges) {
    if ((coarser_neighbour_mask >> static_cast<int>(edge) & 1) == 0) continue;
    std::vector<glm::dvec3> at;
    for (int a = 0; a <= n; a += 2) at.push_back(directions[edge_post(edge, a, side)]);
    std::vector<double> values(at.size());
    std::vector<int> origins(source.empty() ? 0 : at.size());
    sample_posts(sampling, at, spacing(key.level - 1), values, origins);
    for (int a = 0; a <= n; a += 2) {
      heights[edge_post(edge, a, side)] = values[static_cast<std::size_t>(a / 2)];
      if (!origins.empty()) source[edge_post(edge, a, side)] = origins[static_cast<std::size_t>(a / 2)];
      levels[edge_post(edge, a, side)] = key.level - 1;
    }
  }
  for (int corner = 0; corner < 4; ++corner) {
    const bool east = (corner & 1) != 0;
    const bool north = (corner & 2) != 0;
    const std::size_t post = edge_post(north ? lod::Edge::kNorth : lod::Edge::kSouth, east ? n : 0, side);
    const int level = sampling.plan.coarsest_level_at_corner(key, east, north);
    if (level == key.level) continue;
    sample_posts(sampling, std::span(&directions[post], 1), spacing(level), std::span(&heights[post], 1),
                 source.empty() ? std::span<int>() : std::span(&source[post], 1));
    levels[post] = level;
  }
}

std::set<int> sources_of(const PlanetMeta& meta, const SampledLeaf& leaf) {
  if (meta.sources.size() == 1) return {0};
  std::set<int> found;
  int last = -1;
  for (const int source : leaf.source)
    if (source != last) found.insert(last = source);
  found.erase(-1);
  return found;
}

}  // namespace

SampledLeaf sample_leaf(const SampleInputs& sampling, const lod::TileKey& key) {
  const PlanetMeta& meta = sampling.meta;
  const int n = meta.tile.intervals();
  SampledLeaf leaf;
  for (const lod::Edge edge : lod::kEdges) {
    if (sampling.plan.edge_step(key, edge) != 0) leaf.coarser_neighbour_mask |= 1 << static_cast<int>(edge);
  }
  leaf.lines = lod::grid_lines(key, n);
  leaf.directions = post_directions(key, leaf.lines);
  leaf.posts = {key, n, std::vector<double>(leaf.directions.size())};
  std::vector<double>& heights = leaf.posts.height_m;
  if (meta.sources.size() > 1) leaf.source.resize(heights.size());
  sample_posts(sampling, leaf.directions, lod::post_spacing_m(key.level, n, meta.radius_m), heights,
               leaf.source);
  std::vector<int> levels(heights.size(), key.level);
  resample_borders(sampling, key, leaf.coarser_neighbour_mask, leaf.directions, heights, leaf.source, levels);

  check_heights(leaf.directions, heights, meta, sampling.elevation);
  leaf.nodata.resize(heights.size());
  for (std::size_t p = 0; p < heights.size(); ++p) {
    if (std::isfinite(heights[p]) || mutated(Guard::kNodataHeights)) continue;
    leaf.nodata[p] = leaf.any_nodata = true;
  }
  if (leaf.any_nodata) fill_nodata(sampling, key, levels, heights);
  round_and_constrain(meta, leaf);
  return leaf;
}

void round_and_constrain(const PlanetMeta& meta, SampledLeaf& leaf) {
  std::vector<double>& heights = leaf.posts.height_m;
  leaf.quanta = to_quanta(heights, meta.quantum_m);
  for (std::size_t p = 0; p < heights.size(); ++p) heights[p] = leaf.quanta[p] * meta.quantum_m;
  for (const lod::Edge edge : lod::kEdges) {
    if ((leaf.coarser_neighbour_mask >> static_cast<int>(edge) & 1) == 0) continue;
    lod::constrain_edge(leaf.posts, leaf.lines, edge, 2, meta.radius_m);
    leaf.border_step[static_cast<std::size_t>(edge)] = 2;
  }
}

LeafTile pack_leaf(const PlanetMeta& meta, const SampledLeaf& leaf) {
  const lod::Posts& posts = leaf.posts;
  LeafTile tile;
  Node& node = tile.node;
  node.coarser_neighbour_mask = leaf.coarser_neighbour_mask;
  node.sources = sources_of(meta, leaf);
  TilePayload& payload = tile.payload;
  payload.heights = encode_heights(leaf.quanta, posts.side());
  if (leaf.any_nodata) payload.nodata = encode_mask(leaf.nodata);
  payload.origin = encode_origin(leaf.source, {node.sources.begin(), node.sources.end()});
  const auto [low, high] = std::minmax_element(posts.height_m.begin(), posts.height_m.end());
  node.min_m = *low;
  node.lowest_m = *low - facet_sagitta_m(lod::post_spacing_m(posts.key.level, posts.intervals, meta.radius_m),
                                         meta.radius_m);
  node.max_m = *high;
  node.slope = lod::steepest_slope(posts, leaf.lines, meta.radius_m);
  return tile;
}

Node build_leaf(const SampleInputs& sampling, const MeshInputs& meshing, TileStore& store,
                const lod::TileKey& key) {
  return mesh_leaf(meshing, sample_leaf(sampling, key), store);
}

Node mesh_leaf(const MeshInputs& meshing, const SampledLeaf& leaf, TileStore& store) {
  const PlanetMeta& meta = meshing.meta;
  const lod::Posts& posts = leaf.posts;
  const lod::TileKey& key = posts.key;
  const int n = posts.intervals;
  auto [node, payload] = pack_leaf(meta, leaf);
  const auto mesher = meshing.meshers.acquire();
  const auto full = static_cast<std::uint32_t>(2 * n * n);
  const lod::FinePosts fine(posts, meta.radius_m);
  const double side_m = lod::nominal_side_m(key.level, meta.radius_m);
  double tolerance = mesh_tolerance_m(meshing, key.level);
  for (int variant = 0; variant < kMaxMeshVariants; ++variant) {
    const double border_share = variant == 0 ? 1.0 : kBorderShare;
    const lod::BorderPosts borders =
        borders_of(posts, leaf.lines, leaf.border_step, border_share * tolerance, meta.radius_m);
    const PackedMesh mesh = pack_mesh(variant == 0 ? mesher->mesh(posts, borders, tolerance, meta.radius_m)
                                                   : mesher->refine(borders, tolerance),
                                      posts, meta.quantum_m);
    const auto triangles = static_cast<std::uint32_t>(mesh.mesh.triangle_count());
    const lod::ErrorTerms terms =
        lod::ErrorMeter(key, mesh.mesh, vertex_heights(mesh, meta.quantum_m), meta.radius_m).measure(fine);
    payload.meshes.push_back(encode_mesh(mesh));
    node.variants.push_back({terms, triangles});
    tolerance *= variant == 0 ? kFirstStep : kLaterStep;
    const double last_share = is_needed_finer(terms, side_m) ? kLastRoughShare : kLastMeshShare;
    if (triangles > last_share * full) break;
  }
  node.variants.push_back({{}, full});
  // Coarser variants never state less than finer ones.
  for (std::size_t v = node.variants.size() - 1; v > 0; --v) {
    node.variants[v - 1].terms.include(node.variants[v].terms);
  }
  store.put_tile(to_row(key, node), payload);
  return node;
}

namespace {

struct SampledTexels {
  std::vector<vpe::base::Rgb> colours;
  std::vector<std::uint8_t> alpha;
};

SampledTexels sample_texels(const mars::ImageSource& image, const lod::TileKey& key, double radius_m) {
  const std::vector<glm::dvec3> directions = post_directions(key, lod::grid_lines(key, kImageIntervals));
  SampledTexels out{std::vector<vpe::base::Rgb>(directions.size()),
                    std::vector<std::uint8_t>(directions.size())};
  image.sample(directions, lod::post_spacing_m(key.level, kImageIntervals, radius_m), out.colours, out.alpha);
  return out;
}

}  // namespace

Bytes make_layer_tile(const mars::ImageSource& layer, const lod::TileKey& key, double radius_m, int quality) {
  if (std::isinf(layer.spacing_in(lod::bounding_cap(key)))) {
    constexpr std::size_t kCount = std::size_t{kImageIntervals + 1} * (kImageIntervals + 1);
    return encode_layer_tile(std::vector<vpe::base::Rgb>(kCount), std::vector<std::uint8_t>(kCount), quality);
  }
  const SampledTexels texels = sample_texels(layer, key, radius_m);
  return encode_layer_tile(texels.colours, texels.alpha, quality);
}

Bytes make_image_tile(const mars::ImageSource& image, const lod::TileKey& key, double radius_m, int quality) {
  auto [colours, alpha] = sample_texels(image, key, radius_m);
  for (std::size_t n = 0; n < colours.size(); ++n) {
    if (alpha[n] != 0) continue;
    colours[n] = {vpe::core::kMissingImagery, vpe::core::kMissingImagery, vpe::core::kMissingImagery};
  }
  constexpr int kSide = kImageIntervals + 1;
  return vpe::core::encode_jpeg(colours, kSide, kSide, quality);
}

}  // namespace paging
