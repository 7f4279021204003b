#include "vpe/core/image/png_chunks.h"

#include <algorithm>
#include <utility>

#include "vpe/core/image/image.h"

// libdeflate computes the same sum several times as fast.
#ifdef VPE_LIBDEFLATE
#include <libdeflate.h>
#else
#include <zlib.h>
#endif

namespace vpe::core {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kTypeLength = 4;

// Continues the CRC-32 `before`; 0 starts one.
std::uint32_t checksum(std::uint32_t before, Bytes bytes) {
  if (bytes.empty()) return before;
#ifdef VPE_LIBDEFLATE
  return libdeflate_crc32(before, bytes.data(), bytes.size());
#else
  return static_cast<std::uint32_t>(::crc32(before, bytes.data(), static_cast<uInt>(bytes.size())));
#endif
}

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <std::size_t size>
void store(std::uint32_t number, std::array<std::uint8_t, size>& out) {
  for (std::size_t n = 0; n < 4; ++n) out[n] = static_cast<std::uint8_t>(number >> (24 - 8 * n));
}

PngChunks::Read reader_of(Bytes bytes) {
  return [bytes](std::uint64_t at, std::span<std::uint8_t> out) {
    if (at > bytes.size() || out.size() > bytes.size() - at) throw ImageError("PNG is cut short");
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
  };
}

}  // namespace

void put_png_number(std::vector<std::uint8_t>& out, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(number >> shift));
}

PngChunkFrame png_chunk_frame(std::string_view type, Bytes data) {
  PngChunkFrame frame{};
  store(static_cast<std::uint32_t>(data.size()), frame.head);
  std::copy_n(type.begin(), kTypeLength, frame.head.begin() + 4);
  store(checksum(checksum(0, bytes_of(type)), data), frame.tail);
  return frame;
}

std::vector<std::uint8_t> png_chunk(std::string_view type, Bytes data) {
  const PngChunkFrame frame = png_chunk_frame(type, data);
  std::vector<std::uint8_t> out(data.size() + kPngChunkFrame);
  std::copy(frame.head.begin(), frame.head.end(), out.begin());
  std::copy(data.begin(), data.end(), out.begin() + static_cast<std::ptrdiff_t>(frame.head.size()));
  std::copy(frame.tail.begin(), frame.tail.end(), out.end() - static_cast<std::ptrdiff_t>(frame.tail.size()));
  return out;
}

std::vector<std::uint8_t> png_chunk(std::string_view type, std::string_view data) {
  return png_chunk(type, bytes_of(data));
}

std::vector<std::uint8_t> png_xmp_chunk(std::string_view packet) {
  std::string data(kPngXmpKeyword);
  data.append(4, '\0');  // not compressed, no method, no language, no translated keyword
  data.append(packet);
  return png_chunk("iTXt", data);
}

PngChunks::PngChunks(std::uint64_t file_size, Read read) : file_size_(file_size), read_(std::move(read)) {}

PngChunks::PngChunks(Bytes bytes) : PngChunks(bytes.size(), reader_of(bytes)) {}

std::uint32_t PngChunks::read_number(std::uint64_t at) const {
  std::array<std::uint8_t, 4> bytes{};
  read_(at, bytes);
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
         bytes[3];
}

std::optional<PngChunk> PngChunks::next() {
  if (is_at_end_) return std::nullopt;
  const bool is_first = next_ == kPngSignature.size();
  PngChunk chunk;
  chunk.at = next_;
  chunk.length = read_number(next_);
  std::array<std::uint8_t, kTypeLength> type{};
  read_(next_ + 4, type);
  chunk.type.assign(type.begin(), type.end());
  if (chunk.length > kMaxPngChunkLength || chunk.end() > file_size_) {
    throw ImageError("PNG chunk at byte " + std::to_string(next_) + " claims " + std::to_string(chunk.length) +
                     " bytes, more than the file has; it is cut short or damaged");
  }
  if (is_first && (chunk.type != "IHDR" || chunk.length != kPngHeaderLength)) {
    throw ImageError("PNG without its header chunk; the file is damaged");
  }
  is_at_end_ = chunk.type == "IEND";
  next_ = chunk.end();
  return chunk;
}

std::string PngChunks::checked_data(const PngChunk& chunk) const {
  std::string text(kTypeLength + chunk.length, '\0');
  read_(chunk.at + 4, {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  if (checksum(0, bytes_of(text)) != read_number(chunk.end() - 4)) {
    throw ImageError("PNG chunk " + chunk.type + " at byte " + std::to_string(chunk.at) +
                     " has a wrong checksum; the file is damaged");
  }
  return text.substr(kTypeLength);
}

bool PngChunks::has_right_checksum(const PngChunk& chunk) const {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 16;
  std::vector<std::uint8_t> piece;
  std::uint32_t sum = 0;
  for (std::uint64_t at = chunk.at + 4; at < chunk.end() - 4; at += piece.size()) {
    piece.resize(std::min(kPiece, chunk.end() - 4 - at));
    read_(at, piece);
    sum = checksum(sum, piece);
  }
  return sum == read_number(chunk.end() - 4);
}

bool has_png_signature(Bytes bytes) {
  return bytes.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin());
}

}  // namespace vpe::core
