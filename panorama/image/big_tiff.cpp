#include "panorama/image/big_tiff.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace panorama {

namespace {

constexpr char kDiskAdvice[] = "check the free space and the permissions there";

}  // namespace

BigTiffWriter::BigTiffWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px,
                             const SampleFormat& format, BigTiffTags tags)
    : file_(file), format_(format), tags_(std::move(tags)), tiff_(file.stream(), file.path(), "w8") {
  if (tiff_.get() == nullptr) fail();
  begin_page(width_px, height_px, false);
}

void BigTiffWriter::fail() const {
  // The library says that writing failed, and the system why.
  const bool is_system = errno != 0 && std::ferror(file_.stream()) != 0;
  throw vpe::base::file_error("write", file_.path(), is_system ? std::strerror(errno) : tiff_.words(),
                              kDiskAdvice);
}

void BigTiffWriter::begin_page(std::int64_t width_px, std::int64_t height_px, bool is_reduced) {
  page_ = {width_px, height_px, (width_px + kTile_px - 1) / kTile_px, (height_px + kTile_px - 1) / kTile_px,
           {},       {}};
  vpe::core::TiffLayout layout;
  layout.width_px = static_cast<std::uint32_t>(width_px);
  layout.height_px = static_cast<std::uint32_t>(height_px);
  layout.samples = static_cast<std::uint16_t>(format_.samples);
  layout.bits = static_cast<std::uint16_t>(8 * format_.bytes);
  layout.compression = COMPRESSION_ADOBE_DEFLATE;
  layout.tile_width_px = layout.tile_height_px = kTile_px;
  TIFF* tiff = tiff_.get();
  bool ok = set_layout(tiff, layout) &&
            TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, is_reduced ? FILETYPE_REDUCEDIMAGE : 0) == 1;
  if (format_ != kRgb && format_.samples > 1) {
    const std::vector<std::uint16_t> unspecified(layout.samples - 1U, EXTRASAMPLE_UNSPECIFIED);
    ok = ok && TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<std::uint16_t>(unspecified.size()),
                            unspecified.data()) == 1;
  }
  if (!tags_.software.empty()) ok = ok && TIFFSetField(tiff, TIFFTAG_SOFTWARE, tags_.software.c_str()) == 1;
  if (!tags_.xmp.empty() && !is_reduced) {
    ok = ok && TIFFSetField(tiff, TIFFTAG_XMLPACKET, static_cast<std::uint32_t>(tags_.xmp.size()),
                            tags_.xmp.data()) == 1;
  }
  if (!is_reduced) ok = ok && set_metadata(tiff, tags_.metadata);
  if (!ok) fail();
}

void BigTiffWriter::end_page() {
  const auto tiles = static_cast<std::uint32_t>(page_.across * page_.down);
  std::vector<std::uint64_t> offset;
  std::vector<std::uint64_t> bytes;
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    bytes.push_back(TIFFGetStrileByteCount(tiff_.get(), tile));
    offset.push_back(TIFFGetStrileOffset(tiff_.get(), tile));
    if (bytes.back() == 0) throw std::logic_error("tiles are missing");
  }
  page_.offset = std::move(offset);
  page_.bytes = std::move(bytes);
  if (TIFFWriteDirectory(tiff_.get()) != 1) fail();
}

void BigTiffWriter::put(std::size_t tile, std::span<const std::uint8_t> packed) {
  // The library does not change raw data in this machine's order of bits.
  auto* data = const_cast<std::uint8_t*>(packed.data());
  if (TIFFWriteRawTile(tiff_.get(), static_cast<std::uint32_t>(tile), data,
                       static_cast<tmsize_t>(packed.size())) < 0)
    fail();
}

void BigTiffWriter::put(std::int64_t across, std::int64_t down, std::span<const std::uint8_t> packed) {
  if (across < 0 || down < 0 || across >= page_.across || down >= page_.down) throw std::out_of_range("tile");
  put(static_cast<std::size_t>(down * page_.across + across), packed);
}

