// What xmp_file.h needs of each format. Private to panorama.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "panorama/image/input.h"
#include "panorama/image/xmp_file.h"

namespace panorama {

using Sink = std::function<void(std::span<const std::uint8_t>)>;

bool is_png(const Input& input);
ImageFileHeader read_png_header(const Input& input);
void copy_png_with_xmp(const Input& input, std::string_view packet, const Sink& sink);

bool is_jpeg(const Input& input);
ImageFileHeader read_jpeg_header(const Input& input);
void copy_jpeg_with_xmp(const Input& input, std::string_view packet, const Sink& sink);

bool is_tiff(const Input& input);
// Through libtiff, which reads the file by itself. Throws MetadataError.
ImageFileHeader read_tiff_header(const std::filesystem::path& path);

// Bytes [from, to) of the input to the sink, a piece at a time.
void copy_range(const Input& input, std::uint64_t from, std::uint64_t to, const Sink& sink);

bool starts_with(const Input& input, std::span<const std::uint8_t> signature);

}  // namespace panorama
