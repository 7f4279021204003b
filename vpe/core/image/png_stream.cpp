#include "vpe/core/image/png_stream.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "vpe/core/image/image.h"
#include "vpe/core/image/png_chunks.h"

#ifdef VPE_LIBDEFLATE
#include <libdeflate.h>
#endif

namespace vpe::core {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;     // of rows that one thread packs, about
constexpr std::size_t kMaxWholeBytes = std::size_t{1} << 28;  // of rows that are packed in one piece
constexpr std::array<std::uint8_t, 4> kNoPixel{};             // left of the first one
constexpr std::array<std::uint8_t, 2> kZlibHeader{0x78, 0x01};
constexpr std::array<std::uint8_t, 2> kLastBlock{0x03, 0x00};  // an empty one

bool is_whole(PngPacking packing, std::size_t bytes) {
#ifdef VPE_LIBDEFLATE
  return packing == PngPacking::kWhole && bytes <= kMaxWholeBytes;
#else
  static_cast<void>(packing);
  static_cast<void>(bytes);
  return false;
#endif
}

// Writes differences to `before`. Returns the sum of their sizes: the smaller it is, the better they pack.
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

// Filters rows of one image; keeps scratch memory from row to row.
class Filter {
 public:
  Filter(std::size_t row_bytes, int channels)
      : row_bytes_(row_bytes), pixel_bytes_(static_cast<std::size_t>(channels)), up_(row_bytes) {}

  // Writes the number of the filter and row_bytes filtered bytes for each row. `above` is the row before the
  // first one.
  void apply(Bytes rows, const std::uint8_t* above, std::uint8_t* out) {
    constexpr std::uint8_t kSub = 1;
    constexpr std::uint8_t kUp = 2;
    for (std::size_t begin = 0; begin < rows.size(); begin += row_bytes_, out += row_bytes_ + 1) {
      const std::uint8_t* const row = rows.data() + begin;
      const std::uint64_t left =
          difference(row, kNoPixel.data(), pixel_bytes_, out + 1) +
          difference(row + pixel_bytes_, row, row_bytes_ - pixel_bytes_, out + 1 + pixel_bytes_);
      const bool is_up = difference(row, above, row_bytes_, up_.data()) < left;
      out[0] = is_up ? kUp : kSub;
      if (is_up) std::memcpy(out + 1, up_.data(), row_bytes_);
      above = row;
    }
  }

