#include "paging/planet/layer_composite.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "paging/planet/image_stretch.h"
#include "paging/planet/planet_meta.h"
#include "vpe/core/appearance/nodata_pattern.h"

namespace paging {

namespace {

constexpr std::size_t kTexelsAlong = kImageIntervals + 1;
constexpr float kUnseen = 1.0F / 4096;  // share below which a layer changes no value

// Holds a colour with its share, both as sums of weights.
struct Weighted {
  std::array<float, 3> colour{};
  float share = 0;
};

// Says where along an axis a texel of a tile lies in a tile above it.
struct TexelPlace {
  std::size_t index = 0;
  float rest = 0;
};

TexelPlace place_above(std::int32_t tile, int level, std::int32_t above, int above_level, std::size_t texel) {
  const int down = level - above_level;
  const std::int64_t units = ((std::int64_t{tile} - (std::int64_t{above} << down)) * kImageIntervals) +
                             static_cast<std::int64_t>(texel);  // of 2^-down texels
  const auto index = std::min<std::int64_t>(units >> down, kImageIntervals - 1);
  return {static_cast<std::size_t>(index),
          static_cast<float>(static_cast<double>(units - (index << down)) / static_cast<double>(1LL << down))};
}

}  // namespace

LayerComposite::LayerComposite(const lod::TileKey& key) : key_(key), sums_(kTexelsAlong * kTexelsAlong) {}

void LayerComposite::add(const vpe::core::ImageLayerLook& look, const LayerTile& tile, const lod::TileKey& of) {
  if (tile.is_empty() || look.opacity == 0) return;
  const std::array<std::uint8_t, 256> stretched = stretch_table({look.low, look.high, look.gamma});
  std::array<float, 256> table{};
  std::ranges::copy(stretched, table.begin());
  const auto opacity = static_cast<float>(look.opacity);
  const auto share = [&](std::size_t n) {
    return tile.shares.empty() ? 1.0F : static_cast<float>(tile.shares[n]) / 255;
  };
  const auto blend = [&](Sum& sum, const std::array<float, 3>& colour, float covered) {
    const float seen = sum.left * opacity * covered;
    sum.r += seen * colour[0];
    sum.g += seen * colour[1];
    sum.b += seen * colour[2];
    sum.left -= seen;
  };
  const auto colour_of = [&](std::size_t n) {
    const vpe::base::Rgb& texel = tile.texels[n];
    return std::array<float, 3>{table[texel.r], table[texel.g], table[texel.b]};
  };
  if (of == key_) {
    for (std::size_t n = 0; n < sums_.size(); ++n) blend(sums_[n], colour_of(n), share(n));
    return;
  }
  std::array<TexelPlace, kTexelsAlong> columns;
  for (std::size_t i = 0; i < kTexelsAlong; ++i)
    columns[i] = place_above(key_.i, key_.level, of.i, of.level, i);
  const bool is_whole = tile.shares.empty();
  for (std::size_t j = 0; j < kTexelsAlong; ++j) {
    const TexelPlace y = place_above(key_.j, key_.level, of.j, of.level, j);
    for (std::size_t i = 0; i < kTexelsAlong; ++i) {
      const TexelPlace& x = columns[i];
      Weighted sum;
      for (std::size_t b = 0; b < 2; ++b) {
        for (std::size_t a = 0; a < 2; ++a) {
          const std::size_t n = (y.index + b) * kTexelsAlong + x.index + a;
          float weight = (a == 1 ? x.rest : 1 - x.rest) * (b == 1 ? y.rest : 1 - y.rest);
          if (!is_whole) weight *= share(n);
          const std::array<float, 3> colour = colour_of(n);
          for (std::size_t c = 0; c < 3; ++c) sum.colour[c] += weight * colour[c];
          sum.share += weight;
        }
      }
      if (sum.share <= 0) continue;
      if (!is_whole) {
        for (float& value : sum.colour) value /= sum.share;
      }
      blend(sums_[j * kTexelsAlong + i], sum.colour, is_whole ? 1.0F : std::min(sum.share, 1.0F));
    }
  }
}

bool LayerComposite::is_opaque() const {
  return std::ranges::all_of(sums_, [](const Sum& sum) { return sum.left < kUnseen; });
}

std::vector<vpe::base::Rgb> LayerComposite::texels() const {
  std::vector<vpe::base::Rgb> out;
  out.reserve(sums_.size());
  constexpr auto kBelow = static_cast<float>(vpe::core::kMissingImagery);
  for (const Sum& sum : sums_) {
    const auto byte = [&](float value) {
      // Values are not negative, so that this rounds.
      return static_cast<std::uint8_t>(std::clamp(value + sum.left * kBelow, 0.0F, 255.0F) + 0.5F);
    };
    out.push_back({byte(sum.r), byte(sum.g), byte(sum.b)});
  }
  return out;
}

}  // namespace paging
