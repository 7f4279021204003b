// Payloads of the planet file as compressed bytes: heights, nodata masks, sources of posts, meshes.
//
// decode(encode(x)) == x, bit for bit. Every decoder checks sizes and ranges. It throws CodecError for bytes
// that no encoder wrote, and never reads or writes out of bounds, whatever the bytes are. All functions are
// pure.
//
// Typical usage:
//   const Bytes packed = encode_heights(quanta, side);
//   const std::vector<std::int32_t> same = decode_heights(packed, side);
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "lod/mesh/mesh.h"

namespace paging {

using Bytes = std::vector<std::uint8_t>;

class CodecError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Packs bytes into a zstd frame that states its content size.
Bytes compress(std::span<const std::uint8_t> raw, int level);
// Unpacks such a frame. Throws CodecError for more than `limit` bytes.
Bytes decompress(std::span<const std::uint8_t> packed, std::size_t limit);

// Packs side * side heights in quanta, row by row: gradient prediction, zigzag, byte planes, zstd.
Bytes encode_heights(std::span<const std::int32_t> quanta, int side);
std::vector<std::int32_t> decode_heights(std::span<const std::uint8_t> packed, int side);

// Packs one flag for each post: true where no source has data.
Bytes encode_mask(const std::vector<bool>& nodata);
std::vector<bool> decode_mask(std::span<const std::uint8_t> packed, std::size_t count);

// Packs one number for each post: low bytes, then high bytes, zstd. Sources of posts are such numbers.
Bytes encode_numbers(std::span<const std::uint16_t> numbers);
// Throws CodecError also for a number above `most`.
std::vector<std::uint16_t> decode_numbers(std::span<const std::uint8_t> packed, std::size_t count,
                                          std::size_t most);

// Holds a mesh with the heights of its vertices. Vertices must be sorted by (j, i) and distinct.
struct PackedMesh {
  lod::TileMesh mesh;
  std::vector<std::int32_t> height_q;  // in quanta, one for each vertex
};
// Packs a mesh. Normalizes order and rotation of the triangles, so decode_mesh() may return the same set of
// triangles in another order.
Bytes encode_mesh(const PackedMesh& mesh);
// `intervals` is that of the grid which the mesh must be made on.
PackedMesh decode_mesh(std::span<const std::uint8_t> packed, int intervals);

// Returns the 63-bit checksum (XXH3) of a row's key and payload. Never negative, because SQLite integers are
// signed.
std::int64_t checksum(std::int64_t key, std::span<const std::uint8_t> payload);

}  // namespace paging
