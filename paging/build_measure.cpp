#include <array>
#include <bit>

#include "paging/build_steps.h"

namespace paging {

std::map<lod::TileKey, lod::ErrorTerms> measure_chunk(const BuildContext& context,
                                                      std::span<const lod::TileKey> leaves) {
  std::map<lod::TileKey, lod::ErrorTerms> found;
  // Neighbours on the curve share most ancestors: keep the meters of the last leaf's ancestors, by level.
  std::vector<std::unique_ptr<lod::ErrorMeter>> meters;
  lod::TileKey last = leaves.front();
  for (const lod::TileKey& leaf : leaves) {
    const lod::FinePosts posts(read_posts(context, leaf), context.meta.radius_m);
    meters.resize(std::max(meters.size(), static_cast<std::size_t>(leaf.level)));
    for (int level = 0; level < leaf.level; ++level) {
      const lod::TileKey key = lod::ancestor(leaf, level);
      auto& meter = meters[static_cast<std::size_t>(level)];
      const bool same = meter && level <= last.level && lod::ancestor(last, level) == key;
      if (!same) {
        const auto above = context.above.find(key);
        const PackedMesh mesh =
            above != context.above.end() ? above->second : decode_mesh(context.writer.mesh(key, 0));
        meter = std::make_unique<lod::ErrorMeter>(key, mesh.mesh, vertex_heights(mesh, context.meta.quantum_m),
                                                  context.meta.radius_m);
      }
      found[key].include(meter->measure(posts));
    }
    // Meters below this leaf's level belong to other branches.
    meters.resize(static_cast<std::size_t>(leaf.level));
    last = leaf;
  }
  return found;
}

Bytes pack_terms(const std::map<lod::TileKey, lod::ErrorTerms>& terms) {
  Bytes out;
  const auto put = [&out](auto value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  };
  for (const auto& [key, t] : terms) {
    put(lod::pack(key));
    put(t.relief_m);
    put(t.sag_m);
    put(t.total_m);
  }
  return out;
}

std::map<lod::TileKey, lod::ErrorTerms> unpack_terms(std::span<const std::uint8_t> packed) {
  constexpr std::size_t kRow = 32;
  if (packed.size() % kRow != 0) throw CodecError("error terms of a wrong size");
  std::map<lod::TileKey, lod::ErrorTerms> out;
  for (std::size_t at = 0; at < packed.size(); at += kRow) {
    std::array<std::uint64_t, 4> bits{};
    for (std::size_t b = 0; b < kRow; ++b) bits[b / 8] |= std::uint64_t{packed[at + b]} << (8 * (b % 8));
    const auto key = lod::unpack(static_cast<std::int64_t>(bits[0]));
    if (!key) throw CodecError("error terms of no tile");
    out[*key] = {std::bit_cast<double>(bits[1]), std::bit_cast<double>(bits[2]),
                 std::bit_cast<double>(bits[3])};
  }
  return out;
}

void nest_errors(BuildContext& context, std::span<const lod::TileKey> inner) {
  for (const lod::TileKey& key : inner) {
    Node& node = context.nodes.at(key);
    for (int c = 0; c < 4; ++c) {
      node.variants.front().terms.include(context.nodes.at(lod::child(key, c)).variants.front().terms);
    }
  }
}

}  // namespace paging
