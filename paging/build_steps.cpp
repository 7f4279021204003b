#include "paging/build_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/core/image.h"

namespace paging {

namespace {

// Finest tiles carry ever finer meshes, each a quarter of the error and so about four times the triangles,
// until the next one would come close to the full grid, which is the last.
constexpr double kLastMeshShare = 0.1;
constexpr double kVariantStep = 0.25;
constexpr int kMaxMeshVariants = 12;

std::size_t edge_post(lod::Edge edge, int along, int side) {
  const auto n = static_cast<std::size_t>(side);
  const auto a = static_cast<std::size_t>(along);
  switch (edge) {
    case lod::Edge::kWest: return a * n;
    case lod::Edge::kEast: return a * n + n - 1;
    case lod::Edge::kSouth: return a;
    case lod::Edge::kNorth: return (n - 1) * n + a;
  }
  return 0;
}

bool along_j(lod::Edge edge) { return edge == lod::Edge::kWest || edge == lod::Edge::kEast; }

std::vector<glm::dvec3> post_directions(const lod::TileKey& key, const lod::GridLines& lines) {
  std::vector<glm::dvec3> directions;
  directions.reserve(lines.u.size() * lines.v.size());
  for (const double v : lines.v) {
    for (const double u : lines.u) directions.push_back(mars::chart_direction(key.face, u, v));
  }
  return directions;
}

// Border posts take the spacing of the coarsest tile that has them, so that both sides sample the same.
void resample_borders(const BuildContext& context, const lod::TileKey& key, int steps,
                      const std::vector<glm::dvec3>& directions, std::vector<double>& heights) {
  const int n = context.meta.tile.intervals();
  const int side = n + 1;
  const auto spacing = [&](int level) { return lod::post_spacing_m(level, n, context.meta.radius_m); };
  for (const lod::Edge edge : lod::kEdges) {
    if ((steps >> static_cast<int>(edge) & 1) == 0) continue;
    std::vector<glm::dvec3> at;
    for (int a = 0; a <= n; a += 2) at.push_back(directions[edge_post(edge, a, side)]);
    std::vector<double> values(at.size());
    context.elevation.sample(at, spacing(key.level - 1), values);
    for (int a = 0; a <= n; a += 2) heights[edge_post(edge, a, side)] = values[static_cast<std::size_t>(a / 2)];
  }
  for (int corner = 0; corner < 4; ++corner) {
    const bool east = (corner & 1) != 0;
    const bool north = (corner & 2) != 0;
    const std::size_t post = edge_post(north ? lod::Edge::kNorth : lod::Edge::kSouth, east ? n : 0, side);
    const int level = context.plan.coarsest_level_at_corner(key, east, north);
    if (level == key.level) continue;
    context.elevation.sample(std::span(&directions[post], 1), spacing(level), std::span(&heights[post], 1));
  }
}

std::set<int> sources_of(const BuildContext& context, const std::vector<glm::dvec3>& directions) {
  if (context.meta.sources.size() == 1) return {0};
  // Every seventh post: rows of 2^k + 1 posts make this a scattered pattern.
  std::vector<glm::dvec3> some;
  for (std::size_t n = 0; n < directions.size(); n += 7) some.push_back(directions[n]);
  std::vector<int> origin(some.size());
  context.elevation.origin(some, origin);
  std::set<int> found(origin.begin(), origin.end());
  found.erase(-1);
  return found;
}

lod::BorderPosts borders_of(const lod::Posts& posts, const lod::GridLines& lines,
                            const std::array<int, 4>& step, double tolerance_m, double radius_m) {
  lod::BorderPosts out;
  for (const lod::Edge edge : lod::kEdges) {
    const auto e = static_cast<std::size_t>(edge);
    const std::vector<double>& along = along_j(edge) ? lines.v : lines.u;
    const std::vector<double>& fixed = along_j(edge) ? lines.u : lines.v;
    const bool far = edge == lod::Edge::kEast || edge == lod::Edge::kNorth;
    std::vector<double> heights;
    std::vector<double> line;
    for (int a = 0; a < posts.side(); a += step[e]) {
      heights.push_back(posts.height_m[edge_post(edge, a, posts.side())]);
      line.push_back(along[static_cast<std::size_t>(a)]);
    }
    out[e] = lod::choose_border(heights, line, far ? fixed.back() : fixed.front(), tolerance_m, radius_m);
    for (int& a : out[e]) a *= step[e];
  }
  return out;
}

// Heights of the mesh's vertices in quanta. Its vertices are never posts that lie on a coarser edge, so the
// rounding only undoes the multiplication by the quantum.
PackedMesh pack_mesh(lod::TileMesh mesh, const lod::Posts& posts, double quantum_m) {
  PackedMesh packed;
  packed.height_q.reserve(mesh.vertices.size());
  for (const lod::MeshVertex& v : mesh.vertices) {
    packed.height_q.push_back(static_cast<std::int32_t>(std::llround(posts.at(v.i, v.j) / quantum_m)));
  }
  packed.mesh = std::move(mesh);
  return packed;
}

std::vector<std::int32_t> to_quanta(const std::vector<double>& heights, double quantum_m) {
  std::vector<std::int32_t> quanta(heights.size());
  std::transform(heights.begin(), heights.end(), quanta.begin(),
                 [quantum_m](double h) { return static_cast<std::int32_t>(std::llround(h / quantum_m)); });
  return quanta;
}

}  // namespace

std::vector<double> vertex_heights(const PackedMesh& mesh, double quantum_m) {
  std::vector<double> heights(mesh.height_q.size());
  std::transform(mesh.height_q.begin(), mesh.height_q.end(), heights.begin(),
                 [quantum_m](std::int32_t q) { return q * quantum_m; });
  return heights;
}

lod::Posts read_posts(const BuildContext& context, const lod::TileKey& key) {
  const auto quanta = decode_heights(context.writer.heights(key), context.meta.tile.posts());
  lod::Posts posts{key, context.meta.tile.intervals(), std::vector<double>(quanta.size())};
  std::transform(quanta.begin(), quanta.end(), posts.height_m.begin(),
                 [q = context.meta.quantum_m](std::int32_t n) { return n * q; });
  const int steps = context.nodes.at(key).steps;
  if (steps != 0) {
    const lod::GridLines lines = lod::grid_lines(key, posts.intervals);
    for (const lod::Edge edge : lod::kEdges) {
      if ((steps >> static_cast<int>(edge) & 1) != 0)
        lod::constrain_edge(posts, lines, edge, 2, context.meta.radius_m);
    }
  }
  return posts;
}

double mesh_tolerance_m(const BuildOptions& options, int level) {
  return lod::nominal_side_m(level, options.radius_m) / options.mesh_ratio;
}

Node build_leaf(const BuildContext& context, const lod::TileKey& key) {
  const PlanetMeta& meta = context.meta;
  const int n = meta.tile.intervals();
  Node node;
  for (const lod::Edge edge : lod::kEdges) {
    if (context.plan.edge_step(key, edge) != 0) node.steps |= 1 << static_cast<int>(edge);
  }
  const lod::GridLines lines = lod::grid_lines(key, n);
  const std::vector<glm::dvec3> directions = post_directions(key, lines);
  const double spacing = lod::post_spacing_m(key.level, n, meta.radius_m);
  lod::Posts posts{key, n, std::vector<double>(directions.size())};
  context.elevation.sample(directions, spacing, posts.height_m);
  resample_borders(context, key, node.steps, directions, posts.height_m);

  std::vector<bool> missing(directions.size());
  bool any_missing = false;
  for (std::size_t p = 0; p < directions.size(); ++p) {
    if (std::isfinite(posts.height_m[p])) continue;
    missing[p] = any_missing = true;
    posts.height_m[p] = meta.fill_m;
  }
  node.sources = sources_of(context, directions);
  const std::vector<std::int32_t> quanta = to_quanta(posts.height_m, meta.quantum_m);
  TilePayload payload;
  payload.heights = encode_heights(quanta, n + 1);
  if (any_missing) payload.missing = encode_mask(missing);

  for (std::size_t p = 0; p < quanta.size(); ++p) posts.height_m[p] = quanta[p] * meta.quantum_m;
  std::array<int, 4> border_step{1, 1, 1, 1};
  for (const lod::Edge edge : lod::kEdges) {
    if ((node.steps >> static_cast<int>(edge) & 1) == 0) continue;
    lod::constrain_edge(posts, lines, edge, 2, meta.radius_m);
    border_step[static_cast<std::size_t>(edge)] = 2;
  }
  const auto [low, high] = std::minmax_element(posts.height_m.begin(), posts.height_m.end());
  node.min_m = *low;
  node.lowest_m = *low - facet_sag_m(spacing, meta.radius_m);
  node.max_m = *high;
  node.slope = lod::steepest_slope(posts, lines, meta.radius_m);

  const MesherPool::Lease mesher = context.meshers.borrow();
  const auto full = static_cast<std::uint32_t>(2 * n * n);
  const lod::FinePosts fine(posts, meta.radius_m);
  double tolerance = mesh_tolerance_m(context.options, key.level);
  for (int variant = 0; variant < kMaxMeshVariants; ++variant, tolerance *= kVariantStep) {
    const lod::BorderPosts borders = borders_of(posts, lines, border_step, tolerance, meta.radius_m);
    const PackedMesh mesh = pack_mesh(variant == 0 ? mesher->mesh(posts, borders, tolerance, meta.radius_m)
                                                   : mesher->refine(borders, tolerance),
                                      posts, meta.quantum_m);
    const auto triangles = static_cast<std::uint32_t>(mesh.mesh.triangle_count());
    const lod::ErrorTerms terms =
        lod::ErrorMeter(key, mesh.mesh, vertex_heights(mesh, meta.quantum_m), meta.radius_m).measure(fine);
    payload.meshes.push_back(encode_mesh(mesh));
    node.variants.push_back({terms, triangles});
    if (triangles > kLastMeshShare * full) break;
  }
  node.variants.push_back({{}, full});
  // Coarser variants never state less than finer ones.
  for (std::size_t v = node.variants.size() - 1; v > 0; --v) {
    node.variants[v - 1].terms.include(node.variants[v].terms);
  }
  context.writer.put_tile(to_row(key, node), payload);
  return node;
}

Node build_inner(const BuildContext& context, const lod::TileKey& key) {
  const PlanetMeta& meta = context.meta;
  const int n = meta.tile.intervals();
  const auto wide = static_cast<std::size_t>(2 * n + 1);
  Node node;
  node.inner = true;
  lod::Posts posts{key, 2 * n, std::vector<double>(wide * wide)};
  std::vector<bool> missing;
  for (int c = 0; c < 4; ++c) {
    const lod::TileKey child = lod::child(key, c);
    const lod::Posts fine = read_posts(context, child);
    const auto x0 = static_cast<std::size_t>((c & 1) * n);
    const auto y0 = static_cast<std::size_t>((c >> 1) * n);
    const auto side = static_cast<std::size_t>(n + 1);
    for (std::size_t j = 0; j < side; ++j) {
      std::copy_n(fine.height_m.begin() + static_cast<std::ptrdiff_t>(j * side), side,
                  posts.height_m.begin() + static_cast<std::ptrdiff_t>((y0 + j) * wide + x0));
    }
    if (const Bytes mask = context.writer.missing(child); !mask.empty()) {
      const std::vector<bool> below = decode_mask(mask, side * side);
      missing.resize(side * side);
      // Of the child's posts, every second one is a post of this tile.
      for (std::size_t j = 0; j < side; j += 2) {
        for (std::size_t i = 0; i < side; i += 2) {
          if (below[j * side + i]) missing[(y0 + j) / 2 * side + (x0 + i) / 2] = true;
        }
      }
    }
    const Node& below = context.nodes.at(child);
    node.sources.insert(below.sources.begin(), below.sources.end());
    node.min_m = c == 0 ? below.min_m : std::min(node.min_m, below.min_m);
    node.lowest_m = c == 0 ? below.lowest_m : std::min(node.lowest_m, below.lowest_m);
    node.max_m = c == 0 ? below.max_m : std::max(node.max_m, below.max_m);
    node.slope = std::max(node.slope, below.slope);
  }
  std::vector<double> own;
  own.reserve(static_cast<std::size_t>(meta.tile.post_count()));
  for (std::size_t j = 0; j < wide; j += 2) {
    for (std::size_t i = 0; i < wide; i += 2) own.push_back(posts.height_m[j * wide + i]);
  }
  TilePayload payload;
  payload.heights = encode_heights(to_quanta(own, meta.quantum_m), n + 1);
  if (std::find(missing.begin(), missing.end(), true) != missing.end()) payload.missing = encode_mask(missing);

  // A finest tile beside this one has only every second of these border posts.
  std::array<int, 4> border_step{1, 1, 1, 1};
  for (const lod::Edge edge : lod::kEdges) {
    if (!context.plan.is_inner(lod::neighbour(key, edge).key)) border_step[static_cast<std::size_t>(edge)] = 2;
  }
  const MesherPool::Lease mesher = context.meshers.borrow();
  const double tolerance = mesh_tolerance_m(context.options, key.level);
  const lod::GridLines lines = lod::grid_lines(key, 2 * n);
  const lod::BorderPosts borders = borders_of(posts, lines, border_step, tolerance, meta.radius_m);
  const PackedMesh mesh =
      pack_mesh(mesher->mesh(posts, borders, tolerance, meta.radius_m), posts, meta.quantum_m);
  payload.meshes.push_back(encode_mesh(mesh));
  node.variants.push_back({{}, static_cast<std::uint32_t>(mesh.mesh.triangle_count())});
  context.writer.put_tile(to_row(key, node), payload);
  return node;
}

void build_image(const BuildContext& context, const mars::ImageSource& image, const lod::TileKey& key) {
  const lod::GridLines lines = lod::grid_lines(key, kImageIntervals);
  const std::vector<glm::dvec3> directions = post_directions(key, lines);
  std::vector<mars::Rgb> colours(directions.size());
  std::vector<std::uint8_t> alpha(directions.size());
  image.sample(directions, lod::post_spacing_m(key.level, kImageIntervals, context.meta.radius_m), colours,
               alpha);
  for (std::size_t n = 0; n < colours.size(); ++n) {
    if (alpha[n] == 0) colours[n] = {128, 128, 128};
  }
  constexpr int kSide = kImageIntervals + 1;
  context.writer.put_image(key, vpe::core::encode_jpeg(colours, kSide, kSide, context.options.image_quality));
}

}  // namespace paging
