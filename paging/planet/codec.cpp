#include "paging/planet/codec.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>

namespace paging {

namespace {

constexpr int kHeightsLevel = 2;
constexpr int kMeshLevel = 3;
// Above 65 536 vertices of two numbers and 131 072 triangles of three, each number of at most five bytes.
constexpr std::size_t kMaxMeshBytes = std::size_t{1} << 22;

std::uint32_t zigzag(std::int32_t x) {
  return (static_cast<std::uint32_t>(x) << 1) ^ static_cast<std::uint32_t>(x >> 31);
}

std::int32_t unzigzag(std::uint32_t x) { return static_cast<std::int32_t>((x >> 1) ^ (0U - (x & 1U))); }

// Differences wrap modulo 2^32, so every int32 survives prediction.
std::int32_t wrap_sub(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

std::int32_t wrap_add(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

// A height is predicted from the posts in the west, in the south and between both, so that what is stored are the changes of
// the step from one post to the next, from row to row. The first post of a row follows that in the south of it, and the
// steps of the row before the first are 0.
using Steps = std::vector<std::uint32_t>;

// Writes numbers to bytes that have room for them.
class Writer {
 public:
  static constexpr std::size_t kMostBytes = 5;  // of a number

  explicit Writer(std::size_t most_numbers)
      : bytes_(std::make_unique_for_overwrite<std::uint8_t[]>(most_numbers * kMostBytes)) {}

  void varint(std::uint32_t x) {
    while (x >= 0x80U) {
      bytes_[size_++] = static_cast<std::uint8_t>(x | 0x80U);
      x >>= 7;
    }
    bytes_[size_++] = static_cast<std::uint8_t>(x);
  }

  std::span<const std::uint8_t> bytes() const { return {bytes_.get(), size_}; }

 private:
  std::unique_ptr<std::uint8_t[]> bytes_;
  std::size_t size_ = 0;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint32_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      if (at_ == bytes_.size()) throw CodecError("mesh: data ends early");
      const std::uint8_t byte = bytes_[at_++];
      value |= std::uint64_t{byte & 0x7fU} << shift;
      if ((byte & 0x80U) == 0) {
        if (value > 0xffffffffULL) break;
        return static_cast<std::uint32_t>(value);
      }
    }
    throw CodecError("mesh: a number is too long");
  }

  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

using Triangle = std::array<std::uint16_t, 3>;

// Returns true if triangles start at their lowest vertex and ascend, as those of a lod::TileMesh do.
bool is_normalized(std::span<const std::uint16_t> indices) {
  Triangle last{};
  bool ascends = true;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const Triangle tri{indices[t], indices[t + 1], indices[t + 2]};
    ascends = ascends && tri[0] <= std::min(tri[1], tri[2]) && last <= tri;
    last = tri;
  }
  return ascends;
}

std::vector<std::uint16_t> normalized(std::span<const std::uint16_t> indices) {
  std::vector<Triangle> triangles(indices.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle& tri = triangles[t];
    std::copy_n(indices.begin() + static_cast<std::ptrdiff_t>(3 * t), 3, tri.begin());
    std::rotate(tri.begin(), std::min_element(tri.begin(), tri.end()), tri.end());
  }
  std::sort(triangles.begin(), triangles.end());
  std::vector<std::uint16_t> flat;
  for (const Triangle& tri : triangles) flat.insert(flat.end(), tri.begin(), tri.end());
  return flat;
}

}  // namespace

Bytes compress(std::span<const std::uint8_t> raw, int level) {
  // A thread keeps its context, whose tables take longer to be made than small tiles to be packed.
  thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                                  ZSTD_freeCCtx);
  // And room for what it packs, so that no bytes are cleared which are then written.
  thread_local Bytes room;
  room.resize(std::max(room.size(), ZSTD_compressBound(raw.size())));
  const std::size_t size =
      ZSTD_compressCCtx(context.get(), room.data(), room.size(), raw.data(), raw.size(), level);
  if (ZSTD_isError(size) != 0U) throw CodecError(std::string("zstd: ") + ZSTD_getErrorName(size));
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
}

