#include "paging/build/shard_plan.h"

#include <array>
#include <bit>

namespace paging {

ShardPlan shard_plan(const BuildPlan& plan, const vpe::base::Shard& part) {
  const std::vector<lod::TileKey>& all = plan.leaves();
  const auto count = static_cast<std::int64_t>(all.size());
  if (part.of > count) {
    throw PlanetError("part " + std::to_string(part.number) + " of " + std::to_string(part.of) +
                      ": the planet has only " + std::to_string(count) + " finest tiles; ask for fewer parts");
  }
  ShardPlan share;
  const auto begin = static_cast<std::size_t>(part.begin(count));
  share.leaves = std::span(all).subspan(begin, static_cast<std::size_t>(part.end(count)) - begin);
  const std::int64_t first = lod::z_position(share.leaves.front());
  const std::int64_t end = lod::z_position(share.leaves.back()) + lod::z_extent(share.leaves.back().level);
  for (const lod::TileKey& key : plan.inner()) {
    const std::int64_t key_first = lod::z_position(key);
    const std::int64_t key_end = key_first + lod::z_extent(key.level);
    if (key_first >= first && key_end <= end) {
      share.inner.push_back(key);
    } else if (key_first < end && key_end > first) {
      share.above.push_back(key);
    }
  }
  return share;
}

namespace {

constexpr std::size_t kRow = 64;

}  // namespace

Bytes pack_shared_ancestors(const std::map<lod::TileKey, SharedAncestorTerms>& checkpoints) {
  Bytes out;
  const auto put = [&out](auto value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  };
  for (const auto& [key, checkpoint] : checkpoints) {
    put(lod::pack(key));
    for (const lod::ErrorTerms& e : {checkpoint.terms.mesh, checkpoint.terms.posts}) {
      put(e.height_error_m);
      put(e.sagitta_m);
      put(e.total_m);
    }
    put(checkpoint.mesh_checksum);
  }
  return out;
}

std::map<lod::TileKey, SharedAncestorTerms> unpack_shared_ancestors(std::span<const std::uint8_t> packed) {
  if (packed.size() % kRow != 0) throw CodecError("notes of tiles above, of a wrong size");
  std::map<lod::TileKey, SharedAncestorTerms> out;
  for (std::size_t at = 0; at < packed.size(); at += kRow) {
    std::array<std::uint64_t, 8> bits{};
    for (std::size_t b = 0; b < kRow; ++b) bits[b / 8] |= std::uint64_t{packed[at + b]} << (8 * (b % 8));
    const auto key = lod::unpack(static_cast<std::int64_t>(bits[0]));
    if (!key) throw CodecError("a note of no tile");
    const auto terms = [&](std::size_t at_bits) {
      return lod::ErrorTerms{std::bit_cast<double>(bits[at_bits]), std::bit_cast<double>(bits[at_bits + 1]),
                             std::bit_cast<double>(bits[at_bits + 2])};
    };
    out[*key] = {{terms(1), terms(4)}, static_cast<std::int64_t>(bits[7])};
  }
  return out;
}

}  // namespace paging
