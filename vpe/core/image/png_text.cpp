#include "vpe/core/image/png_text.h"

#include "vpe/core/image/image.h"
#include "vpe/core/image/png_chunks.h"

namespace vpe::core {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kHeaderEnd = kPngSignature.size() + kPngChunkFrame + kPngHeaderLength;

}  // namespace

std::vector<std::uint8_t> with_png_text(Bytes png, std::span<const PngText> texts) {
  if (!has_png_signature(png) || png.size() < kHeaderEnd) throw ImageError("no PNG to put text into");
  std::vector<std::uint8_t> out(png.begin(), png.begin() + kHeaderEnd);
  for (const PngText& t : texts) {
    const std::vector<std::uint8_t> chunk = png_chunk("tEXt", t.keyword + '\0' + t.text);
    out.insert(out.end(), chunk.begin(), chunk.end());
  }
  out.insert(out.end(), png.begin() + kHeaderEnd, png.end());
  return out;
}

std::optional<std::vector<PngText>> read_png_text(Bytes bytes) {
  if (!has_png_signature(bytes)) return std::nullopt;
  try {
    std::vector<PngText> texts;
    std::uint64_t end = 0;
    PngChunks chunks(bytes);
    while (const auto chunk = chunks.next()) {
      end = chunk->end();
      if (chunk->type != "tEXt") {
        if (!chunks.has_right_checksum(*chunk)) return std::nullopt;
        continue;
      }
      const std::string data = chunks.checked_data(*chunk);
      const std::size_t keyword_end = data.find('\0');
      if (keyword_end == std::string::npos) return std::nullopt;
      texts.push_back({data.substr(0, keyword_end), data.substr(keyword_end + 1)});
    }
    if (end != bytes.size()) return std::nullopt;
    return texts;
  } catch (const ImageError&) {
    return std::nullopt;
  }
}

}  // namespace vpe::core
