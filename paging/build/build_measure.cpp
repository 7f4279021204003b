#include <array>
#include <bit>

#include "lod/mesh/grid_meter.h"
#include "paging/build/build_steps.h"

namespace paging {

namespace {

// Measures an inner tile.
struct Meters {
  lod::ErrorMeter mesh;
  lod::GridMeter posts;
};

std::unique_ptr<Meters> meters_of(const StoredTiles& stored, const SharedAncestors& shared_ancestors,
                                  const lod::TileKey& key) {
  const double radius_m = stored.meta.radius_m;
  const auto meters = [&](const PackedMesh& mesh, const lod::Posts& posts) {
    return std::make_unique<Meters>(
        Meters{lod::ErrorMeter(key, mesh.mesh, vertex_heights(mesh, stored.meta.quantum_m), radius_m),
               lod::GridMeter(posts, radius_m)});
  };
  if (const auto shared = shared_ancestors.find(key); shared != shared_ancestors.end())
    return meters(shared->second.mesh, shared->second.posts);
  return meters(decode_mesh(stored.store.mesh(key, 0), mesh_intervals(stored.meta.tile, true)),
                read_posts(stored, key));
}

}  // namespace

std::map<lod::TileKey, InnerTerms> measure_chunk(const StoredTiles& stored,
                                                 const SharedAncestors& shared_ancestors,
                                                 const std::set<lod::TileKey>& kept,
                                                 std::span<const lod::TileKey> leaves) {
  std::map<lod::TileKey, InnerTerms> found;
  // Neighbours in Morton order share most ancestors: keep the meters of the last leaf's ancestors, by level.
  std::vector<std::unique_ptr<Meters>> meters;
  lod::TileKey last = leaves.front();
  for (const lod::TileKey& leaf : leaves) {
    // All above a tile that is made again are made again: the kept ancestors of a leaf are its deepest ones.
    int open_levels = leaf.level;
    while (open_levels > 0 && kept.contains(lod::ancestor(leaf, open_levels - 1))) --open_levels;
    if (open_levels == 0) continue;
    const lod::FinePosts posts(read_posts(stored, leaf), stored.meta.radius_m);
    meters.resize(std::max(meters.size(), static_cast<std::size_t>(leaf.level)));
    for (int level = 0; level < open_levels; ++level) {
      const lod::TileKey key = lod::ancestor(leaf, level);
      auto& meter = meters[static_cast<std::size_t>(level)];
      const bool same = meter && level <= last.level && lod::ancestor(last, level) == key;
      if (!same) meter = meters_of(stored, shared_ancestors, key);
      found[key].include({meter->mesh.measure(posts), meter->posts.measure(posts)});
    }
    // Meters below this leaf's level belong to other branches.
    meters.resize(static_cast<std::size_t>(leaf.level));
    last = leaf;
  }
  return found;
}

Bytes pack_terms(const std::map<lod::TileKey, InnerTerms>& terms) {
  Bytes out;
  const auto put = [&out](auto value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  };
  for (const auto& [key, t] : terms) {
    put(lod::pack(key));
    for (const lod::ErrorTerms& e : {t.mesh, t.posts}) {
      put(e.height_error_m);
      put(e.sagitta_m);
      put(e.total_m);
    }
  }
  return out;
}

std::map<lod::TileKey, InnerTerms> unpack_terms(std::span<const std::uint8_t> packed) {
  constexpr std::size_t kRow = 56;
  if (packed.size() % kRow != 0) throw CodecError("error terms of the wrong size");
  std::map<lod::TileKey, InnerTerms> out;
  for (std::size_t at = 0; at < packed.size(); at += kRow) {
    std::array<std::uint64_t, 7> bits{};
    for (std::size_t b = 0; b < kRow; ++b) bits[b / 8] |= std::uint64_t{packed[at + b]} << (8 * (b % 8));
    const auto key = lod::unpack(static_cast<std::int64_t>(bits[0]));
    if (!key) throw CodecError("error terms of a tile that does not exist");
    const auto terms = [&](std::size_t at_bits) {
      return lod::ErrorTerms{std::bit_cast<double>(bits[at_bits]), std::bit_cast<double>(bits[at_bits + 1]),
                             std::bit_cast<double>(bits[at_bits + 2])};
    };
    out[*key] = {terms(1), terms(4)};
  }
  return out;
}

void nest_errors(Nodes& nodes, std::span<const lod::TileKey> inner) {
  for (const lod::TileKey& key : inner) {
    Node& node = nodes.at(key);
    for (int c = 0; c < 4; ++c) {
      const Node& below = nodes.at(lod::child(key, c));
      node.variants.front().terms.include(below.variants.front().terms);
      if (below.inner) node.posts_terms.include(below.posts_terms);
    }
  }
}

}  // namespace paging
