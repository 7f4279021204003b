#include <zlib.h>

#include <array>
#include <functional>

#include "panorama/image/xmp_formats.h"

namespace panorama {

namespace {

using Bytes = std::span<const std::uint8_t>;

// PNG specification, section 5: signature, then chunks of length, type, data and checksum, big-endian.
constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::uint64_t kFrame = 12;  // of a chunk around its data
constexpr std::uint32_t kMaxLength = 0x7FFFFFFF;
constexpr std::uint32_t kHeaderLength = 13;
constexpr std::string_view kKeyword("XML:com.adobe.xmp\0", 18);

struct Chunk {
  std::uint64_t at = 0;  // of its length
  std::uint32_t length = 0;
  std::string type;

  std::uint64_t data() const { return at + 8; }
  std::uint64_t end() const { return at + kFrame + length; }
};

std::uint32_t to_u32(Bytes bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
         bytes[3];
}

std::uint32_t read_u32(const Input& input, std::uint64_t at) {
  std::array<std::uint8_t, 4> bytes{};
  input.read(at, bytes);
  return to_u32(bytes);
}

void put_u32(std::string& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t checksum(std::string_view type_and_data) {
  return static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(type_and_data.data()),
                                            static_cast<uInt>(type_and_data.size())));
}

// All chunks from IHDR to IEND. Throws when they do not fill the file's start without gaps.
void visit_chunks(const Input& input, const std::function<void(const Chunk&)>& visit) {
  std::uint64_t at = kSignature.size();
  for (bool is_first = true;; is_first = false) {
    Chunk chunk;
    chunk.at = at;
    chunk.length = read_u32(input, at);
    chunk.type = input.read_text(at + 4, 4);
    if (chunk.length > kMaxLength || chunk.end() > input.size()) {
      throw MetadataError("PNG chunk at byte " + std::to_string(at) + " claims " +
                          std::to_string(chunk.length) +
                          " bytes, more than the file has; it is cut short or damaged");
    }
    if (is_first && (chunk.type != "IHDR" || chunk.length != kHeaderLength)) {
      throw MetadataError("PNG without its header chunk; the file is damaged");
    }
    visit(chunk);
    if (chunk.type == "IEND") return;
    at = chunk.end();
  }
}

// Type and data, their checksum compared.
std::string checked_text(const Input& input, const Chunk& chunk) {
  std::string text = input.read_text(chunk.at + 4, std::size_t{4} + chunk.length);
  if (checksum(text) != read_u32(input, chunk.end() - 4)) {
    throw MetadataError("PNG chunk " + chunk.type + " at byte " + std::to_string(chunk.at) +
                        " has a wrong checksum; the file is damaged");
  }
  return text;
}

bool holds_xmp(const Input& input, const Chunk& chunk) {
  return chunk.type == "iTXt" && chunk.length >= kKeyword.size() &&
         input.read_text(chunk.data(), kKeyword.size()) == kKeyword;
}

std::string inflate_text(std::string_view packed) {
  z_stream stream{};
  if (::inflateInit(&stream) != Z_OK) throw MetadataError("zlib could not be started");
  std::string text;
  std::array<char, 1 << 14> piece;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  while (state == Z_OK && text.size() <= kMaxXmpBytes) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    state = ::inflate(&stream, Z_NO_FLUSH);
    text.append(piece.data(), piece.size() - stream.avail_out);
  }
  ::inflateEnd(&stream);
  if (state != Z_STREAM_END || text.size() > kMaxXmpBytes) {
    throw MetadataError("compressed XMP of the PNG does not unpack to at most " + std::to_string(kMaxXmpBytes) +
                        " bytes; write it again");
  }
  return text;
}

std::string xmp_of(const Input& input, const Chunk& chunk) {
  if (chunk.length > kMaxXmpBytes) {
    throw MetadataError("XMP of " + std::to_string(chunk.length) + " bytes is more than the " +
                        std::to_string(kMaxXmpBytes) + " that are accepted");
  }
  const std::string all = checked_text(input, chunk);
  // Keyword, whether compressed, method, language tag, translated keyword, text.
  std::string_view rest = std::string_view(all).substr(4 + kKeyword.size());
  const bool is_compressed = rest.size() >= 2 && rest[0] == 1;
  const bool is_plain = rest.size() >= 2 && rest[0] == 0;
  const std::size_t language = rest.find('\0', 2);
  const std::size_t translated = language == std::string_view::npos ? language : rest.find('\0', language + 1);
  if (!(is_plain || (is_compressed && rest[1] == 0)) || translated == std::string_view::npos) {
    throw MetadataError("XMP chunk of the PNG is not laid out as iTXt; write it again");
  }
  rest.remove_prefix(translated + 1);
  return is_compressed ? inflate_text(rest) : std::string(rest);
}

std::string xmp_chunk(std::string_view packet) {
  std::string type_and_data = "iTXt";
  type_and_data.append(kKeyword).append(4, '\0').append(packet);
  std::string chunk;
  put_u32(chunk, static_cast<std::uint32_t>(type_and_data.size() - 4));
  chunk += type_and_data;
  put_u32(chunk, checksum(type_and_data));
  return chunk;
}

}  // namespace

bool is_png(const Input& input) { return starts_with(input, kSignature); }

ImageFileHeader read_png_header(const Input& input) {
  ImageFileHeader header;
  header.format = ImageFileFormat::kPng;
  visit_chunks(input, [&](const Chunk& chunk) {
    if (chunk.type == "IHDR") {
      checked_text(input, chunk);
      header.width_px = read_u32(input, chunk.data());
      header.height_px = read_u32(input, chunk.data() + 4);
    } else if (!header.xmp && holds_xmp(input, chunk)) {
      header.xmp = xmp_of(input, chunk);
    }
  });
  if (header.width_px < 1 || header.height_px < 1 || header.width_px > kMaxLength ||
      header.height_px > kMaxLength) {
    throw MetadataError("PNG of " + std::to_string(header.width_px) + "x" + std::to_string(header.height_px) +
                        " pixels; the file is damaged");
  }
  return header;
}

void copy_png_with_xmp(const Input& input, std::string_view packet, const Sink& sink) {
  const std::string chunk_with_packet = xmp_chunk(packet);
  copy_range(input, 0, kSignature.size(), sink);
  visit_chunks(input, [&](const Chunk& chunk) {
    if (holds_xmp(input, chunk)) return;
    copy_range(input, chunk.at, chunk.end(), sink);
    if (chunk.type == "IHDR") {
      sink({reinterpret_cast<const std::uint8_t*>(chunk_with_packet.data()), chunk_with_packet.size()});
    }
  });
}

}  // namespace panorama
