#include "vpe/core/image/png_packer.h"

#include "vpe/core/image/image.h"

#ifdef VPE_LIBDEFLATE

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

namespace vpe::core {

namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 28;
constexpr std::uint8_t kSub = 1;
constexpr std::uint8_t kUp = 2;

void put_number(std::vector<std::uint8_t>& out, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(number >> shift));
}

// Length, name, data, checksum of name and data.
void put_chunk(std::vector<std::uint8_t>& out, const char* name, const std::uint8_t* data, std::size_t size) {
  put_number(out, static_cast<std::uint32_t>(size));
  const std::size_t begin = out.size();
  out.insert(out.end(), name, name + 4);
  out.insert(out.end(), data, data + size);
  put_number(out, libdeflate_crc32(0, out.data() + begin, out.size() - begin));
}

// Differences to `before`. Returns how large they are: the less, the better they pack.
std::uint64_t difference(const std::uint8_t* row, const std::uint8_t* before, std::size_t size,
                         std::uint8_t* out) {
  std::uint64_t sum = 0;
  constexpr std::size_t kPart = 128;  // sums of a part fit 16 bits
  for (std::size_t begin = 0; begin < size; begin += kPart) {
    const std::size_t end = std::min(begin + kPart, size);
    std::uint16_t part = 0;
    for (std::size_t n = begin; n < end; ++n) {
      const auto d = static_cast<std::uint8_t>(row[n] - before[n]);
      out[n] = d;
      part = static_cast<std::uint16_t>(part + std::min(d, static_cast<std::uint8_t>(-d)));
    }
    sum += part;
  }
  return sum;
}

// Each row against its left neighbours or the row above, whichever differs less, after the filter's number.
std::unique_ptr<std::uint8_t[]> filtered(const std::uint8_t* pixels, std::size_t channels,
                                         std::size_t row_bytes, std::size_t rows) {
  auto out = std::make_unique_for_overwrite<std::uint8_t[]>((row_bytes + 1) * rows);
  std::vector<std::uint8_t> up(row_bytes);
  const std::vector<std::uint8_t> none(row_bytes);
  for (std::size_t y = 0; y < rows; ++y) {
    const std::uint8_t* const row = pixels + y * row_bytes;
    std::uint8_t* const to = out.get() + y * (row_bytes + 1);
    const std::uint64_t left = difference(row, none.data(), channels, to + 1) +
                               difference(row + channels, row, row_bytes - channels, to + 1 + channels);
    const std::uint64_t above = difference(row, y > 0 ? row - row_bytes : none.data(), row_bytes, up.data());
    to[0] = above < left ? kUp : kSub;
    if (above < left) std::memcpy(to + 1, up.data(), row_bytes);
  }
  return out;
}

}  // namespace

bool can_pack_png(std::size_t pixel_bytes) { return pixel_bytes <= kMostBytes; }

std::vector<std::uint8_t> pack_png(const std::uint8_t* pixels, int channels, int width, int height,
                                   int compression) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> packer(
      libdeflate_alloc_compressor(compression), libdeflate_free_compressor);
  if (!packer) throw ImageError("cannot encode a PNG: out of memory; make the picture smaller");
  const auto bytes = static_cast<std::size_t>(channels);
  const std::size_t row_bytes = bytes * static_cast<std::size_t>(width);
  const std::size_t size = (row_bytes + 1) * static_cast<std::size_t>(height);
  const auto rows = filtered(pixels, bytes, row_bytes, static_cast<std::size_t>(height));
  // Memory that is not written first is not brought first: most of this never is.
  const std::size_t most = libdeflate_zlib_compress_bound(packer.get(), size);
  const auto packed = std::make_unique_for_overwrite<std::uint8_t[]>(most);
  const std::size_t packed_size = libdeflate_zlib_compress(packer.get(), rows.get(), size, packed.get(), most);

  constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::size_t kOtherBytes = 128;
  std::vector<std::uint8_t> out;
  out.reserve(packed_size + kOtherBytes);
  out.assign(kSignature.begin(), kSignature.end());
  std::vector<std::uint8_t> header;
  put_number(header, static_cast<std::uint32_t>(width));
  put_number(header, static_cast<std::uint32_t>(height));
  // Bits a channel, kind of colour, and the one way there is to pack, to filter, and to order rows.
  header.insert(header.end(), {8, static_cast<std::uint8_t>(channels == 4 ? 6 : 2), 0, 0, 0});
  put_chunk(out, "IHDR", header.data(), header.size());
  constexpr std::uint8_t kPerceptual = 0;
  put_chunk(out, "sRGB", &kPerceptual, 1);
  put_chunk(out, "IDAT", packed.get(), packed_size);
  put_chunk(out, "IEND", nullptr, 0);
  return out;
}

}  // namespace vpe::core

#else

namespace vpe::core {

bool can_pack_png(std::size_t /*pixel_bytes*/) { return false; }

std::vector<std::uint8_t> pack_png(const std::uint8_t* /*pixels*/, int /*channels*/, int /*width*/,
                                   int /*height*/, int /*compression*/) {
  throw ImageError("cannot encode a PNG in one piece: built without libdeflate");
}

}  // namespace vpe::core

#endif
