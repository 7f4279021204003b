#include "panorama/image/big_tiff.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace panorama {

namespace {

constexpr std::uint64_t kFirstLink = 8;  // of the header's link to the first directory

enum Type : std::uint16_t { kByte = 1, kAscii = 2, kShort = 3, kLong = 4, kLong8 = 16 };

void put_number(std::vector<std::uint8_t>& out, std::uint64_t value, int bytes) {
  for (int n = 0; n < bytes; ++n) out.push_back(static_cast<std::uint8_t>(value >> (8 * n)));
}

struct Entry {
  std::uint16_t tag = 0;
  Type type = kShort;
  std::uint64_t count = 0;
  std::vector<std::uint8_t> data;
};

int size_of(Type type) {
  switch (type) {
    case kByte:
    case kAscii: return 1;
    case kShort: return 2;
    case kLong: return 4;
    case kLong8: return 8;
  }
  return 1;
}

Entry numbers(std::uint16_t tag, Type type, std::span<const std::uint64_t> values) {
  Entry entry{tag, type, values.size(), {}};
  for (const std::uint64_t value : values) put_number(entry.data, value, size_of(type));
  return entry;
}

Entry number(std::uint16_t tag, Type type, std::uint64_t value, int count = 1) {
  return numbers(tag, type, std::vector<std::uint64_t>(static_cast<std::size_t>(count), value));
}

Entry text(std::uint16_t tag, Type type, const std::string& value) {
  Entry entry{tag, type, value.size(), {value.begin(), value.end()}};
  if (type == kAscii) {
    entry.data.push_back(0);
    ++entry.count;
  }
  return entry;
}

}  // namespace

BigTiffWriter::Page BigTiffWriter::page_of(std::int64_t width_px, std::int64_t height_px) {
  Page page{width_px, height_px, (width_px + kTile_px - 1) / kTile_px, (height_px + kTile_px - 1) / kTile_px,
            {},       {}};
  page.offset.resize(static_cast<std::size_t>(page.across * page.down));
  page.bytes.resize(page.offset.size());
  return page;
}

BigTiffWriter::BigTiffWriter(vpe::base::OutputFile& file, std::int64_t width_px, std::int64_t height_px,
                             const SampleFormat& format, BigTiffTags tags)
    : file_(file), format_(format), tags_(std::move(tags)) {
  pages_.push_back(page_of(width_px, height_px));
  std::vector<std::uint8_t> header{'I', 'I', 43, 0, 8, 0, 0, 0};
  put_number(header, 0, 8);
  append(header);
}

void BigTiffWriter::append(std::span<const std::uint8_t> bytes) {
  file_.write(bytes);
  end_ += bytes.size();
}

void BigTiffWriter::put(Page& page, std::size_t tile, std::span<const std::uint8_t> packed) {
  page.offset.at(tile) = end_;
  page.bytes[tile] = packed.size();
  append(packed);
}

void BigTiffWriter::put(std::int64_t across, std::int64_t down, std::span<const std::uint8_t> packed) {
  Page& page = pages_.front();
  if (across < 0 || down < 0 || across >= page.across || down >= page.down) throw std::out_of_range("tile");
  put(page, static_cast<std::size_t>(down * page.across + across), packed);
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
  const std::size_t all = std::max<std::size_t>(1, pages_.front().offset.size() / 3);
  while (pages_.back().across > 1 || pages_.back().down > 1) {
    if (std::fflush(file_.stream()) != 0) {
      throw vpe::base::file_error("write", file_.path(), std::strerror(errno), "check the free space there");
    }
    const Page& fine = pages_.back();
    Page page = page_of((fine.width_px + 1) / 2, (fine.height_px + 1) / 2);
    for (std::size_t begin = 0; begin < page.offset.size(); begin += kBatch) {
      std::vector<std::vector<std::uint8_t>> packed(std::min(kBatch, page.offset.size() - begin));
      pool.run(packed.size(), [&](std::size_t n) {
        const auto tile = static_cast<std::int64_t>(begin + n);
        packed[n] = reduced(fine, tile % page.across, tile / page.across);
      });
      for (std::size_t n = 0; n < packed.size(); ++n) put(page, begin + n, packed[n]);
      made += packed.size();
      done(std::min(1.0, static_cast<double>(made) / static_cast<double>(all)));
    }
    pages_.push_back(std::move(page));
  }
}

