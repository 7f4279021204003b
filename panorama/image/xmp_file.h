// The size and the XMP packet of an image file, read and written without decoding its pixels.
//
// PNG: iTXt chunk XML:com.adobe.xmp, plain or compressed, before or behind the pixels; JPEG: APP1 segment;
// TIFF and BigTIFF: tag 700 of the first image (read only). Sources: PNG specification (third edition), XMP
// specification part 3, TIFF 6. Not read: extended XMP of JPEG (packets over 65 502 bytes), XMP in PNG that
// ImageMagick keeps as a "raw profile".
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "panorama/image/metadata_error.h"

namespace panorama {

enum class ImageFileFormat : std::uint8_t { kPng, kJpeg, kTiff, kOther };

struct ImageFileHeader {
  ImageFileFormat format = ImageFileFormat::kOther;
  std::int64_t width_px = 0;  // 0 for kOther
  std::int64_t height_px = 0;
  std::optional<std::string> xmp;
};

// Larger packets are refused.
inline constexpr std::size_t kMaxXmpBytes = std::size_t{1} << 24;
inline constexpr std::size_t kMaxJpegXmpBytes = 65502;

// Reads the header of a file; the format is found from its content. A PNG is followed to its end, which shows a
// file that is cut short; a JPEG up to its pixels. Keeps little besides the packet, for files of any size.
// Throws FileError: damaged, or not readable.
ImageFileHeader read_image_header(const std::filesystem::path& path);
// Reads the header of a PNG or JPEG in memory. Throws MetadataError.
ImageFileHeader read_image_header(std::span<const std::uint8_t> bytes);

// Returns the PNG or JPEG with the packet in place of any that it has, before the pixels; nothing else changes.
// Throws MetadataError: damaged, another format, or a packet that does not fit (kMaxJpegXmpBytes,
// kMaxXmpBytes).
std::vector<std::uint8_t> with_xmp(std::span<const std::uint8_t> image, std::string_view packet);

// Puts a packet into a PNG or JPEG file, which is replaced when everything has been written. Memory does not
// grow with the file. Throws FileError.
void write_xmp(const std::filesystem::path& path, std::string_view packet);

}  // namespace panorama
