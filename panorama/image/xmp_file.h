// An image's size and XMP packet, read and written without touching its pixels.
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

// Packets larger than this are refused.
inline constexpr std::size_t kMaxXmpBytes = std::size_t{1} << 24;
inline constexpr std::size_t kMaxJpegXmpBytes = 65502;

// By content. PNG is followed to its end, which shows a file that is cut short; JPEG up to its pixels. Reads
// and keeps little besides the packet, whatever the file's size. Throws FileError: damaged, or not readable.
ImageFileHeader read_image_header(const std::filesystem::path& path);
// The same in memory, PNG and JPEG; throws MetadataError.
ImageFileHeader read_image_header(std::span<const std::uint8_t> bytes);

// The same PNG or JPEG with the packet in place of any that it has, before the pixels; nothing else changes.
// Throws MetadataError: damaged, another format, or a packet that does not fit (kMaxJpegXmpBytes,
// kMaxXmpBytes).
std::vector<std::uint8_t> with_xmp(std::span<const std::uint8_t> image, std::string_view packet);

// The same for a file, which is replaced when all has been written; memory does not grow with it. Throws
// FileError.
void write_xmp(const std::filesystem::path& path, std::string_view packet);

}  // namespace panorama