std::uint64_t BigTiffWriter::write_directory(const Page& page, bool is_reduced, std::uint64_t link) {
  const auto bits = static_cast<std::uint64_t>(8 * format_.bytes);
  const bool is_float = format_.bytes > 1;
  const bool is_rgb = format_ == kRgb;
  std::vector<Entry> entries{number(254, kLong, is_reduced ? 1 : 0),
                             number(256, kLong, static_cast<std::uint64_t>(page.width_px)),
                             number(257, kLong, static_cast<std::uint64_t>(page.height_px)),
                             number(258, kShort, bits, format_.samples),
                             number(259, kShort, 8),               // Deflate
                             number(262, kShort, is_rgb ? 2 : 1),  // RGB, or black is the least
                             number(277, kShort, static_cast<std::uint64_t>(format_.samples)),
                             number(284, kShort, 1)};  // samples of a pixel together
  if (!tags_.software.empty()) entries.push_back(text(305, kAscii, tags_.software));
  entries.push_back(number(317, kShort, is_float ? 3 : 2));
  entries.push_back(number(322, kLong, kTile_px));
  entries.push_back(number(323, kLong, kTile_px));
  entries.push_back(numbers(324, kLong8, page.offset));
  entries.push_back(numbers(325, kLong8, page.bytes));
  if (!is_rgb && format_.samples > 1) entries.push_back(number(338, kShort, 0, format_.samples - 1));
  entries.push_back(number(339, kShort, is_float ? 3 : 1, format_.samples));
  if (!tags_.xmp.empty() && !is_reduced) entries.push_back(text(700, kByte, tags_.xmp));
  if (tags_.no_data) entries.push_back(text(42113, kAscii, "nan"));

  // What does not fit into an entry stands before the directory.
  std::vector<std::uint8_t> directory;
  put_number(directory, entries.size(), 8);
  for (Entry& entry : entries) {
    put_number(directory, entry.tag, 2);
    put_number(directory, entry.type, 2);
    put_number(directory, entry.count, 8);
    if (entry.data.size() > 8) {
      const std::uint64_t at = end_;
      append(entry.data);
      put_number(directory, at, 8);
    } else {
      entry.data.resize(8);
      directory.insert(directory.end(), entry.data.begin(), entry.data.end());
    }
  }
  const std::uint64_t begin = end_;
  const std::uint64_t next_link = begin + directory.size();
  put_number(directory, 0, 8);
  append(directory);

  std::vector<std::uint8_t> pointer;
  put_number(pointer, begin, 8);
  if (fseeko(file_.stream(), static_cast<off_t>(link), SEEK_SET) != 0) {
    throw vpe::base::file_error("write", file_.path(), std::strerror(errno), "check the disk");
  }
  file_.write(pointer);
  if (fseeko(file_.stream(), static_cast<off_t>(end_), SEEK_SET) != 0) {
    throw vpe::base::file_error("write", file_.path(), std::strerror(errno), "check the disk");
  }
  return next_link;
}

void BigTiffWriter::finish() {
  std::uint64_t link = kFirstLink;
  for (std::size_t n = 0; n < pages_.size(); ++n) {
    const Page& page = pages_[n];
    if (std::find(page.offset.begin(), page.offset.end(), 0) != page.offset.end()) {
      throw std::logic_error("tiles are missing");
    }
    link = write_directory(page, n > 0, link);
  }
}

}  // namespace panorama