namespace {

// Returns what decompress() returns, in memory of the thread that stays as it is until its next call.
std::span<const std::uint8_t> decompressed(std::span<const std::uint8_t> packed, std::size_t limit) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > limit) {
    throw CodecError("zstd: not a frame of the expected size");
  }
  thread_local Bytes room;
  room.resize(std::max(room.size(), static_cast<std::size_t>(size)));
  thread_local const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                                  ZSTD_freeDCtx);
  const std::size_t got = ZSTD_decompressDCtx(context.get(), room.data(), static_cast<std::size_t>(size),
                                              packed.data(), packed.size());
  if (ZSTD_isError(got) != 0U) throw CodecError(std::string("zstd: ") + ZSTD_getErrorName(got));
  if (got != size) throw CodecError("zstd: frame is shorter than its header states");
  return std::span(room).first(got);
}

}  // namespace

Bytes decompress(std::span<const std::uint8_t> packed, std::size_t limit) {
  const std::span<const std::uint8_t> bytes = decompressed(packed, limit);
  return {bytes.begin(), bytes.end()};
}

Bytes encode_heights(std::span<const std::int32_t> quanta, int side) {
  const auto n = static_cast<std::size_t>(side);
  const std::size_t count = n * n;
  if (quanta.size() != count) throw CodecError("heights: wrong number of posts");
  Bytes planes(4 * count);
  Steps steps(n);
  std::vector<std::uint32_t> rest(n);
  for (std::size_t j = 0; j < n; ++j) {
    const std::int32_t* row = quanta.data() + j * n;
    const auto change = [&](std::size_t i, std::uint32_t step) {
      rest[i] = zigzag(static_cast<std::int32_t>(step - steps[i]));
      steps[i] = step;
    };
    change(0, static_cast<std::uint32_t>(row[0]));
    for (std::size_t i = 1; i < n; ++i) change(i, static_cast<std::uint32_t>(wrap_sub(row[i], row[i - 1])));
    for (std::size_t plane = 0; plane < 4; ++plane) {
      std::uint8_t* out = planes.data() + plane * count + j * n;
      for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(rest[i] >> (8 * plane));
    }
  }
  return compress(planes, kHeightsLevel);
}

std::vector<std::int32_t> decode_heights(std::span<const std::uint8_t> packed, int side) {
  const auto n = static_cast<std::size_t>(side);
  const std::size_t count = n * n;
  const std::span<const std::uint8_t> planes = decompressed(packed, 4 * count);
  if (planes.size() != 4 * count) throw CodecError("heights: wrong number of posts");
  std::vector<std::int32_t> quanta(count);
  Steps steps(n);
  const auto rows = [&](const auto& rest_at) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::uint8_t* in = planes.data() + j * n;
      std::uint32_t* step = steps.data();
      for (std::size_t i = 0; i < n; ++i) step[i] += static_cast<std::uint32_t>(unzigzag(rest_at(in + i)));
      std::int32_t* out = quanta.data() + j * n;
      std::uint32_t height = 0;
      for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<std::int32_t>(height += step[i]);
    }
  };
  const auto low = [count](const std::uint8_t* in) {
    return std::uint32_t{in[0]} | std::uint32_t{in[count]} << 8;
  };
  // Most tiles have no changes of 2^15 quanta or more.
  const std::span<const std::uint8_t> high = planes.subspan(2 * count);
  if (count > 0 && high[0] == 0 && std::memcmp(high.data(), high.data() + 1, high.size() - 1) == 0) {
    rows(low);
  } else {
    rows([&](const std::uint8_t* in) {
      return low(in) | std::uint32_t{in[2 * count]} << 16 | std::uint32_t{in[3 * count]} << 24;
    });
  }
  return quanta;
}

Bytes encode_mask(const std::vector<bool>& nodata) {
  Bytes bits((nodata.size() + 7) / 8);
  for (std::size_t i = 0; i < nodata.size(); ++i) {
    if (nodata[i]) bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | 1U << (i % 8));
  }
  return compress(bits, kMeshLevel);
}

std::vector<bool> decode_mask(std::span<const std::uint8_t> packed, std::size_t count) {
  const Bytes bits = decompress(packed, (count + 7) / 8);
  if (bits.size() != (count + 7) / 8) throw CodecError("nodata mask: wrong number of posts");
  std::vector<bool> nodata(count);
  for (std::size_t i = 0; i < count; ++i) nodata[i] = (bits[i / 8] >> (i % 8) & 1U) != 0;
  return nodata;
}

Bytes encode_numbers(std::span<const std::uint16_t> numbers) {
  Bytes planes(2 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    planes[i] = static_cast<std::uint8_t>(numbers[i] & 0xffU);
    planes[numbers.size() + i] = static_cast<std::uint8_t>(numbers[i] >> 8U);
  }
  return compress(planes, kMeshLevel);
}

