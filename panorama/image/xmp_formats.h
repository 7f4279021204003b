// The functions of each format that xmp_file.h needs. Private to panorama.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "panorama/image/input.h"
#include "panorama/image/xmp_file.h"

namespace panorama {

// Receives bytes of the output in order.
using Sink = std::function<void(std::span<const std::uint8_t>)>;

// Return whether the input begins as a file of the format does.
bool is_png(const Input& input);
bool is_jpeg(const Input& input);
bool is_tiff(const Input& input);

// Read size and packet. Throw MetadataError.
ImageFileHeader read_png_header(const Input& input);
ImageFileHeader read_jpeg_header(const Input& input);
// Reads through libtiff, which opens the file itself.
ImageFileHeader read_tiff_header(const std::filesystem::path& path);

// Copy the input with the packet in place of any that it has. Throw MetadataError.
void copy_png_with_xmp(const Input& input, std::string_view packet, const Sink& sink);
void copy_jpeg_with_xmp(const Input& input, std::string_view packet, const Sink& sink);

// Copies bytes [from, to) of the input to the sink, piece by piece.
void copy_range(const Input& input, std::uint64_t from, std::uint64_t to, const Sink& sink);

bool starts_with(const Input& input, std::span<const std::uint8_t> signature);

}  // namespace panorama