 private:
  std::size_t row_bytes_;
  std::size_t pixel_bytes_;
  std::vector<std::uint8_t> up_;
};

struct Block {
  std::vector<std::uint8_t> packed;
  std::uint32_t checksum = 1;
  std::size_t bytes = 0;  // before packing
};

// Packs a part of a Deflate stream that ends at a whole byte, so that parts can follow each other.
Block pack(Bytes bytes, int compression) {
  z_stream stream{};
  constexpr int kRaw = -15;
  constexpr int kMemory = 8;
  if (::deflateInit2(&stream, compression, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  Block block;
  block.bytes = bytes.size();
  block.checksum = static_cast<std::uint32_t>(::adler32(1, bytes.data(), static_cast<uInt>(bytes.size())));
  constexpr std::size_t kFlush = 16;
  try {
    block.packed.resize(::deflateBound(&stream, static_cast<uLong>(bytes.size())) + kFlush);
  } catch (...) {
    ::deflateEnd(&stream);
    throw;
  }
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = block.packed.data();
  stream.avail_out = static_cast<uInt>(block.packed.size());
  ::deflate(&stream, Z_SYNC_FLUSH);
  block.packed.resize(stream.total_out);
  const bool all = stream.avail_in == 0;
  ::deflateEnd(&stream);
  if (!all) throw std::logic_error("a block of rows that does not pack");
  return block;
}

}  // namespace

PngStream::PngStream(std::int64_t width_px, std::int64_t height_px, PngStreamOptions options, Sink sink)
    : options_(std::move(options)),
      sink_(std::move(sink)),
      row_bytes_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(options_.channels)),
      height_px_(height_px),
      above_(row_bytes_) {
  const auto rows = static_cast<std::size_t>(height_px);
  if (is_whole(options_.packing, row_bytes_ * rows)) {
    filtered_ = std::make_unique_for_overwrite<std::uint8_t[]>((row_bytes_ + 1) * rows);
  }
  sink_(kPngSignature);
  std::vector<std::uint8_t> header;
  put_png_number(header, static_cast<std::uint32_t>(width_px));
  put_png_number(header, static_cast<std::uint32_t>(height_px));
  // Bits of a channel, kind of colour, and the only methods of packing, of filtering and of ordering rows.
  header.insert(header.end(), {8, static_cast<std::uint8_t>(options_.channels == 4 ? 6 : 2), 0, 0, 0});
  write_chunk("IHDR", header);
  constexpr std::array<std::uint8_t, 1> kPerceptual{0};
  write_chunk("sRGB", kPerceptual);
  if (!options_.xmp.empty()) sink_(png_xmp_chunk(options_.xmp));
}

void PngStream::write_chunk(std::string_view type, Bytes data) {
  const PngChunkFrame frame = png_chunk_frame(type, data);
  sink_(frame.head);
  if (!data.empty()) sink_(data);
  sink_(frame.tail);
}

void PngStream::write(Bytes rows) {
  const std::size_t count = rows.size() / row_bytes_;
  if (count * row_bytes_ != rows.size() || static_cast<std::int64_t>(count) > height_px_ - rows_written_) {
    throw std::logic_error("not the rows of this image");
  }
  if (count == 0) return;
  if (filtered_ != nullptr) {
    Filter(row_bytes_, options_.channels)
        .apply(rows, above_.data(),
               filtered_.get() + static_cast<std::size_t>(rows_written_) * (row_bytes_ + 1));
  } else {
    write_blocks(rows);
  }
  const Bytes last = rows.last(row_bytes_);
  above_.assign(last.begin(), last.end());
  rows_written_ += static_cast<std::int64_t>(count);
}

void PngStream::write_blocks(Bytes rows) {
  const std::size_t count = rows.size() / row_bytes_;
  const std::size_t step = std::max<std::size_t>(1, kBlockBytes / row_bytes_);
  std::vector<Block> blocks((count + step - 1) / step);
  const auto pack_block = [&](std::size_t n) {
    const std::size_t begin = n * step;
    const Bytes of_block = rows.subspan(begin * row_bytes_, std::min(step, count - begin) * row_bytes_);
    const std::uint8_t* above = begin == 0 ? above_.data() : of_block.data() - row_bytes_;
    std::vector<std::uint8_t> filtered(of_block.size() / row_bytes_ * (row_bytes_ + 1));
    Filter(row_bytes_, options_.channels).apply(of_block, above, filtered.data());
    blocks[n] = pack(filtered, options_.compression);
  };
  if (options_.pool != nullptr) {
    options_.pool->run(blocks.size(), pack_block);
  } else {
    for (std::size_t n = 0; n < blocks.size(); ++n) pack_block(n);
  }
  bool is_first = rows_written_ == 0;
  for (Block& block : blocks) {
    if (is_first) block.packed.insert(block.packed.begin(), kZlibHeader.begin(), kZlibHeader.end());
    is_first = false;
    write_chunk("IDAT", block.packed);
    checksum_ = static_cast<std::uint32_t>(
        ::adler32_combine(checksum_, block.checksum, static_cast<z_off_t>(block.bytes)));
  }
}

void PngStream::write_whole() {
#ifdef VPE_LIBDEFLATE
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> packer(
      libdeflate_alloc_compressor(options_.compression), libdeflate_free_compressor);
  if (!packer) throw ImageError("cannot encode a PNG: out of memory; make the image smaller");
  const std::size_t size = (row_bytes_ + 1) * static_cast<std::size_t>(height_px_);
  // Most of this memory is never written, and what is not written takes no pages.
  const std::size_t most = libdeflate_zlib_compress_bound(packer.get(), size);
  const auto packed = std::make_unique_for_overwrite<std::uint8_t[]>(most);
  const std::size_t bytes = libdeflate_zlib_compress(packer.get(), filtered_.get(), size, packed.get(), most);
  write_chunk("IDAT", {packed.get(), bytes});
#endif
}

void PngStream::finish() {
  if (rows_written_ != height_px_) throw std::logic_error("rows are missing");
  if (filtered_ != nullptr) {
    write_whole();
  } else {
    std::vector<std::uint8_t> last(kLastBlock.begin(), kLastBlock.end());
    put_png_number(last, checksum_);
    write_chunk("IDAT", last);
  }
  write_chunk("IEND", {});
}

}  // namespace vpe::core
