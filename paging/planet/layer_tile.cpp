#include "paging/planet/layer_tile.h"

#include <algorithm>

#include "paging/planet/planet_meta.h"
#include "vpe/core/image/image.h"

namespace paging {

namespace {

constexpr int kSideTexels = kImageIntervals + 1;
constexpr std::size_t kTexels = std::size_t{kSideTexels} * kSideTexels;
constexpr int kSharesLevel = 9;  // of zstd
constexpr std::size_t kLengthBytes = 4;

// Says what a tile's payload holds.
enum class Content : std::uint8_t { kNothing = 0, kAll = 1, kShares = 2 };

bool is_covered(std::span<const std::uint8_t> shares, std::size_t n) { return shares[n] != 0; }

// Gives nodata texels in a row that has data the colour of the nearest one to the west, else to the east.
void extend_row(std::span<vpe::base::Rgb> row, std::span<const std::uint8_t> shares) {
  std::size_t first = 0;
  while (!is_covered(shares, first)) ++first;
  for (std::size_t i = 0; i < row.size(); ++i)
    if (!is_covered(shares, i)) row[i] = i < first ? row[first] : row[i - 1];
}

// Gives all nodata texels the colour of one beside them.
void extend_colours(std::span<vpe::base::Rgb> texels, std::span<const std::uint8_t> shares) {
  constexpr std::size_t kSide = kSideTexels;
  std::vector<std::size_t> with_data;
  for (std::size_t j = 0; j < kSide; ++j) {
    const auto of_row = shares.subspan(j * kSide, kSide);
    if (std::ranges::all_of(of_row, [](std::uint8_t share) { return share == 0; })) continue;
    extend_row(texels.subspan(j * kSide, kSide), of_row);
    with_data.push_back(j);
  }
  std::size_t next = 0;
  for (std::size_t j = 0; j < kSide; ++j) {
    if (next < with_data.size() && with_data[next] == j) {
      ++next;
      continue;
    }
    const std::size_t from = next == 0 ? with_data.front() : with_data[next - 1];
    std::ranges::copy(texels.subspan(from * kSide, kSide), texels.subspan(j * kSide, kSide).begin());
  }
}

std::size_t length_at(std::span<const std::uint8_t> bytes) {
  std::size_t length = 0;
  for (std::size_t n = 0; n < kLengthBytes; ++n) length |= std::size_t{bytes[n]} << (8 * n);
  return length;
}

}  // namespace

Bytes encode_layer_tile(std::span<const vpe::base::Rgb> texels, std::span<const std::uint8_t> shares,
                        int quality) {
  if (texels.size() != kTexels || shares.size() != kTexels)
    throw CodecError("image layer: wrong number of texels");
  if (std::ranges::all_of(shares, [](std::uint8_t share) { return share == 0; }))
    return {static_cast<std::uint8_t>(Content::kNothing)};
  const bool is_whole = std::ranges::all_of(shares, [](std::uint8_t share) { return share == 255; });
  Bytes out{static_cast<std::uint8_t>(is_whole ? Content::kAll : Content::kShares)};
  std::vector<vpe::base::Rgb> colours(texels.begin(), texels.end());
  if (!is_whole) {
    const Bytes packed = compress(shares, kSharesLevel);
    for (std::size_t n = 0; n < kLengthBytes; ++n)
      out.push_back(static_cast<std::uint8_t>(packed.size() >> (8 * n)));
    out.insert(out.end(), packed.begin(), packed.end());
    extend_colours(colours, shares);
  }
  const Bytes jpeg = vpe::core::encode_jpeg(colours, kSideTexels, kSideTexels, quality);
  out.insert(out.end(), jpeg.begin(), jpeg.end());
  return out;
}

LayerTile decode_layer_tile(std::span<const std::uint8_t> packed) {
  if (packed.empty() || packed[0] > static_cast<std::uint8_t>(Content::kShares))
    throw CodecError("image layer: not a tile of one");
  const auto content = static_cast<Content>(packed[0]);
  packed = packed.subspan(1);
  LayerTile tile;
  if (content == Content::kNothing) {
    if (!packed.empty()) throw CodecError("image layer: bytes after an empty tile");
    return tile;
  }
  if (content == Content::kShares) {
    if (packed.size() < kLengthBytes) throw CodecError("image layer: too short");
    const std::size_t length = length_at(packed);
    packed = packed.subspan(kLengthBytes);
    if (length > packed.size()) throw CodecError("image layer: too short");
    tile.shares = decompress(packed.first(length), kTexels);
    if (tile.shares.size() != kTexels) throw CodecError("image layer: wrong number of texels");
    packed = packed.subspan(length);
  }
  vpe::core::RgbImage image = vpe::core::decode_jpeg(packed, static_cast<std::int64_t>(kTexels));
  if (image.width != kSideTexels || image.height != kSideTexels)
    throw CodecError("image layer: image of the wrong size");
  tile.texels = std::move(image.pixels);
  return tile;
}

}  // namespace paging
