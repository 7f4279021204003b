// Packing of tiles for TIFF files: a predictor (TIFF 6, section 14; TIFF technical note 3 for floating point),
// then Deflate. Pure functions for any thread; the same bytes for the same samples and the same zlib.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace panorama {

inline constexpr int kTile_px = 256;

// Describes a pixel. Samples of 1 byte are whole numbers; samples of 4 and 8 bytes are IEEE floating point in
// this machine's byte order.
struct SampleFormat {
  int samples = 3;
  int bytes = 1;

  std::size_t pixel_bytes() const {
    return static_cast<std::size_t>(samples) * static_cast<std::size_t>(bytes);
  }
  std::size_t tile_bytes() const { return pixel_bytes() * kTile_px * kTile_px; }
  bool operator==(const SampleFormat&) const = default;
};
inline constexpr SampleFormat kRgb{3, 1};

// Packs a tile of tile_bytes(), row by row.
std::vector<std::uint8_t> pack_tile(std::span<const std::uint8_t> tile, const SampleFormat& format);

// Unpacks a tile. Throws std::runtime_error for bytes that pack_tile() did not make.
std::vector<std::uint8_t> unpack_tile(std::span<const std::uint8_t> packed, const SampleFormat& format);

}  // namespace panorama
