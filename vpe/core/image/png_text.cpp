#include "vpe/core/image/png_text.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "vpe/core/image/image.h"

namespace vpe::core {

namespace {

using Bytes = std::span<const std::uint8_t>;

// PNG specification, section 5: signature, then chunks of length, type, data and checksum, big-endian.
constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kFrame = 12;  // of a chunk around its data
constexpr std::size_t kHeader = kSignature.size() + kFrame + 13;

std::uint32_t read_u32(Bytes bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
         bytes[3];
}

void put_u32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t checksum(Bytes type_and_data) {
  return static_cast<std::uint32_t>(::crc32(0, type_and_data.data(), static_cast<uInt>(type_and_data.size())));
}

bool has_signature(Bytes bytes) {
  return bytes.size() >= kSignature.size() && std::equal(kSignature.begin(), kSignature.end(), bytes.begin());
}

}  // namespace

std::vector<std::uint8_t> with_png_text(Bytes png, std::span<const PngText> texts) {
  if (!has_signature(png) || png.size() < kHeader) throw ImageError("no PNG to put text into");
  std::vector<std::uint8_t> out(png.begin(), png.begin() + kHeader);
  for (const PngText& t : texts) {
    put_u32(out, static_cast<std::uint32_t>(t.keyword.size() + 1 + t.text.size()));
    const std::size_t type = out.size();
    for (const std::string_view part : {std::string_view("tEXt"), std::string_view(t.keyword),
                                        std::string_view("\0", 1), std::string_view(t.text)}) {
      out.insert(out.end(), part.begin(), part.end());
    }
    put_u32(out, checksum(Bytes(out).subspan(type)));
  }
  out.insert(out.end(), png.begin() + kHeader, png.end());
  return out;
}

std::optional<std::vector<PngText>> read_png_text(Bytes bytes) {
  if (!has_signature(bytes)) return std::nullopt;
  std::vector<PngText> texts;
  Bytes rest = bytes.subspan(kSignature.size());
  while (rest.size() >= kFrame) {
    const std::size_t length = read_u32(rest);
    if (length > rest.size() - kFrame) return std::nullopt;
    const Bytes type_and_data = rest.subspan(4, 4 + length);
    if (checksum(type_and_data) != read_u32(rest.subspan(8 + length))) return std::nullopt;
    const std::string_view type(reinterpret_cast<const char*>(type_and_data.data()), 4);
    const std::string_view data(reinterpret_cast<const char*>(type_and_data.data()) + 4, length);
    rest = rest.subspan(kFrame + length);
    if (type == "IEND") return rest.empty() ? std::optional(texts) : std::nullopt;
    if (type != "tEXt") continue;
    const std::size_t end = data.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    texts.push_back({std::string(data.substr(0, end)), std::string(data.substr(end + 1))});
  }
  return std::nullopt;
}

}  // namespace vpe::core
