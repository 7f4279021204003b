#include "panorama/image/tile_codec.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <new>
#include <stdexcept>

namespace panorama {

static_assert(std::endian::native == std::endian::little, "the predictors below are for this order");

namespace {

// Level 1 packs images of ground almost as well as the others and is several times as fast.
constexpr int kLevel = 1;

// Subtracts from each byte the one a pixel before it, from the end on.
void difference(std::uint8_t* row, std::size_t bytes, std::size_t step) {
  for (std::size_t n = bytes; n-- > step;) row[n] = static_cast<std::uint8_t>(row[n] - row[n - step]);
}

void add_up(std::uint8_t* row, std::size_t bytes, std::size_t step) {
  for (std::size_t n = step; n < bytes; ++n) row[n] = static_cast<std::uint8_t>(row[n] + row[n - step]);
}

// Orders bytes so that the highest bytes of all numbers come first.
void split_bytes(const std::uint8_t* row, std::uint8_t* out, std::size_t numbers, std::size_t bytes) {
  for (std::size_t n = 0; n < numbers; ++n) {
    for (std::size_t b = 0; b < bytes; ++b) out[(bytes - 1 - b) * numbers + n] = row[n * bytes + b];
  }
}

void join_bytes(const std::uint8_t* row, std::uint8_t* out, std::size_t numbers, std::size_t bytes) {
  for (std::size_t n = 0; n < numbers; ++n) {
    for (std::size_t b = 0; b < bytes; ++b) out[n * bytes + b] = row[(bytes - 1 - b) * numbers + n];
  }
}

// Holds the memory that packing needs; each thread keeps one from tile to tile. Under a tight --memory, blocks
// this large come from the system one by one, and zeroing them costs a tenth of the time.
class Packer {
 public:
  Packer() {
    if (::deflateInit(&stream_, kLevel) != Z_OK) throw std::bad_alloc();
  }
  ~Packer() { ::deflateEnd(&stream_); }
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  std::vector<std::uint8_t>& predicted() { return predicted_; }
  std::vector<std::uint8_t> pack() {
    packed_.resize(::deflateBound(&stream_, static_cast<uLong>(predicted_.size())));
    stream_.next_in = predicted_.data();
    stream_.avail_in = static_cast<uInt>(predicted_.size());
    stream_.next_out = packed_.data();
    stream_.avail_out = static_cast<uInt>(packed_.size());
    const int result = ::deflate(&stream_, Z_FINISH);
    const auto size = static_cast<std::ptrdiff_t>(stream_.total_out);
    ::deflateReset(&stream_);
    if (result != Z_STREAM_END) throw std::logic_error("a tile larger than zlib's own bound");
    return {packed_.begin(), packed_.begin() + size};
  }

 private:
  z_stream stream_{};
  std::vector<std::uint8_t> predicted_;
  std::vector<std::uint8_t> packed_;
};

}  // namespace

std::vector<std::uint8_t> pack_tile(std::span<const std::uint8_t> tile, const SampleFormat& format) {
  if (tile.size() != format.tile_bytes()) throw std::invalid_argument("a tile of another size");
  const std::size_t row_bytes = format.pixel_bytes() * kTile_px;
  const auto samples = static_cast<std::size_t>(format.samples);
  const auto bytes = static_cast<std::size_t>(format.bytes);
  thread_local Packer packer;
  std::vector<std::uint8_t>& predicted = packer.predicted();
  predicted.assign(tile.begin(), tile.end());
  for (std::size_t y = 0; y < kTile_px; ++y) {
    std::uint8_t* row = predicted.data() + y * row_bytes;
    if (bytes > 1) split_bytes(tile.data() + y * row_bytes, row, samples * kTile_px, bytes);
    difference(row, row_bytes, samples);
  }
  return packer.pack();
}

std::vector<std::uint8_t> unpack_tile(std::span<const std::uint8_t> packed, const SampleFormat& format) {
  std::vector<std::uint8_t> tile(format.tile_bytes());
  uLongf size = static_cast<uLongf>(tile.size());
  const int result = ::uncompress(tile.data(), &size, packed.data(), static_cast<uLong>(packed.size()));
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result != Z_OK || size != tile.size()) throw std::runtime_error("damaged tile: it does not unpack");
  const std::size_t row_bytes = format.pixel_bytes() * kTile_px;
  const auto samples = static_cast<std::size_t>(format.samples);
  const auto bytes = static_cast<std::size_t>(format.bytes);
  std::vector<std::uint8_t> split(bytes > 1 ? row_bytes : 0);
  for (std::size_t y = 0; y < kTile_px; ++y) {
    std::uint8_t* row = tile.data() + y * row_bytes;
    add_up(row, row_bytes, samples);
    if (bytes == 1) continue;
    std::memcpy(split.data(), row, row_bytes);
    join_bytes(split.data(), row, samples * kTile_px, bytes);
  }
  return tile;
}

}  // namespace panorama
