// Reader of tiled TIFF files with numbers.
#pragma once

#include <tiffio.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

namespace app_test {

// Returns all numbers row by row, `samples` per pixel. Throws std::runtime_error.
template <class Number>
std::vector<Number> read_numbers(const std::filesystem::path& path, int samples = 1) {
  TIFFSetWarningHandler(nullptr);
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "r"), TIFFClose);
  if (tiff == nullptr) throw std::runtime_error("cannot open " + path.string());
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  constexpr std::uint32_t kTile = 256;
  const auto count = static_cast<std::size_t>(samples);
  std::vector<Number> all(std::size_t{width} * height * count);
  std::vector<Number> tile(std::size_t{kTile} * kTile * count);
  for (std::uint32_t y = 0; y < height; y += kTile) {
    for (std::uint32_t x = 0; x < width; x += kTile) {
      if (TIFFReadTile(tiff.get(), tile.data(), x, y, 0, 0) < 0) throw std::runtime_error("cannot read a tile");
      for (std::uint32_t j = 0; j < std::min(kTile, height - y); ++j) {
        std::copy_n(tile.begin() + static_cast<std::ptrdiff_t>(std::size_t{j} * kTile * count),
                    std::min(kTile, width - x) * count,
                    all.begin() + static_cast<std::ptrdiff_t>((std::size_t{y + j} * width + x) * count));
      }
    }
  }
  return all;
}

}  // namespace app_test
