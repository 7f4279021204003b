// PNG files of images that fit into memory a second time, made in half the time that libpng takes.
//
// libdeflate packs an image in one piece. Where it was not there when the program was built, libpng does all
// (image_codecs.cpp); the pixels are the same, the files are not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vpe::core {

// Whether pack_png() is there for an image of so many bytes.
bool can_pack_png(std::size_t pixel_bytes);

// channels: 3 = RGB, 4 = RGBA, 8 bits each, sRGB; rows from the top. compression: 1 to 9. Throws ImageError
// when memory runs out.
std::vector<std::uint8_t> pack_png(const std::uint8_t* pixels, int channels, int width, int height,
                                   int compression);

}  // namespace vpe::core
