#include <zlib.h>

#include <array>

#include "panorama/image/xmp_formats.h"
#include "vpe/core/image/image.h"
#include "vpe/core/image/png_chunks.h"

namespace panorama {

namespace {

using vpe::core::kPngXmpKeyword;
using vpe::core::PngChunk;
using vpe::core::PngChunks;

PngChunks chunks_of(const Input& input) {
  return {input.size(), [&input](std::uint64_t at, std::span<std::uint8_t> out) { input.read(at, out); }};
}

// Calls an action; what a reader of chunks throws becomes an error of metadata.
template <class Action>
auto reading_chunks(const Action& action) {
  try {
    return action();
  } catch (const vpe::core::ImageError& e) {
    throw MetadataError(e.what());
  }
}

bool holds_xmp(const Input& input, const PngChunk& chunk) {
  return chunk.type == "iTXt" && chunk.length >= kPngXmpKeyword.size() &&
         input.read_text(chunk.data(), kPngXmpKeyword.size()) == kPngXmpKeyword;
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

std::string xmp_of(const PngChunks& chunks, const PngChunk& chunk) {
  if (chunk.length > kMaxXmpBytes) {
    throw MetadataError("XMP of " + std::to_string(chunk.length) + " bytes is more than the " +
                        std::to_string(kMaxXmpBytes) + " that are accepted");
  }
  const std::string all = chunks.checked_data(chunk);
  // Keyword, whether compressed, method, language tag, translated keyword, text.
  std::string_view rest = std::string_view(all).substr(kPngXmpKeyword.size());
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

}  // namespace

bool is_png(const Input& input) { return starts_with(input, vpe::core::kPngSignature); }

ImageFileHeader read_png_header(const Input& input) {
  ImageFileHeader header;
  header.format = ImageFileFormat::kPng;
  reading_chunks([&] {
    PngChunks chunks = chunks_of(input);
    while (const auto chunk = chunks.next()) {
      if (chunk->type == "IHDR") {
        chunks.checked_data(*chunk);
        header.width_px = chunks.read_number(chunk->data());
        header.height_px = chunks.read_number(chunk->data() + 4);
      } else if (!header.xmp && holds_xmp(input, *chunk)) {
        header.xmp = xmp_of(chunks, *chunk);
      }
    }
  });
  constexpr std::int64_t kMaxSide = vpe::core::kMaxPngChunkLength;  // the limit of all numbers in PNG
  if (header.width_px < 1 || header.height_px < 1 || header.width_px > kMaxSide ||
      header.height_px > kMaxSide) {
    throw MetadataError("PNG of " + std::to_string(header.width_px) + "x" + std::to_string(header.height_px) +
                        " pixels; the file is damaged");
  }
  return header;
}

void copy_png_with_xmp(const Input& input, std::string_view packet, const Sink& sink) {
  copy_range(input, 0, vpe::core::kPngSignature.size(), sink);
  reading_chunks([&] {
    PngChunks chunks = chunks_of(input);
    while (const auto chunk = chunks.next()) {
      if (holds_xmp(input, *chunk)) continue;
      copy_range(input, chunk->at, chunk->end(), sink);
      if (chunk->type == "IHDR") sink(vpe::core::png_xmp_chunk(packet));
    }
  });
}

}  // namespace panorama
