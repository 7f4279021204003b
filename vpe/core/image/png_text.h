// Text inside a PNG file, and a check that the file is complete.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vpe::core {

// Holds a tEXt chunk: a keyword of 1 to 79 characters and a text, both printable ASCII.
struct PngText {
  std::string keyword;
  std::string text;

  bool operator==(const PngText&) const = default;
};

// Returns the file with the texts inserted before its pixels. Throws ImageError when the bytes are no PNG.
std::vector<std::uint8_t> with_png_text(std::span<const std::uint8_t> png, std::span<const PngText> texts);

// Returns the texts of a complete file: every chunk is there with the right checksum, and nothing follows the
// last one. Returns nullopt for any other bytes. Does not decode pixels: decode_png() does.
std::optional<std::vector<PngText>> read_png_text(std::span<const std::uint8_t> bytes);

}  // namespace vpe::core
