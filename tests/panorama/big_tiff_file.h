// Huge images as small files: tiles that share their bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace panorama_test {

// A BigTIFF of 3 x 8 bits, not compressed, in tiles of 256 x 256, with copies reduced by 2, 4, ... down to 512
// pixels. Only eight different tiles are stored; all offsets lead to them. Tile (column, row) of a level has
// the grey 100 + (column + 3 row) % 8.
class SharedTiles {
 public:
  static void write(const std::filesystem::path& path, std::int64_t width_px, std::int64_t height_px) {
    SharedTiles file(path);
    file.stream_.write("II\x2B\0\x08\0\0\0", 8);
    file.number(0);  // of the first directory, known later
    std::vector<std::uint64_t> tiles;
    for (int n = 0; n < 8; ++n) {
      tiles.push_back(file.position());
      file.stream_ << std::string(kTileBytes, static_cast<char>(100 + n));
    }
    std::uint64_t link = 8;
    for (std::int64_t width = width_px, height = height_px;;
         width = (width + 1) / 2, height = (height + 1) / 2) {
      link = file.page(width, height, width == width_px ? 0 : 1, tiles, link);
      if (width <= 512) break;
    }
  }
  static int grey(std::int64_t column, std::int64_t row) {
    return 100 + static_cast<int>((column + 3 * row) % 8);
  }

 private:
  static constexpr std::size_t kTileBytes = std::size_t{256} * 256 * 3;

  explicit SharedTiles(const std::filesystem::path& path) : stream_(path, std::ios::binary) {}

  std::uint64_t position() { return static_cast<std::uint64_t>(stream_.tellp()); }
  void number(std::uint64_t value) { stream_.write(reinterpret_cast<const char*>(&value), 8); }
  void entry(std::uint16_t tag, std::uint16_t type, std::uint64_t count, std::uint64_t value) {
    stream_.write(reinterpret_cast<const char*>(&tag), 2);
    stream_.write(reinterpret_cast<const char*>(&type), 2);
    number(count);
    number(value);
  }

  // Returns where the link to the next directory is.
  std::uint64_t page(std::int64_t width, std::int64_t height, std::uint64_t kind,
                     const std::vector<std::uint64_t>& tiles, std::uint64_t link) {
    const std::int64_t across = (width + 255) / 256;
    const std::int64_t down = (height + 255) / 256;
    const auto count = static_cast<std::uint64_t>(across * down);
    const std::uint64_t offsets = position();
    for (std::int64_t row = 0; row < down; ++row) {
      for (std::int64_t column = 0; column < across; ++column)
        number(tiles[static_cast<std::size_t>(grey(column, row) - 100)]);
    }
    const std::uint64_t sizes = position();
    for (std::uint64_t n = 0; n < count; ++n) number(kTileBytes);
    const std::uint64_t directory = position();
    stream_.seekp(static_cast<std::streamoff>(link));
    number(directory);
    stream_.seekp(0, std::ios::end);
    constexpr std::uint16_t kShort = 3;
    constexpr std::uint16_t kLong = 4;
    constexpr std::uint16_t kLong8 = 16;
    number(12);
    entry(254, kLong, 1, kind);
    entry(256, kLong, 1, static_cast<std::uint64_t>(width));
    entry(257, kLong, 1, static_cast<std::uint64_t>(height));
    entry(258, kShort, 3, 0x0008'0008'0008);
    entry(259, kShort, 1, 1);
    entry(262, kShort, 1, 2);
    entry(277, kShort, 1, 3);
    entry(284, kShort, 1, 1);
    entry(322, kLong, 1, 256);
    entry(323, kLong, 1, 256);
    // One tile's offset stands in the entry itself.
    entry(324, kLong8, count, count == 1 ? tiles[0] : offsets);
    entry(325, kLong8, count, count == 1 ? kTileBytes : sizes);
    const std::uint64_t next = position();
    number(0);
    return next;
  }

  std::ofstream stream_;
};

}  // namespace panorama_test
