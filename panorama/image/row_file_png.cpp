#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <vector>

#include "panorama/image/row_file.h"

namespace panorama {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kPixelBytes = 3;
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;  // of rows that one thread packs, about
constexpr int kLevel = 1;

void put_be(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

// Rows as they are packed: each is preceded by its filter, of those two that make it smallest in sum.
Bytes filtered(const std::uint8_t* rows, const std::uint8_t* above, std::size_t count, std::size_t row_bytes) {
  Bytes out(count * (row_bytes + 1));
  Bytes up(row_bytes);
  constexpr std::uint8_t kSub = 1;
  constexpr std::uint8_t kUp = 2;
  const auto size = [](std::uint8_t byte) { return std::abs(static_cast<std::int8_t>(byte)); };
  for (std::size_t y = 0; y < count; ++y) {
    const std::uint8_t* row = rows + y * row_bytes;
    std::uint8_t* sub = out.data() + y * (row_bytes + 1) + 1;
    std::int64_t sub_sum = 0;
    std::int64_t up_sum = 0;
    for (std::size_t n = 0; n < row_bytes; ++n) {
      sub[n] = static_cast<std::uint8_t>(row[n] - (n < kPixelBytes ? 0 : row[n - kPixelBytes]));
      sub_sum += size(sub[n]);
    }
    for (std::size_t n = 0; n < row_bytes; ++n) {
      up[n] = static_cast<std::uint8_t>(row[n] - above[n]);
      up_sum += size(up[n]);
    }
    sub[-1] = up_sum < sub_sum ? kUp : kSub;
    if (up_sum < sub_sum) std::copy(up.begin(), up.end(), sub);
    above = row;
  }
  return out;
}

struct Block {
  Bytes packed;
  std::uint32_t sum = 1;
  std::size_t bytes = 0;
};

// A piece of a Deflate stream that ends at a byte, so that pieces can follow each other.
Block pack(const Bytes& bytes) {
  z_stream stream{};
  constexpr int kRaw = -15;
  constexpr int kMemory = 8;
  if (::deflateInit2(&stream, kLevel, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  Block block;
  block.bytes = bytes.size();
  block.sum = static_cast<std::uint32_t>(::adler32(1, bytes.data(), static_cast<uInt>(bytes.size())));
  constexpr std::size_t kFlush = 16;
  block.packed.resize(::deflateBound(&stream, static_cast<uLong>(bytes.size())) + kFlush);
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

class PngWriter : public RowWriter {
 public:
  PngWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px, const std::string& xmp,
            vpe::base::ThreadPool& pool)
      : file_(file),
        pool_(pool),
        row_bytes_(static_cast<std::size_t>(width_px) * kPixelBytes),
        rows_left_(height_px),
        above_(row_bytes_) {
    constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    file_.write(kSignature);
    Bytes header;
    put_be(header, static_cast<std::uint32_t>(width_px));
    put_be(header, static_cast<std::uint32_t>(height_px));
    for (const int value : {8, 2, 0, 0, 0}) header.push_back(static_cast<std::uint8_t>(value));  // 8-bit RGB
    chunk("IHDR", header);
    chunk("sRGB", Bytes{0});
    if (xmp.empty()) return;
    const std::string keyword = "XML:com.adobe.xmp";
    Bytes text(keyword.begin(), keyword.end());
    text.insert(text.end(), 5, 0);  // end of keyword; not packed; no language; no translation
    text.insert(text.end(), xmp.begin(), xmp.end());
    chunk("iTXt", text);
  }

  void write(std::span<const vpe::base::Rgb> rows) override {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(rows.data());
    const std::size_t count = rows.size_bytes() / row_bytes_;
    if (count * row_bytes_ != rows.size_bytes() || static_cast<std::int64_t>(count) > rows_left_) {
      throw std::logic_error("not the rows of this picture");
    }
    const std::size_t step = std::max<std::size_t>(1, kBlockBytes / row_bytes_);
    std::vector<Block> blocks((count + step - 1) / step);
    pool_.run(blocks.size(), [&](std::size_t n) {
      const std::size_t begin = n * step;
      const std::uint8_t* above = begin == 0 ? above_.data() : bytes + (begin - 1) * row_bytes_;
      blocks[n] = pack(filtered(bytes + begin * row_bytes_, above, std::min(step, count - begin), row_bytes_));
    });
    for (const Block& block : blocks) {
      Bytes data;
      if (is_first_) data = {0x78, 0x01};
      is_first_ = false;
      data.insert(data.end(), block.packed.begin(), block.packed.end());
      chunk("IDAT", data);
      sum_ = ::adler32_combine(sum_, block.sum, static_cast<z_off_t>(block.bytes));
    }
    if (count > 0) above_.assign(bytes + (count - 1) * row_bytes_, bytes + count * row_bytes_);
    rows_left_ -= static_cast<std::int64_t>(count);
  }

  void finish() override {
    if (rows_left_ != 0) throw std::logic_error("rows are missing");
    Bytes last{0x03, 0x00};  // an empty last block
    put_be(last, static_cast<std::uint32_t>(sum_));
    chunk("IDAT", last);
    chunk("IEND", {});
  }

 private:
  void chunk(const char* type, const Bytes& data) {
    Bytes head;
    put_be(head, static_cast<std::uint32_t>(data.size()));
    head.insert(head.end(), type, type + 4);
    uLong sum = ::crc32(0, head.data() + 4, 4);
    if (!data.empty()) sum = ::crc32(sum, data.data(), static_cast<uInt>(data.size()));
    file_.write(head);
    file_.write(data);
    Bytes tail;
    put_be(tail, static_cast<std::uint32_t>(sum));
    file_.write(tail);
  }

  vpe::base::OutputFile& file_;
  vpe::base::ThreadPool& pool_;
  std::size_t row_bytes_;
  std::int64_t rows_left_;
  Bytes above_;  // the row before
  uLong sum_ = 1;
  bool is_first_ = true;
};

}  // namespace

std::unique_ptr<RowWriter> make_png_writer(vpe::base::OutputFile& file, std::int64_t width_px,
                                           std::int64_t height_px, const std::string& xmp,
                                           vpe::base::ThreadPool& pool) {
  return std::make_unique<PngWriter>(file, width_px, height_px, xmp, pool);
}

}  // namespace panorama