std::vector<std::uint8_t> BigTiffWriter::read(const Page& page, std::size_t tile) const {
  std::vector<std::uint8_t> packed(page.bytes.at(tile));
  const auto at = static_cast<off_t>(page.offset[tile]);
  for (std::size_t have = 0; have < packed.size();) {
    const ssize_t got = ::pread(::fileno(file_.stream()), packed.data() + have, packed.size() - have,
                                at + static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      throw vpe::base::file_error("read back", file_.path(), got < 0 ? std::strerror(errno) : "it ends early",
                                  "check the disk");
    }
    have += static_cast<std::size_t>(got);
  }
  return unpack_tile(packed, format_);
}

// Tiles repeat the image's edge, so every 2 x 2 block is whole; a block of nothing but repetition lies beyond
// the reduced image's edge and repeats it, too.
std::vector<std::uint8_t> BigTiffWriter::reduced(const Page& fine, std::int64_t across,
                                                 std::int64_t down) const {
  constexpr std::size_t kSide = kTile_px;
  constexpr std::size_t kHalf = kSide / 2;
  const auto samples = static_cast<std::size_t>(format_.samples);
  std::vector<std::uint8_t> tile(format_.tile_bytes());
  for (std::size_t part = 0; part < 4; ++part) {
    const std::int64_t x = std::min(2 * across + static_cast<std::int64_t>(part % 2), fine.across - 1);
    const std::int64_t y = std::min(2 * down + static_cast<std::int64_t>(part / 2), fine.down - 1);
    const bool beyond_x = 2 * across + static_cast<std::int64_t>(part % 2) >= fine.across;
    const bool beyond_y = 2 * down + static_cast<std::int64_t>(part / 2) >= fine.down;
    const std::vector<std::uint8_t> from = read(fine, static_cast<std::size_t>(y * fine.across + x));
    for (std::size_t j = 0; j < kHalf; ++j) {
      for (std::size_t i = 0; i < kHalf; ++i) {
        const std::size_t column = beyond_x ? kSide - 2 : 2 * i;
        const std::size_t row = beyond_y ? kSide - 2 : 2 * j;
        const std::uint8_t* upper = from.data() + (row * kSide + column) * samples;
        const std::uint8_t* lower = upper + kSide * samples;
        std::uint8_t* out = tile.data() + (((part / 2) * kHalf + j) * kSide + (part % 2) * kHalf + i) * samples;
        for (std::size_t s = 0; s < samples; ++s) {
          out[s] = static_cast<std::uint8_t>(
              (upper[s] + upper[s + samples] + lower[s] + lower[s + samples] + 2) / 4);
        }
      }
    }
  }
  return pack_tile(tile, format_);
}

void BigTiffWriter::add_reduced_pages(vpe::base::ThreadPool& pool, const std::function<void(double)>& done) {
  if (format_ != kRgb) throw std::logic_error("reduced pages are for colours");
  constexpr std::size_t kBatch = 64;
  std::size_t made = 0;
  const std::size_t all = std::max<std::size_t>(1, static_cast<std::size_t>(page_.across * page_.down) / 3);
  while (page_.across > 1 || page_.down > 1) {
    end_page();
    const Page fine = std::move(page_);
    begin_page((fine.width_px + 1) / 2, (fine.height_px + 1) / 2, true);
    if (std::fflush(file_.stream()) != 0) {
      throw vpe::base::file_error("write", file_.path(), std::strerror(errno), kDiskAdvice);
    }
    const auto tiles = static_cast<std::size_t>(page_.across * page_.down);
    for (std::size_t begin = 0; begin < tiles; begin += kBatch) {
      std::vector<std::vector<std::uint8_t>> packed(std::min(kBatch, tiles - begin));
      pool.run(packed.size(), [&](std::size_t n) {
        const auto tile = static_cast<std::int64_t>(begin + n);
        packed[n] = reduced(fine, tile % page_.across, tile / page_.across);
      });
      for (std::size_t n = 0; n < packed.size(); ++n) put(begin + n, packed[n]);
      made += packed.size();
      done(std::min(1.0, static_cast<double>(made) / static_cast<double>(all)));
    }
  }
}

void BigTiffWriter::finish() {
  end_page();
  tiff_.close();
}

}  // namespace panorama
