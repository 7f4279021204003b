#include "paging/build/shard_plan.h"

#include <array>
#include <bit>

namespace paging {

ShardPlan shard_plan(const BuildPlan& plan, const vpe::base::Shard& shard) {
  const std::vector<lod::TileKey>& all = plan.leaves();
  const auto count = static_cast<std::int64_t>(all.size());
  if (shard.of > count) {
    throw PlanetError("part " + std::to_string(shard.number) + " of " + std::to_string(shard.of) +
                      ": the planet has only " + std::to_string(count) + " finest tiles; ask for fewer parts");
  }
  ShardPlan tiles;
  const auto begin = static_cast<std::size_t>(shard.begin(count));
  tiles.leaves = std::span(all).subspan(begin, static_cast<std::size_t>(shard.end(count)) - begin);
  const std::int64_t first = lod::morton_position(tiles.leaves.front());
  const std::int64_t end =
      lod::morton_position(tiles.leaves.back()) + lod::morton_extent(tiles.leaves.back().level);
  for (const lod::TileKey& key : plan.inner()) {
    const std::int64_t key_first = lod::morton_position(key);
    const std::int64_t key_end = key_first + lod::morton_extent(key.level);
    if (key_first >= first && key_end <= end) {
      tiles.inner.push_back(key);
    } else if (key_first < end && key_end > first) {
      tiles.shared_ancestors.push_back(key);
    }
  }
  return tiles;
}

namespace {

constexpr std::size_t kRow = 64;

}  // namespace

Bytes pack_shared_ancestors(const std::map<lod::TileKey, SharedAncestorTerms>& ancestors) {
  Bytes out;
  const auto put = [&out](auto value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  };
  for (const auto& [key, ancestor] : ancestors) {
    put(lod::pack(key));
    for (const lod::ErrorTerms& e : {ancestor.terms.mesh, ancestor.terms.posts}) {
      put(e.height_error_m);
      put(e.sagitta_m);
      put(e.total_m);
    }
    put(ancestor.mesh_checksum);
  }
  return out;
}

std::map<lod::TileKey, SharedAncestorTerms> unpack_shared_ancestors(std::span<const std::uint8_t> packed) {
  if (packed.size() % kRow != 0) throw CodecError("checkpoint of shared ancestors has the wrong size");
  std::map<lod::TileKey, SharedAncestorTerms> out;
  for (std::size_t at = 0; at < packed.size(); at += kRow) {
    std::array<std::uint64_t, 8> bits{};
    for (std::size_t b = 0; b < kRow; ++b) bits[b / 8] |= std::uint64_t{packed[at + b]} << (8 * (b % 8));
    const auto key = lod::unpack(static_cast<std::int64_t>(bits[0]));
    if (!key) throw CodecError("checkpoint of a tile that does not exist");
    const auto terms = [&](std::size_t at_bits) {
      return lod::ErrorTerms{std::bit_cast<double>(bits[at_bits]), std::bit_cast<double>(bits[at_bits + 1]),
                             std::bit_cast<double>(bits[at_bits + 2])};
    };
    out[*key] = {{terms(1), terms(4)}, static_cast<std::int64_t>(bits[7])};
  }
  return out;
}

}  // namespace paging
