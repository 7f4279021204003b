// Chunks of PNG files: how they are written and walked through.
//
// Source: PNG specification (third edition), section 5. A file is a signature and a sequence of chunks. A chunk
// is a length, a type of four letters, data, and a checksum of type and data. All numbers are big-endian.
//
// Typical usage:
//   PngChunks chunks(bytes);
//   while (const auto chunk = chunks.next()) {
//     if (chunk->type == "tEXt") use(chunks.checked_data(*chunk));
//   }
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::core {

inline constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
// Bytes of a chunk besides its data.
inline constexpr std::uint64_t kPngChunkFrame = 12;
inline constexpr std::uint32_t kPngHeaderLength = 13;  // data of IHDR
inline constexpr std::uint32_t kMaxPngChunkLength = 0x7FFFFFFF;
// Begins the data of the iTXt chunk that holds XMP, the zero byte included.
inline constexpr std::string_view kPngXmpKeyword("XML:com.adobe.xmp\0", 18);

// Appends a number, highest byte first.
void put_png_number(std::vector<std::uint8_t>& out, std::uint32_t number);

// Holds what surrounds the data of a chunk: length and type before it, the checksum behind it.
struct PngChunkFrame {
  std::array<std::uint8_t, 8> head;
  std::array<std::uint8_t, 4> tail;
};
// Computes the frame for data that are then written without another copy. `type` has four letters.
PngChunkFrame png_chunk_frame(std::string_view type, std::span<const std::uint8_t> data);

// Returns a whole chunk.
std::vector<std::uint8_t> png_chunk(std::string_view type, std::span<const std::uint8_t> data);
std::vector<std::uint8_t> png_chunk(std::string_view type, std::string_view data);

// Returns the iTXt chunk of an XMP packet, not compressed.
std::vector<std::uint8_t> png_xmp_chunk(std::string_view packet);

// Describes where a chunk stands in its file, in bytes from the file's start.
struct PngChunk {
  std::uint64_t at = 0;      // of the chunk's length field
  std::uint32_t length = 0;  // of the data
  std::string type;

  std::uint64_t data() const { return at + 8; }
  std::uint64_t end() const { return at + kPngChunkFrame + length; }
};

// Walks through the chunks of a PNG, from IHDR to IEND, and checks that they follow each other within the file.
// Keeps nothing of their data. Expects that the file begins with kPngSignature. For one thread.
class PngChunks {
 public:
  // Fills its argument with the bytes from `at` on; throws when there are too few.
  using Read = std::function<void(std::uint64_t at, std::span<std::uint8_t>)>;

  PngChunks(std::uint64_t file_size, Read read);
  // Walks through bytes in memory, which must outlive the object.
  explicit PngChunks(std::span<const std::uint8_t> bytes);

  // Returns the next chunk, or nullopt after IEND. Throws ImageError for a chunk that exceeds the file and for
  // a file that does not begin with IHDR.
  std::optional<PngChunk> next();

  // Returns the data of a chunk as text. Throws ImageError when the checksum is wrong.
  std::string checked_data(const PngChunk& chunk) const;

  // Returns whether type and data match the checksum. Reads them piece by piece.
  bool has_right_checksum(const PngChunk& chunk) const;

  std::uint32_t read_number(std::uint64_t at) const;

 private:
  std::uint64_t file_size_;
  Read read_;
  std::uint64_t next_ = kPngSignature.size();
  bool is_at_end_ = false;
};

// Returns whether bytes in memory begin with the signature.
bool has_png_signature(std::span<const std::uint8_t> bytes);

}  // namespace vpe::core
