// Numbers of tiles' parts as colours, to read from an image what is drawn at each of its pixels. Pure; no
// OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vpe::gl {

enum class TilePart : std::uint8_t { kSurface, kRibbon, kSkirt };
inline constexpr std::size_t kTileParts = 3;

inline constexpr std::uint32_t kNoTile = 0;  // sky

struct TileId {
  std::size_t tile;  // index into the drawn tiles, below 2^22
  TilePart part;
};

constexpr std::uint32_t pack(TileId n) {
  return static_cast<std::uint32_t>(n.tile * kTileParts + static_cast<std::size_t>(n.part) + 1);
}

// Not of kNoTile.
constexpr TileId unpack(std::uint32_t number) {
  return {(number - 1) / kTileParts, static_cast<TilePart>((number - 1) % kTileParts)};
}

// 24 bits, red the lowest.
constexpr std::array<std::uint8_t, 3> number_colour(std::uint32_t number) {
  return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8U),
          static_cast<std::uint8_t>(number >> 16U)};
}

constexpr std::uint32_t number_of_colour(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  return red | static_cast<std::uint32_t>(green) << 8U | static_cast<std::uint32_t>(blue) << 16U;
}

}  // namespace vpe::gl
