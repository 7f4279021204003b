// Payloads of the planet file: heights, missing masks, meshes, as compressed bytes.
//
// decode(encode(x)) == x, bit for bit. Every decoder checks sizes and ranges and throws CodecError on bytes
// that no encoder wrote; it never reads or writes out of bounds, whatever the bytes are. Pure functions.
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

// zstd frame with its content size; decompress refuses more than `limit` bytes.
Bytes compress(std::span<const std::uint8_t> raw, int level);
Bytes decompress(std::span<const std::uint8_t> packed, std::size_t limit);

// Heights in quanta, side * side of them, row by row: gradient prediction, zigzag, byte planes, zstd.
Bytes encode_heights(std::span<const std::int32_t> quanta, int side);
std::vector<std::int32_t> decode_heights(std::span<const std::uint8_t> packed, int side);

// One flag a post (true = no source had data there).
Bytes encode_mask(const std::vector<bool>& nodata);
std::vector<bool> decode_mask(std::span<const std::uint8_t> packed, std::size_t count);

// A mesh with the heights (in quanta) of its vertices. Vertices must be sorted by (j, i) and distinct;
// triangle order and rotation are normalised by encode (so decode may return the same set in another order).
struct PackedMesh {
  lod::TileMesh mesh;
  std::vector<std::int32_t> height_q;  // one per vertex
};
Bytes encode_mesh(const PackedMesh& mesh);
PackedMesh decode_mesh(std::span<const std::uint8_t> packed);

// 63-bit checksum (XXH3) of a row's key and payload; never negative, as SQLite integers are signed.
std::int64_t checksum(std::int64_t key, std::span<const std::uint8_t> payload);

}  // namespace paging