std::vector<std::uint16_t> decode_numbers(std::span<const std::uint8_t> packed, std::size_t count,
                                          std::size_t most) {
  const Bytes planes = decompress(packed, 2 * count);
  if (planes.size() != 2 * count) throw CodecError("sources: wrong number of posts");
  std::vector<std::uint16_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    numbers[i] = static_cast<std::uint16_t>(planes[i] | planes[count + i] << 8);
    if (numbers[i] > most) throw CodecError("sources: a post has a source that the tile does not have");
  }
  return numbers;
}

Bytes encode_mesh(const PackedMesh& packed) {
  const lod::TileMesh& mesh = packed.mesh;
  if (packed.height_q.size() != mesh.vertices.size())
    throw CodecError("mesh: the number of heights is not the number of vertices");
  Writer out(3 + 2 * mesh.vertices.size() + 3 * mesh.triangle_count());
  out.varint(static_cast<std::uint32_t>(mesh.intervals));
  out.varint(static_cast<std::uint32_t>(mesh.vertices.size()));
  out.varint(static_cast<std::uint32_t>(mesh.triangle_count()));
  std::uint32_t last = 0;
  const auto side = static_cast<std::uint32_t>(mesh.intervals) + 1;
  for (const lod::MeshVertex& v : mesh.vertices) {
    const std::uint32_t at = v.j * side + v.i;
    out.varint(at - last);
    last = at;
  }
  std::int32_t height = 0;
  for (const std::int32_t h : packed.height_q) {
    out.varint(zigzag(wrap_sub(h, height)));
    height = h;
  }
  std::uint32_t first = 0;
  std::vector<std::uint16_t> sorted;
  std::span<const std::uint16_t> indices(mesh.triangles);
  if (!is_normalized(indices)) indices = sorted = normalized(indices);
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    out.varint(std::uint32_t{indices[t]} - first);
    out.varint(static_cast<std::uint32_t>(indices[t + 1] - indices[t]));
    out.varint(static_cast<std::uint32_t>(indices[t + 2] - indices[t]));
    first = indices[t];
  }
  return compress(out.bytes(), kMeshLevel);
}

PackedMesh decode_mesh(std::span<const std::uint8_t> packed, int expected_intervals) {
  const Bytes raw = decompress(packed, kMaxMeshBytes);
  Reader in(raw);
  PackedMesh out;
  const std::uint32_t intervals = in.varint();
  const std::uint32_t vertices = in.varint();
  const std::uint32_t triangles = in.varint();
  if (intervals == 0 || intervals > 1024 || vertices < 3 || vertices > 65536 || triangles > 2 * vertices) {
    throw CodecError("mesh: sizes out of range");
  }
  if (static_cast<int>(intervals) != expected_intervals) {
    throw CodecError("mesh: " + std::to_string(intervals) + " intervals instead of " +
                     std::to_string(expected_intervals));
  }
  out.mesh.intervals = static_cast<int>(intervals);
  out.mesh.vertices.reserve(vertices);
  const std::uint32_t side = intervals + 1;
  std::uint64_t at = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t step = in.varint();
    if (v > 0 && step == 0) throw CodecError("mesh: vertices repeat");
    at += step;
    if (at >= std::uint64_t{side} * side) throw CodecError("mesh: a vertex lies outside the grid");
    out.mesh.vertices.push_back({static_cast<std::uint16_t>(at % side), static_cast<std::uint16_t>(at / side)});
  }
  out.height_q.reserve(vertices);
  std::int32_t height = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    height = wrap_add(height, unzigzag(in.varint()));
    out.height_q.push_back(height);
  }
  out.mesh.triangles.reserve(3 * std::size_t{triangles});
  std::uint64_t first = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    first += in.varint();
    const std::uint64_t second = first + in.varint();
    const std::uint64_t third = first + in.varint();
    if (first >= vertices || second >= vertices || third >= vertices) {
      throw CodecError("mesh: a triangle refers to a vertex that does not exist");
    }
    for (const std::uint64_t index : {first, second, third}) {
      out.mesh.triangles.push_back(static_cast<std::uint16_t>(index));
    }
  }
  if (!in.at_end()) throw CodecError("mesh: bytes left over");
  return out;
}

std::int64_t checksum(std::int64_t key, std::span<const std::uint8_t> payload) {
  const XXH64_hash_t hash =
      XXH3_64bits_withSeed(payload.data(), payload.size(), static_cast<XXH64_hash_t>(key));
  return static_cast<std::int64_t>(hash & 0x7fffffffffffffffULL);
}

}  // namespace paging
