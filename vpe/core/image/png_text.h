// Text inside a PNG file, and whether the file is whole.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vpe::core {

// A tEXt chunk: keyword of 1 to 79 characters, text; both printable ASCII.
struct PngText {
  std::string keyword;
  std::string text;

  bool operator==(const PngText&) const = default;
};

// The file with the texts in front of its pixels. Throws ImageError when the bytes are no PNG.
std::vector<std::uint8_t> with_png_text(std::span<const std::uint8_t> png, std::span<const PngText> texts);

// The texts of a file that is whole: every chunk there with the right checksum, and nothing after the last one.
// Nothing for any other bytes. Pixels are not unpacked: decode_png() does that.
std::optional<std::vector<PngText>> read_png_text(std::span<const std::uint8_t> bytes);

}  // namespace vpe::core
